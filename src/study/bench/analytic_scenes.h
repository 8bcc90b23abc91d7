// Scenes whose outcome a formula tells: cloth falls, slides, swings, hangs and keeps its energy as physics says.
#pragma once

#include "src/study/bench/stability_run.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace tutu::app {

/// One number of a scene beside the formula's.
struct AnalyticFigure {
  std::string what, unit;
  double measured = 0.0, expected = 0.0, tolerance = 0.0; ///< in `unit`

  bool passed() const; ///< measured is within tolerance of expected; false for what is no number
};

/// The tolerance of a figure that nothing is held against.
inline constexpr double k_measured_only = std::numeric_limits<double>::infinity();

/// A loose sheet in air without drag: where it is after half a second, how fast, and whether it kept its shape.
std::vector<AnalyticFigure> free_fall(const RunSettings& setup);

/// A small sheet on a slope half a degree below and above the angle of friction, atan(friction), for 2 s: it stays, or
/// slides g (sin a - friction cos a) t^2 / 2.
std::vector<AnalyticFigure> slope(double friction, const RunSettings& setup);

/// A row of particles on stiff threads, let go at 0.5 rad, for six swings. Period 2 pi sqrt(L / g) (1 + a^2 / 16 +
/// 11 a^4 / 3072) for amplitude a; energy must neither grow nor be lost.
std::vector<AnalyticFigure> pendulum(const RunSettings& setup);

/// A narrow band of 1.2 m between points 1 m apart: its sag is that of the catenary.
std::vector<AnalyticFigure> catenary(const RunSettings& setup);

/// A sheet hangs by its own weight: each thread gives by the sum over its edges of (weight below) / (edge's stiffness).
std::vector<AnalyticFigure> hang(const RunSettings& setup);

/// A hanging sheet, shaken at the start and then left alone without drag: the sum of its energies never grows.
std::vector<AnalyticFigure> energy(const RunSettings& setup);

/// By the name of the command line.
struct AnalyticFamily {
  std::string name, what;
  std::function<std::vector<AnalyticFigure>(const RunSettings& setup)> run;
};
const std::vector<AnalyticFamily>& analytic_families();

} // namespace tutu::app
