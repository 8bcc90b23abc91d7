// How fast cloth comes to rest by itself, which is a matter of the fabric and not of the substeps.
#pragma once

#include "src/study/bench/analytic_scenes.h"

namespace tutu::app {

/// Sheets of 0.6 m and 20 x 20 particles, or of as large irregular triangles, without drag, at `setup.substeps` beside
/// twice as many, k_swing_substeps at least, in double. Let go: from 80 degrees about the edge that holds them (swing),
/// pulled longer by a hundredth (bounce), pulled aside (shear). Decay is that of amplitude: half the logarithm of the
/// energy above rest. And the angular momentum that a woven sheet keeps which spins in empty space.
std::vector<AnalyticFigure> swing(const RunSettings& setup, bool of_triangles = false);

inline constexpr int k_swing_substeps = 48;      ///< what decays are compared with
inline constexpr double k_swing_tolerance = 0.1; ///< of a decay
inline constexpr double k_spin_tolerance = 1.0;  ///< % of the angular momentum

} // namespace tutu::app
