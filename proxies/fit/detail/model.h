// What a fit changes: units of one or two capsules, and where they are in each pose.
#pragma once

#include "proxies/fit/detail/points.h"
#include "proxies/shapes.h"

#include <array>
#include <span>
#include <vector>

namespace tutu::proxies::fit {

using Affine = Eigen::Matrix<double, 3, 4>;

/// Left and right: x -> -x in model space at rest.
inline Vec3 mirrored(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }

/// Where the rest pose's points go in each pose if they ride on one joint, and which joints face each other.
struct BodyMotion {
  int poses = 0, joints = 0;
  std::vector<Affine> model_from_rest; ///< [pose * joints + joint]
  std::vector<int> mirror;             ///< [joint]: the one on the other side; itself on the middle; -1: none
  double height = 0.0;                 ///< m, of the rest pose's samples: what lengths are compared with
  double area = 0.0;                   ///< m2, of the whole skin at rest

  const Affine& at(int pose, int joint) const {
    return model_from_rest[static_cast<std::size_t>(pose) * joints + joint];
  }
};
BodyMotion body_motion(const rig::Character& character, const std::vector<std::vector<Transform>>& poses,
                       bool symmetric, const std::vector<SkinPoint>& skin);

/// The joints that an end rides on, weights falling and summing to 1.
struct EndSkin {
  int count = 0;
  std::array<int, 4> joints = {};
  std::array<double, 4> weights = {};
  bool operator==(const EndSkin&) const = default;
};
EndSkin mirrored(const EndSkin& skin, const BodyMotion& motion);
/// From a sum of weights of every joint: the four largest, small ones dropped; what is on the middle is kept symmetric.
EndSkin end_skin(std::vector<double> weight_of_joint, const BodyMotion& motion, bool on_middle);

enum class UnitKind {
  one,    ///< a capsule by itself
  pair,   ///< a capsule of the left side and its mirror image
  middle, ///< a capsule whose ends lie on the middle plane
  across  ///< a capsule from the left to its mirror image
};

/// One set of parameters: ends in model space at rest, and the radii there. Of a middle, x = 0; of an across, b, its
/// radius and skin_b are the mirror images of a, its radius and skin_a.
struct Unit {
  UnitKind kind = UnitKind::one;
  bool tapered = false; ///< may have two radii
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double radius_a = 0.0, radius_b = 0.0;
  EndSkin skin_a, skin_b;
  std::vector<Affine> frames_a, frames_b; ///< [(0 or 1 for the mirror image) * poses + pose]

  int shapes() const { return kind == UnitKind::pair ? 2 : 1; }
  /// Makes the constraints of the kind hold, and the frames follow the skins.
  void settle(const BodyMotion& motion);
};

/// Parameters of a unit in one row: a, b, both radii. Takes a derivative with respect to those of the unit's own shape
/// to one with respect to what the kind leaves free.
using Row = Eigen::Matrix<double, 8, 1>;
using Hessian = Eigen::Matrix<double, 8, 8>;
inline void constrain(Row& row, const Unit& unit) {
  if (unit.kind == UnitKind::middle) row[0] = row[3] = 0.0;
  if (unit.kind == UnitKind::across) {
    row.head<3>() += mirrored(Vec3(row.segment<3>(3)));
    row.segment<3>(3).setZero();
  }
  if (unit.tapered && unit.kind != UnitKind::across) return;
  row[6] += row[7];
  row[7] = 0.0;
}

/// All shapes of some units in all poses.
struct PosedShapes {
  int count = 0, poses = 0;
  std::vector<int> unit;         ///< [shape]
  std::vector<char> image;       ///< [shape]: 1 for the mirror image of a pair
  std::vector<Capsule> capsules; ///< [pose * count + shape]

  void place(std::span<const Unit> units, const BodyMotion& motion);
  void resize(); ///< everything but unit and image, to poses * count
  void set(std::size_t i, const Capsule& capsule);
  std::size_t at(int pose, int shape) const { return static_cast<std::size_t>(pose) * count + shape; }
  ShapeArrays arrays() const; ///< the same, for the search; good until the shapes change

private:
  std::array<std::vector<float>, 10> arrays_; // in the order of ShapeArrays
};

/// What is nearest to each lane of some blocks: signed distance and shape; and the nearest shape of another unit.
struct Nearest {
  std::vector<float> distance, second_distance; ///< infinite where there is no second
  std::vector<int> shape, second_shape;
};
/// `second`: also fill what belongs to the second.
void find_nearest(const PointBlocks& blocks, const PosedShapes& shapes, bool second, Nearest& nearest);

/// The proxies of some units, lengths rounded to a hundredth of a millimetre; names from joints. On skeleton joints.
std::vector<Proxy> proxies_of(std::span<const Unit> units, const BodyMotion& motion, const rig::Skeleton& skeleton);

} // namespace tutu::proxies::fit
