// How fast errors shrink: against the step, and against the cells. Measured, not promised.
#pragma once

#include "src/study/bench/analytic_scenes.h"

namespace tutu::app {

/// A sheet of 0.5 m, held along one edge, is let go level and swings down for 0.25 s. RMS distance of its particles
/// from the same run in far smaller steps, for steps halved from one to the next, mm; and the order, the slope of log
/// error over log step between the smallest two. In double precision.
std::vector<AnalyticFigure> convergence_in_step(const RunSettings& setup);

/// The same against cells, halved from one grid to the next: RMS distance from the finest, at the particles that all
/// grids share.
std::vector<AnalyticFigure> convergence_in_cells(const RunSettings& setup);

} // namespace tutu::app
