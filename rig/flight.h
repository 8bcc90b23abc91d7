// Jumps: where the root of a character in the air must be.
#pragma once

#include "rig/clip.h"

#include <string>

namespace tutu::rig {

inline constexpr double k_gravity = 9.81; ///< m/s2, along -Y of model space

/// Makes every run of airborne keys of the clip a flight: between the last key on the ground and the next one, all
/// roots move on a parabola of k_gravity, the sideways velocity constant. The height decides the time in the air: the
/// highest root of the run stands h0 above take-off and h1 above landing, so
///   T = sqrt(2 h0 / g) + sqrt(2 h1 / g),
/// and times move for it: the highest key to the top of the parabola, the others in proportion on their side of it,
/// all later ones by the difference. Root translations of airborne keys are put on the parabola. What is a flight
/// already stays as it is, within rounding. It is the root that flies so, in place of the centre of mass.
///
/// Throws InputError (naming `file`) on a clip that begins or ends in the air, and on a flight that is nowhere higher
/// than both its ends.
void make_flights(Clip& clip, const std::string& file);

/// Does the segment from key `k` to the next belong to a flight?
inline bool is_flight(const Clip& clip, std::size_t k) { return clip.airborne[k] || clip.airborne[k + 1]; }

/// What to add to the straight way between two points of a parabola, `passed` of `duration` seconds (m, upwards).
inline Vec3 above_chord(double passed, double duration) {
  return {0.0, 0.5 * k_gravity * passed * (duration - passed), 0.0};
}

} // namespace tutu::rig
