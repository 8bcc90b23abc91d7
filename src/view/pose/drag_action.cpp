#include "src/view/pose/drag_action.h"

#include "rig/drag.h"

#include <algorithm>

namespace tutu::app {
namespace {

/// Unit, in the joint's own frame.
std::optional<Vec3> bone_axis(const rig::Skeleton& skeleton, std::span<const Transform> local, int joint) {
  for (int child = joint + 1; child < skeleton.joint_count(); ++child)
    if (skeleton.parents[child] == joint && local[child].translation.norm() > 0.0)
      return local[child].translation.normalized();
  if (skeleton.parents[joint] == rig::k_no_parent || !(local[joint].translation.norm() > 0.0)) return std::nullopt;
  return local[joint].rotation.conjugate() * local[joint].translation.normalized();
}

} // namespace

std::optional<Ring> ring_of(const rig::Skeleton& skeleton, std::span<const Transform> local, int joint) {
  constexpr double k_share = 0.45, k_least = 0.02, k_most = 0.12; // of the bone's length; m
  const auto axis = bone_axis(skeleton, local, joint);
  if (!axis) return std::nullopt;
  double length = 0.0;
  for (int child = joint + 1; child < skeleton.joint_count() && length == 0.0; ++child)
    if (skeleton.parents[child] == joint) length = local[child].translation.norm();
  if (length == 0.0) length = local[joint].translation.norm();
  const Transform model = rig::model_of_joint(skeleton, local, joint);
  return Ring{model.translation, (model.rotation * *axis).normalized(), std::clamp(k_share * length, k_least, k_most)};
}

DragAction::DragAction(const rig::Skeleton& skeleton, std::span<const BodyLimb> limbs, DragSettings settings,
                       EditState start, Grip grip, int joint, const Ray& press, const Vec3& view_direction)
    : skeleton_(skeleton), limbs_(limbs), settings_(std::move(settings)), start_(std::move(start)), grip_(grip),
      joint_(joint), place_(rig::model_of_joint(skeleton, start_.pose, joint).translation),
      view_direction_(view_direction), last_(place_), ring_(ring_of(skeleton, start_.pose, joint)),
      rule_(rule_for(grip)) {
  if (rule_ == Rule::ring) first_angle_ = angle_on_ring(*ring_, press);
}

DragAction::Rule DragAction::rule_for(Grip grip) const {
  if (grip == Grip::ring) return ring_ ? Rule::ring : Rule::nothing;
  if (skeleton_.parents[joint_] == rig::k_no_parent) return Rule::root;
  for (const rig::FootPin& pin : start_.pins)
    if (pin.limb.end == joint_) return Rule::pinned_foot;
  if (!settings_.ik) return Rule::bone;
  if (limb_ending_at(limbs_, joint_)) return Rule::limb;
  if (limb_bending_at(limbs_, joint_)) return Rule::pole;
  return chain_ending_at(skeleton_, joint_).size() > 1 ? Rule::chain : Rule::bone;
}

EditState DragAction::at(const Ray& ray) {
  EditState state = start_;
  turn(state, ray);
  if (rule_ != Rule::pinned_foot && same_pose(state.pose, start_.pose)) return start_;
  hold_pins(state);
  state.loose = true;
  return state;
}

Vec3 DragAction::target_on_sphere(const Ray& ray) {
  const Vec3 centre = rig::model_of_joint(skeleton_, start_.pose, skeleton_.parents[joint_]).translation;
  const double radius = (place_ - centre).norm();
  last_ = rig::nearest_on_bone_sphere(centre, place_, on_sphere(ray, centre, radius, last_));
  return last_;
}

void DragAction::turn(EditState& state, const Ray& ray) {
  const std::span<Transform> local = state.pose;
  const Vec3 on_view = on_plane(ray, place_, view_direction_).value_or(place_);
  switch (rule_) {
  case Rule::nothing: break;
  case Rule::root: rig::drag_joint(skeleton_, local, joint_, on_view); break;
  case Rule::bone:
    if (settings_.one_child) {
      rig::drag_joint_alone(skeleton_, local, joint_, target_on_sphere(ray));
      apply_limit(state, joint_);
    } else {
      rig::drag_joint(skeleton_, local, joint_, target_on_sphere(ray));
      apply_limit(state, skeleton_.parents[joint_]);
    }
    break;
  case Rule::ring: {
    const double angle = angle_on_ring(*ring_, ray) - first_angle_;
    const Vec3 axis = *bone_axis(skeleton_, start_.pose, joint_);
    if (angle != 0.0)
      local[joint_].rotation = (local[joint_].rotation * Quat(Eigen::AngleAxisd(angle, axis))).normalized();
    apply_limit(state, joint_);
    break;
  }
  case Rule::limb: {
    const BodyLimb limb = *limb_ending_at(limbs_, joint_);
    rig::solve_limb(skeleton_, local, limb.limb, on_view, pole_of(skeleton_, local, limb), settings_.limits);
    break;
  }
  case Rule::pole: {
    const BodyLimb limb = *limb_bending_at(limbs_, joint_);
    const Vec3 end = rig::model_of_joint(skeleton_, local, limb.limb.end).translation;
    rig::solve_limb(skeleton_, local, limb.limb, end, on_view, settings_.limits);
    break;
  }
  case Rule::chain:
    rig::solve_chain(skeleton_, local, chain_ending_at(skeleton_, joint_), on_view, settings_.limits);
    break;
  case Rule::pinned_foot:
    if (const auto place = on_plane(ray, place_, Vec3::UnitY())) {
      rig::FootPin& pin = *pin_of(state, joint_);
      pin.model_from_foot.translation.x() = place->x();
      pin.model_from_foot.translation.z() = place->z();
    }
    break;
  }
}

void DragAction::apply_limit(EditState& state, int joint) const {
  for (const rig::JointLimit& limit : settings_.limits)
    if (limit.joint == joint)
      state.pose[joint].rotation =
          rig::limited(state.pose[joint].rotation, skeleton_.rest_local[joint].rotation, limit);
}

void DragAction::hold_pins(EditState& state) const {
  for (const rig::FootPin& pin : state.pins) {
    const BodyLimb limb{pin.limb, true};
    rig::hold_foot(skeleton_, state.pose, pin, pole_of(skeleton_, state.pose, limb), settings_.limits);
  }
}

rig::FootPin* DragAction::pin_of(EditState& state, int foot) const {
  const auto found =
      std::find_if(state.pins.begin(), state.pins.end(), [&](const rig::FootPin& pin) { return pin.limb.end == foot; });
  return found == state.pins.end() ? nullptr : &*found;
}

} // namespace tutu::app
