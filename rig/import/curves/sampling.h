// Private to the importer: what a file says of a node by other numbers (angles about axes, pivots, handles with
// weights) as curves of translation, rotation and scale.
//
// Times are the merged key times of all that has part in it, s, rising and different, at least one. Between two of
// them nothing jumps; at one of them the side says which value is meant.
#pragma once

#include "rig/curve.h"
#include "rig/import/curves/scalar_curve.h"

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <vector>

namespace tutu::rig::import_detail {

/// The different times of all keys, rising.
std::vector<double> merged_times(const std::vector<const ScalarCurve*>& curves);

/// translation * rotation * diag(scale), of which a shear is left out.
struct Pose {
  Vec3 translation = Vec3::Zero();
  Quat rotation = Quat::Identity();
  Vec3 scale = Vec3::Ones();
};
/// By polar decomposition: the rotation is proper, a mirrored map has scales below 0. A map of rank below 3 keeps a
/// rotation that fits. `has_shear` is set where the pose is not all of the map, to 1e-4 of it.
Pose pose_of(const Eigen::Affine3d& map, bool& has_shear);

/// Three numbers, each a curve (at least one is, with keys) or null and constant, as one curve of map(numbers): exactly
/// where all are polynomials of time, else as sampled() does.
VectorCurve joined(const std::array<const ScalarCurve*, 3>& curves, const Vec3& constant, const Eigen::Affine3d& map,
                   double tolerance);

/// Pieces that are straight (of rotations arcs) or else cubic, cut in halves until they are nearer than `tolerance` to
/// the value at the sixths of each (of rotations rad). Pieces that stay within a thousandth of it are held.
/// `first_cuts`, one an interval or empty, says into how many pieces it is cut at least: a value that comes round to
/// where it was would else pass for one that rests. Throws std::length_error beyond k_most_pieces.
inline constexpr std::size_t k_most_pieces = 1'000'000; ///< of a curve: some hundred megabytes
VectorCurve sampled(const std::vector<double>& times, const std::vector<int>& first_cuts,
                    const std::function<Vec3(double time, Side side)>& at, double tolerance);
RotationCurve sampled(const std::vector<double>& times, const std::vector<int>& first_cuts,
                      const std::function<Quat(double time, Side side)>& at, double tolerance);

/// As many first cuts as make each piece turn by an eighth of a turn at most; of angles in rad.
int cuts_for(double turn);

/// How near sampled curves stay: rad, and of lengths and scales as a share of the largest.
inline constexpr double k_sampled_angle = 1e-5, k_sampled_share = 1e-5;

/// For a length (or scale) that is this over time, and that at rest.
double tolerance_for(const std::vector<double>& times, const std::function<Vec3(double time, Side side)>& at,
                     const Vec3& rest);

/// Leaves a curve that never leaves `rest` without keys.
void drop_if_idle(VectorCurve& curve, const Vec3& rest, double tolerance);
void drop_if_idle(RotationCurve& curve, const Quat& rest);

/// Translation, rotation and scale of pose(time, side), sampled; what never leaves `rest` without keys.
struct PoseCurves {
  VectorCurve translation;
  RotationCurve rotation;
  VectorCurve scale;
};
PoseCurves sampled_pose(const std::vector<double>& times, const std::vector<int>& first_cuts,
                        const std::function<Pose(double time, Side side)>& pose, const Pose& rest);

} // namespace tutu::rig::import_detail
