#include "src/study/stability/warning.h"

#include "cloth/state/tolerances.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace tutu::app {
namespace {

int substeps_for(double step, const RunSettings& description) {
  return static_cast<int>(std::ceil(1.0 / (description.frames_per_second * step)));
}

void check_step(const RunSettings& description, const SceneSetting& setting, std::vector<std::string>& outside) {
  const GarmentSetting* worst = stiffest(setting);
  if (description.solver != cloth::SolverKind::mass_spring || !worst || setting.step <= worst->step_limit) return;
  outside.push_back(fmt::format("mass_spring moves {} in steps of {:.3g} ms, and its springs stand {:.3g} ms at most: "
                                "take {} substeps a frame or more, or solver xpbd",
                                worst->name, 1e3 * setting.step, 1e3 * worst->step_limit,
                                substeps_for(worst->step_limit, description)));
}

void check_speed(const RunSettings& description, const SceneSetting& setting, std::vector<std::string>& outside) {
  const ProxySetting* worst = fastest(setting);
  if (!worst) return;
  const double safe_way = worst->radius + least_gap(setting);
  // What plan_substeps would add is there already.
  const double step = description.adaptive_substeps
                          ? std::min(setting.step, 1.0 / (description.frames_per_second *
                                                          static_cast<double>(cloth::k_most_adaptive_substeps)))
                          : setting.step;
  if (worst->speed * step <= safe_way) return;
  outside.push_back(fmt::format(
      "{} goes up to {:.3g} m/s, {:.3g} mm a substep, and is {:.3g} mm thick with the cloth's "
      "gap: take {} substeps a frame or more{}",
      worst->name, worst->speed, 1e3 * worst->speed * step, 1e3 * safe_way,
      substeps_for(safe_way / worst->speed, description), description.adaptive_substeps ? "" : ", or let them adapt"));
}

/// A rounded tip fits between four particles when it is thinner than half of the cell's diagonal.
void check_cells(const SceneSetting& setting, std::vector<std::string>& outside) {
  const ProxySetting* thin = thinnest(setting);
  if (!thin) return;
  for (const GarmentSetting& garment : setting.garments) {
    const double safe_cell = std::numbers::sqrt2 * (thin->radius + garment.gap);
    if (!garment.only_particles || garment.largest_cell <= safe_cell) continue;
    outside.push_back(fmt::format("{} has cells of up to {:.3g} mm, and only their corners are kept from {} of {:.3g} "
                                  "mm: make them {:.3g} mm or less, or use xpbd on rows and columns against proxies",
                                  garment.name, 1e3 * garment.largest_cell, thin->name, 1e3 * thin->radius,
                                  1e3 * safe_cell));
    return; // one garment tells what to change
  }
}

} // namespace

std::vector<std::string> outside_safe_region(const RunSettings& description, const SceneSetting& setting) {
  std::vector<std::string> outside;
  check_step(description, setting, outside);
  check_speed(description, setting, outside);
  check_cells(setting, outside);
  return outside;
}

std::string warning_of(const Scene& scene) {
  if (scene.garments.empty()) return "";
  const auto outside = outside_safe_region(scene.settings, scene_setting(scene));
  return fmt::format("{}", fmt::join(outside, "; "));
}

} // namespace tutu::app
