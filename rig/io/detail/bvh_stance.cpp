#include "rig/io/detail/bvh_stance.h"

#include "rig/body_regions.h"
#include "rig/strong_poses.h"

#include <algorithm>
#include <cmath>

namespace tutu::rig::bvh_detail {
namespace {

constexpr int k_y = 1, k_z = 2;
/// So much of a direction along an axis is along it: within 37 degrees, which a bow or a stride is and a seat is not.
constexpr double k_mostly = 0.8;
/// The hips of who stands are so many leg lengths above the floor.
constexpr double k_least_hips = 0.5, k_most_hips = 1.5;

std::vector<Transform> model_of(const Hierarchy& hierarchy, const Pose& pose) {
  std::vector<Transform> model(pose.size());
  model_from_local(hierarchy.skeleton, pose, model);
  return model;
}

/// How much more a body reaches along one axis than along another is told by its points.
std::vector<Vec3> points_of(const Hierarchy& hierarchy, const Pose& pose) {
  const std::vector<Transform> model = model_of(hierarchy, pose);
  std::vector<Vec3> points;
  for (const Transform& joint : model) points.push_back(joint.translation);
  for (const auto& end : hierarchy.ends) points.push_back(model[end.parent] * end.offset);
  return points;
}

/// From the feet up the legs: the mean of their directions.
Vec3 up_the_legs(const Landmarks& marks, const std::vector<Transform>& model) {
  Vec3 sum = Vec3::Zero();
  for (const auto& leg : marks.legs)
    sum += (model[leg.top].translation - model[leg.foot].translation).normalized(); // of no length: zero
  return marks.known() ? Vec3(sum / static_cast<double>(marks.legs.size())) : sum;
}

/// The axis (with its sign) that a direction is mostly along.
std::optional<Vec3> main_axis(const Vec3& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  if (!(std::abs(direction[axis]) >= k_mostly)) return std::nullopt;
  return std::copysign(1.0, direction[axis]) * Vec3::Unit(axis);
}

/// Which way is up in a pose that stands: along its legs, the head on the far side of the hips.
std::optional<Vec3> stance(const Hierarchy& hierarchy, const Landmarks& marks, const Pose& pose) {
  const std::vector<Transform> model = model_of(hierarchy, pose);
  const std::optional<Vec3> up = main_axis(up_the_legs(marks, model));
  if (!up || (marks.head && up->dot(model[*marks.head].translation - model[0].translation) <= 0.0)) return std::nullopt;
  return up;
}

/// From the hips down to the feet along the bones; of all legs the mean. 0 where that is not known.
double leg_length(const Hierarchy& hierarchy, const Landmarks& marks) {
  const Skeleton& skeleton = hierarchy.skeleton;
  double sum = 0.0;
  for (const auto& leg : marks.legs)
    for (int j = leg.foot; skeleton.parents[j] != k_no_parent; j = skeleton.parents[j])
      sum += skeleton.rest_local[j].translation.norm();
  return marks.known() ? sum / static_cast<double>(marks.legs.size()) : 0.0;
}

/// Whether the root's mean coordinate along an axis is a height that hips on such legs have.
bool is_hip_height(std::span<const Pose> samples, int axis, double leg) {
  double sum = 0.0;
  for (const Pose& pose : samples) sum += pose[0].translation[axis];
  const double height = sum / static_cast<double>(samples.size());
  return leg > 0.0 && height >= k_least_hips * leg && height <= k_most_hips * leg;
}

/// Of a skeleton whose names say nothing: it reaches far along +Z and little along +Y, as no body does that stands on
/// the plane of X and Z, and its root is as high along +Z as its lower half is long, and not so along +Y.
bool looks_z_up(const Hierarchy& hierarchy, std::span<const Pose> samples) {
  constexpr double k_far = 3.0;
  Pose zero = hierarchy.skeleton.rest_local;
  zero[0].translation.setZero();
  Vec3 least = Vec3::Zero(), most = Vec3::Zero();
  for (const Vec3& point : points_of(hierarchy, zero)) {
    least = least.cwiseMin(point);
    most = most.cwiseMax(point);
  }
  const Vec3 reach = most - least;
  return reach[k_z] > k_far * reach[k_y] && is_hip_height(samples, k_z, -least[k_z]) &&
         !is_hip_height(samples, k_y, -least[k_z]);
}

/// Turned about +Y to face +Z, where the names tell left from right, and there where all rotations zero have it.
void face_forward(const Hierarchy& hierarchy, const Landmarks& marks, Pose& pose) {
  const std::vector<Transform> model = model_of(hierarchy, pose);
  Vec3 to_left = Vec3::Zero();
  for (const auto& leg : marks.legs) {
    const Side side = side_of(hierarchy.skeleton.names[leg.foot]);
    if (side == Side::middle) continue;
    to_left += (side == Side::left ? 1.0 : -1.0) * (model[leg.top].translation - model[0].translation);
  }
  const Vec3& zero = hierarchy.skeleton.rest_local[0].translation;
  pose[0].translation = {zero.x(), pose[0].translation.y(), zero.z()};
  to_left.y() = 0.0;
  if (!(to_left.norm() > 0.0)) return;
  const Quat turn(Eigen::AngleAxisd(std::atan2(to_left.z(), to_left.x()), Vec3::UnitY()));
  pose[0].rotation = (turn * pose[0].rotation).normalized();
}

/// A share of sorted values below it.
double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The height of the lowest foot (the joint: what is below it turns with it, and need not be flat at rest); where feet
/// are not known, of the lowest point.
double lowest_foot(const Hierarchy& hierarchy, const Landmarks& marks, const Pose& pose) {
  if (!marks.known()) return extent_of(hierarchy, pose).lowest;
  const std::vector<Transform> model = model_of(hierarchy, pose);
  double lowest = model[marks.legs.front().foot].translation.y();
  for (const auto& leg : marks.legs) lowest = std::min(lowest, model[leg.foot].translation.y());
  return lowest;
}

std::string shown(double value) {
  std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 3);
}

/// How far the root is above the feet of one who stands straight, whether the rest pose has its legs together or apart;
/// where legs are not known, above the lowest point.
double hips_above_feet(const Hierarchy& hierarchy, const Landmarks& marks, const Pose& rest) {
  const std::vector<Transform> model = model_of(hierarchy, rest);
  const double root = model[0].translation.y();
  if (!marks.known()) return root - extent_of(hierarchy, rest).lowest;
  double sum = 0.0;
  for (const auto& leg : marks.legs) {
    sum += root - model[leg.top].translation.y();
    for (int j = leg.foot; j != leg.top; j = hierarchy.skeleton.parents[j])
      sum += hierarchy.skeleton.rest_local[j].translation.norm();
  }
  return sum / static_cast<double>(marks.legs.size());
}

/// The root at rest as high as in the motion, where the actor stands: feet there tell how thick its soles are. Where
/// the motion's feet are nowhere near 0, the floor is not there either: it is put below them.
void put_on_floor(const Hierarchy& hierarchy, const Landmarks& marks, std::span<const Pose> samples,
                  Standing& standing) {
  constexpr double k_standing = 0.1; // of all poses: the feet are lower in few, by noise
  // As a share of the hips' height: a foot of 0 to 0.25 is that of one who stands, a little less one that sinks in.
  constexpr double k_sunk = -0.1, k_raised = 0.25;
  const Extent extent = extent_of(hierarchy, standing.rest);
  const double hips = hips_above_feet(hierarchy, marks, standing.rest);
  double rest_foot = lowest_foot(hierarchy, marks, standing.rest) - extent.lowest; // on its lowest point
  if (hips > 1e-3 * (extent.highest - extent.lowest)) {
    std::vector<double> feet;
    for (const Pose& pose : samples) feet.push_back(lowest_foot(hierarchy, marks, pose));
    const double stands_at = quantile(std::move(feet), k_standing);
    if (stands_at >= k_sunk * hips && stands_at <= k_raised * hips) {
      rest_foot = stands_at;
    } else {
      standing.raise = rest_foot - stands_at;
      standing.notes.push_back("the feet stand at a height of " + shown(stands_at) + " (unit of the file): the floor " +
                               "is taken to be there");
    }
  }
  standing.rest[0].translation.y() = rest_foot + hips;
}

} // namespace

Landmarks find_landmarks(const Skeleton& skeleton) {
  const std::vector<BodyRegion> regions = body_regions(skeleton);
  Landmarks marks;
  constexpr int k_none = -1;
  std::vector<int> leg_of(regions.size(), k_none);
  std::vector<bool> has_foot;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    if (regions[j] == BodyRegion::head && !marks.head) marks.head = j;
    const bool is_foot = regions[j] == BodyRegion::feet;
    if (!is_foot && regions[j] != BodyRegion::legs) continue;
    const int parent = skeleton.parents[j];
    leg_of[j] = parent == k_no_parent ? k_none : leg_of[parent];
    if (leg_of[j] == k_none) {
      leg_of[j] = static_cast<int>(marks.legs.size());
      marks.legs.push_back({j, j});
      has_foot.push_back(is_foot);
    } else if (!has_foot[leg_of[j]]) { // of one without a foot, its last joint
      marks.legs[leg_of[j]].foot = j;
      has_foot[leg_of[j]] = is_foot;
    }
  }
  // "LeftHip, LeftKnee, LeftAnkle": what is above the shin is the thigh, whatever its name.
  for (auto& leg : marks.legs)
    for (int bones = leg.top == leg.foot ? 0 : skeleton.parents[leg.foot] == leg.top ? 1 : 2; bones < 2; ++bones) {
      const int above = skeleton.parents[leg.top];
      if (above == k_no_parent || (bones == 1 && skeleton.parents[above] == k_no_parent)) break;
      leg.top = above;
    }
  std::erase_if(marks.legs, [](const auto& leg) { return leg.top == leg.foot; });
  return marks;
}

bool is_z_up(const Hierarchy& hierarchy, const Landmarks& marks, std::span<const Pose> samples, const Pose* rest) {
  if (!marks.known()) return looks_z_up(hierarchy, samples);
  const auto is = [](const std::optional<Vec3>& up, int axis) { return up && (*up)[axis] > 0.5; };
  if (rest)
    if (const auto up = stance(hierarchy, marks, *rest)) return (*up)[k_z] > 0.5;
  const std::optional<Vec3> zero = stance(hierarchy, marks, hierarchy.skeleton.rest_local);
  Vec3 sum = Vec3::Zero();
  for (const Pose& pose : samples) sum += up_the_legs(marks, model_of(hierarchy, pose));
  const std::optional<Vec3> motion = main_axis(sum / static_cast<double>(samples.size()));
  const double leg = leg_length(hierarchy, marks);
  const bool high_y = is_hip_height(samples, k_y, leg), high_z = is_hip_height(samples, k_z, leg);
  // Who is upright in the motion is so in the world, whichever way zero lies; but who is along +Z in a skeleton that
  // stands along +Y may lie through the whole take: then the hips are not that high.
  if (is(motion, k_y)) return false;
  if (is(motion, k_z)) return !is(zero, k_y) || high_z;
  return is(zero, k_z) && !(high_y && !high_z);
}

Vec3 turned_to_y_up(const Vec3& v) { return {v.x(), v.z(), -v.y()}; }

Transform turned_to_y_up(const Transform& t) {
  const Quat& q = t.rotation;
  return {Quat(q.w(), q.x(), q.z(), -q.y()), turned_to_y_up(t.translation)};
}

Standing find_standing(const Hierarchy& hierarchy, const Landmarks& marks, std::span<const Pose> samples) {
  Standing standing{hierarchy.skeleton.rest_local, 0.0, {}, {}};
  if (marks.known()) {
    const std::optional<Vec3> up = stance(hierarchy, marks, standing.rest);
    if (up && up->y() < 0.5) {
      standing.rest[0].rotation = rotation_between(*up, Vec3::UnitY());
      standing.notes.emplace_back("the pose with all rotations zero lies: stood up, it is the rest pose");
    } else if (!up) {
      const auto uprightness = [&](const Pose& pose) {
        const std::vector<Transform> model = model_of(hierarchy, pose);
        const Vec3 head = marks.head ? Vec3(model[*marks.head].translation - model[0].translation) : Vec3::UnitY();
        return up_the_legs(marks, model).y() + head.normalized().y();
      };
      // The first that stands, as takes begin; else the one that comes nearest to it.
      const auto stands = std::ranges::find_if(samples, [&](const Pose& pose) {
        const auto way = stance(hierarchy, marks, pose);
        return way && way->y() > 0.5;
      });
      const auto chosen = stands != samples.end() ? stands : std::ranges::max_element(samples, {}, uprightness);
      standing.rest = *chosen;
      face_forward(hierarchy, marks, standing.rest);
      standing.sample = static_cast<std::size_t>(chosen - samples.begin());
    }
  }
  put_on_floor(hierarchy, marks, samples, standing);
  return standing;
}

Extent extent_of(const Hierarchy& hierarchy, const Pose& pose) {
  const std::vector<Transform> model = model_of(hierarchy, pose);
  Extent extent{model.front().translation.y(), model.front().translation.y()};
  const auto add = [&](double y) {
    extent.lowest = std::min(extent.lowest, y);
    extent.highest = std::max(extent.highest, y);
  };
  for (const Transform& joint : model) add(joint.translation.y());
  for (const auto& end : hierarchy.ends) add((model[end.parent] * end.offset).y());
  return extent;
}

} // namespace tutu::rig::bvh_detail
