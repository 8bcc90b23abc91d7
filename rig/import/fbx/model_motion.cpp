#include "rig/import/fbx/model_motion.h"

#include <cmath>
#include <numbers>

namespace tutu::rig::import_detail {
namespace {

constexpr double k_degree = std::numbers::pi / 180.0;
constexpr std::array<int, 3> k_orders[] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}};

Quat turned(const Vec3& degrees, const std::array<int, 3>& order) {
  Quat result = Quat::Identity();
  for (const int axis : order) result = Quat(Eigen::AngleAxisd(degrees[axis] * k_degree, Vec3::Unit(axis))) * result;
  return result;
}

std::vector<const ScalarCurve*> curves_of(const FbxModel& model) {
  std::vector<const ScalarCurve*> curves;
  for (const FbxTrack* track : {&model.translation, &model.rotation, &model.scale})
    for (const ScalarCurve& curve : track->curves)
      if (!curve.empty()) curves.push_back(&curve);
  return curves;
}

/// What stands between translation and pivot: Soff + Sp - S Sp - Rp.
Vec3 arm(const FbxModel& model, const Vec3& scale) {
  return model.scaling_offset + model.scaling_pivot - scale.cwiseProduct(model.scaling_pivot) - model.rotation_pivot;
}

/// Does nothing but its own curves move the translation?
bool has_translation_alone(const FbxModel& model) {
  const bool scale_is_idle = !model.scale.moves() || model.scaling_pivot.isZero(0.0);
  const bool has_no_arm = scale_is_idle && arm(model, model.scale.constant).isZero(0.0);
  return has_no_arm || (scale_is_idle && !model.rotation.moves());
}

std::array<const ScalarCurve*, 3> parts_of(const FbxTrack& track) {
  std::array<const ScalarCurve*, 3> parts{};
  for (std::size_t i = 0; i < 3; ++i)
    if (!track.curves[i].empty()) parts[i] = &track.curves[i];
  return parts;
}

} // namespace

Vec3 FbxTrack::at(double time, Side side) const {
  Vec3 result = constant;
  for (std::size_t i = 0; i < 3; ++i)
    if (!curves[i].empty()) result[static_cast<Eigen::Index>(i)] = value_at(curves[i], time, side);
  return result;
}

Quat FbxModel::rotation_at(double time, Side side) const {
  return (before * turned(rotation.at(time, side), order) * behind).normalized();
}

Pose FbxModel::at(double time, Side side) const {
  Pose pose;
  pose.rotation = rotation_at(time, side);
  pose.scale = scale.at(time, side);
  pose.translation =
      translation.at(time, side) + rotation_offset + rotation_pivot + pose.rotation * arm(*this, pose.scale);
  return pose;
}

FbxModel model_of(const FbxDocument& document, const FbxObject& object) {
  const Vec3 zero = Vec3::Zero();
  FbxModel model;
  model.translation.constant = document.vector(object, "Lcl Translation", zero);
  model.rotation.constant = document.vector(object, "Lcl Rotation", zero);
  model.scale.constant = document.vector(object, "Lcl Scaling", Vec3::Ones());
  model.rotation_offset = document.vector(object, "RotationOffset", zero);
  model.rotation_pivot = document.vector(object, "RotationPivot", zero);
  model.scaling_offset = document.vector(object, "ScalingOffset", zero);
  model.scaling_pivot = document.vector(object, "ScalingPivot", zero);
  // Without it order, pre- and post-rotation are there, but do not count [FBX SDK, FbxNode::SetRotationActive].
  if (document.number(object, "RotationActive", 0.0) == 0.0) return model;
  const double order = document.number(object, "RotationOrder", 0.0); // 6 is XYZ too, on a sphere
  if (order >= 0.0 && order < 6.0) model.order = k_orders[static_cast<std::size_t>(order)];
  model.before = turned(document.vector(object, "PreRotation", zero), k_orders[0]);
  model.behind = turned(document.vector(object, "PostRotation", zero), k_orders[0]).conjugate();
  return model;
}

NodeMotion motion_of(const FbxModel& model, const FbxModel& standing) {
  std::vector<double> times = merged_times(curves_of(model));
  if (times.empty()) times.push_back(0.0); // a take may put a model elsewhere and leave it there
  std::vector<int> cuts;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    double degrees = 0.0;
    for (const ScalarCurve& curve : model.rotation.curves)
      if (!curve.empty()) degrees += way_between(curve, times[i], times[i + 1]);
    cuts.push_back(cuts_for(degrees * k_degree));
  }
  const Pose rest = standing.at(0.0, Side::behind), first = model.at(times[0], Side::behind);
  // Of numbers that alone, and with nothing but an offset, are a translation or a scale.
  const auto exact = [&](const FbxTrack& track, const Vec3& offset, const Vec3& at_rest) {
    const auto at = [&](double time, Side side) -> Vec3 { return offset + track.at(time, side); };
    const double tolerance = tolerance_for(times, at, at_rest);
    const Eigen::Affine3d map(Eigen::Translation3d{offset});
    VectorCurve curve = track.moves() ? joined(parts_of(track), track.constant, map, tolerance)
                                      : VectorCurve{{times[0]}, {at(times[0], Side::behind)}, {Law::step}, {}, {}};
    drop_if_idle(curve, at_rest, tolerance);
    return curve;
  };

  NodeMotion motion;
  motion.rotation =
      model.rotation.moves()
          ? sampled(
                times, cuts, [&](double time, Side side) { return model.rotation_at(time, side); }, k_sampled_angle)
          : RotationCurve{{times[0]}, {first.rotation.coeffs()}, {Law::step}, {}, {}};
  drop_if_idle(motion.rotation, rest.rotation);
  motion.scale = exact(model.scale, Vec3::Zero(), rest.scale);
  if (has_translation_alone(model)) {
    motion.translation =
        exact(model.translation, first.translation - model.translation.at(times[0], Side::behind), rest.translation);
    return motion;
  }
  const auto at = [&](double time, Side side) { return model.at(time, side).translation; };
  const double tolerance = tolerance_for(times, at, rest.translation);
  motion.translation = sampled(times, cuts, at, tolerance);
  drop_if_idle(motion.translation, rest.translation, tolerance);
  return motion;
}

} // namespace tutu::rig::import_detail
