// The numbers that decide, in one place: unit, reason, and what each must be smaller or larger than.
#pragma once

namespace tutu::cloth {

/// Stretch (length / rest length - 1) of a structural spring at which a run counts as diverged. Larger than anything a
/// loose garment shows (the report's own springs reached 4.6), smaller than what an explosion passes through within a
/// few substeps.
inline constexpr double k_diverged_stretch = 10.0;

/// m. A particle farther from the origin than this has been thrown there: farther than any stage, and near enough for
/// collision queries to be exact to a micrometre.
inline constexpr double k_world_radius = 1e6;

/// m. Least distance a particle may wander from where its candidates were found before they are found again. Larger
/// than a resting particle's tremble, so that still cloth searches once a frame; smaller than a limb, so that
/// candidates stay few.
inline constexpr double k_least_margin = 0.005;

/// How much farther than its speed promises a particle may go within a frame before its candidates are found again. At
/// 1 every accelerating particle would ask twice; beyond 2 the boxes catch colliders that are never met.
inline constexpr double k_margin_growth = 1.5;

/// m. Rounding slack of the "cannot have arrived yet" test: far above the rounding of metre-sized sums of 1e3 steps
/// (1e-13), far below any thickness.
inline constexpr double k_travel_slack = 1e-9;

/// m/s. A drape has settled when no particle is faster: 1 mm of creep a second is not seen.
inline constexpr double k_settled_speed = 0.001;

} // namespace tutu::cloth
