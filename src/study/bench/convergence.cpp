#include "src/study/bench/convergence.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace tutu::app {
namespace {

constexpr double k_size = 0.5; // m
constexpr int k_frames = 15;   // of 1/60 s
constexpr double k_nothing = std::numeric_limits<double>::quiet_NaN();

/// Particles at the end; none when the run broke. `particles` a side.
std::vector<Vec3> swung(int particles, int substeps, const RunSettings& setup) {
  cloth::GarmentDescription description;
  description.name = "sheet";
  description.shape = cloth::GridShape{particles, particles, {-0.5 * k_size, 1, 0}, {k_size, 0, 0}, {0, 0, k_size}};
  description.attachments = {{"stage", 0, 0, 0, -1}};
  const cloth::Garment garment = cloth::build_garment(description);
  cloth::SolverOptions options = setup;
  options.double_precision = true;
  const auto solver = cloth::make_solver(garment, options);
  const auto query = proxies::make_query(setup.backend);
  std::vector<Vec3> pins;
  for (const cloth::Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  cloth::FrameInput input;
  input.pins_start = input.pins_end = pins;
  input.substeps = substeps;
  for (int frame = 0; frame < k_frames; ++frame)
    if (solver->step(input, *query)) return {};
  return solver->particles().positions;
}

/// m, RMS, at the particles of a grid of `shared` a side, which both have.
double distance(const std::vector<Vec3>& a, int side_a, const std::vector<Vec3>& b, int side_b, int shared) {
  if (a.empty() || b.empty()) return k_nothing;
  const int step_a = (side_a - 1) / (shared - 1), step_b = (side_b - 1) / (shared - 1);
  double sum = 0.0; // m2
  for (int row = 0; row < shared; ++row)
    for (int column = 0; column < shared; ++column)
      sum += (a[step_a * (row * side_a + column)] - b[step_b * (row * side_b + column)]).squaredNorm();
  return std::sqrt(sum / (shared * shared));
}

AnalyticFigure measured(std::string what, std::string unit, double value) {
  return {std::move(what), std::move(unit), value, value, k_measured_only};
}

/// Each error halves the step or cell of the one before.
AnalyticFigure order_of(const std::string& what, const std::vector<double>& errors) {
  const double order = std::log2(errors[errors.size() - 2] / errors.back());
  return measured("order of the error in " + what, "", order);
}

} // namespace

std::vector<AnalyticFigure> convergence_in_step(const RunSettings& setup) {
  constexpr int k_side = 9, k_reference = 2560;
  const std::vector<Vec3> reference = swung(k_side, k_reference, setup);
  std::vector<AnalyticFigure> figures;
  std::vector<double> errors;
  for (const int substeps : {20, 40, 80, 160}) {
    errors.push_back(distance(swung(k_side, substeps, setup), k_side, reference, k_side, k_side));
    figures.push_back(measured(fmt::format("error at {} substeps a frame", substeps), "mm", 1e3 * errors.back()));
  }
  figures.push_back(order_of("the step", errors));
  return figures;
}

std::vector<AnalyticFigure> convergence_in_cells(const RunSettings& setup) {
  constexpr int k_shared = 5, k_finest = 65, k_substeps = 160;
  const std::vector<Vec3> reference = swung(k_finest, k_substeps, setup);
  std::vector<AnalyticFigure> figures;
  std::vector<double> errors;
  for (const int side : {5, 9, 17, 33}) {
    errors.push_back(distance(swung(side, k_substeps, setup), side, reference, k_finest, k_shared));
    figures.push_back(
        measured(fmt::format("error with cells of {:.3g} mm", 1e3 * k_size / (side - 1)), "mm", 1e3 * errors.back()));
  }
  figures.push_back(order_of("the cells", errors));
  return figures;
}

} // namespace tutu::app
