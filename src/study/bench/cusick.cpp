#include "src/study/bench/cusick.h"

#include "cloth/garment/garment_file.h"
#include "rig/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <random>

namespace tutu::app {
namespace {

constexpr double k_radius = 0.15, k_support = 0.09; // m
constexpr int k_rings = 20, k_frames = 240;
constexpr double k_settling_drag = 3.0; // 1/s, on top of the fabric's

/// Drape coefficients of the kind of cloth, %, as BENCHMARKS and textbooks have them.
struct Band {
  const char* fabric;
  double least, most;
};
constexpr Band k_bands[] = {{"silk", 20, 40}, {"cotton", 60, 76}, {"wool", 40, 70}, {"denim", 70, 90}};

/// A flat disc is in (unstable) balance with itself: folds need something to begin with.
std::vector<Vec3> ruffled(const cloth::Garment& garment) {
  std::mt19937_64 random(3);
  const auto shift = [&] { return 0.001 * (2.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1.0); };
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garment);
  std::vector<Vec3> positions = garment.rest_positions;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double x = shift(), y = shift(), z = shift();
    if (!pinned[i]) positions[i] += Vec3(x, 3.0 * y, z);
  }
  return positions;
}

AnalyticFigure figure_of(const std::string& fabric, double percent) {
  const auto band =
      std::find_if(std::begin(k_bands), std::end(k_bands), [&](const Band& b) { return b.fabric == fabric; });
  if (band == std::end(k_bands)) return {fabric + ", no published band", "%", percent, percent, k_measured_only};
  return {fmt::format("{}, published {:g} to {:g} %", fabric, band->least, band->most), "%", percent,
          0.5 * (band->least + band->most), 0.5 * (band->most - band->least)};
}

} // namespace

double drape_coefficient(const cloth::Fabric& fabric, const RunSettings& setup) {
  cloth::GarmentDescription description;
  description.name = "disc";
  description.shape = cloth::DiscShape{{0, 1, 0}, k_radius, k_radius, k_rings, 0.0};
  description.fabric = fabric;
  description.fabric.stretch = k_cusick_stretch;
  cloth::Attachment support;
  support.joint = "support";
  support.within = cloth::Attachment::Ball{{0, 1, 0}, k_support + 1e-4};
  description.attachments = {support};
  const cloth::Garment garment = cloth::build_garment(description);
  const auto solver = cloth::make_solver(garment, setup);
  solver->reset(ruffled(garment));
  std::vector<Vec3> pins;
  for (const cloth::Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  cloth::FrameInput input;
  input.pins_start = input.pins_end = pins;
  input.substeps = std::max(setup.substeps, k_cusick_substeps);
  input.extra_drag = k_settling_drag;
  const auto query = proxies::make_query(setup.backend);
  for (int frame = 0; frame < k_frames; ++frame)
    if (solver->step(input, *query)) return std::numeric_limits<double>::quiet_NaN();

  const std::vector<Vec3>& x = solver->particles().positions;
  const int border = 6 * k_rings, first = garment.particle_count() - border; // the last ring
  double shadow = 0.0;
  for (int k = 0; k < border; ++k) {
    const Vec3 &p = x[first + k], &q = x[first + (k + 1) % border];
    shadow += 0.5 * (p.z() * q.x() - p.x() * q.z());
  }
  const double support_area = std::numbers::pi * k_support * k_support, flat = std::numbers::pi * k_radius * k_radius;
  return (shadow - support_area) / (flat - support_area);
}

std::vector<AnalyticFigure> cusick(const std::filesystem::path& fabrics, const RunSettings& setup) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(fabrics, error))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  if (files.empty()) throw InputError(fabrics.string(), "", "no fabric", "fabrics (.json)");
  std::sort(files.begin(), files.end());
  std::vector<AnalyticFigure> figures;
  for (const auto& file : files)
    figures.push_back(figure_of(file.stem().string(), 100.0 * drape_coefficient(cloth::read_fabric(file), setup)));
  return figures;
}

} // namespace tutu::app
