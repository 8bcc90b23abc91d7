// One drag of a joint or of its ring: what the pointer's line of sight makes of the pose.
#pragma once

#include "src/view/pose/edit_state.h"
#include "src/view/pose/limbs.h"
#include "src/view/window/pick.h"

namespace tutu::app {

enum class Grip { joint, ring };

struct DragSettings {
  bool ik = false;        ///< limbs and chains follow the joint; else the one bone turns
  bool one_child = false; ///< the bone turns alone, its siblings stay (rig::drag_joint_alone)
  std::vector<rig::JointLimit> limits;
};

/// The ring of a joint: about the bone to its first child that is away from it, or, at an end, about its own bone.
/// None for a joint without either.
std::optional<Ring> ring_of(const rig::Skeleton& skeleton, std::span<const Transform> local, int joint);

/// Every state is made from the one the drag began with, so that a pointer that comes back brings the pose back, to the
/// bit, and the way there leaves no trace. Model space is world space.
///
///   joint            the bone turns so that the joint is under the pointer, on its bone's sphere (rig/drag.h)
///   root             moves in the plane that faces the camera
///   ring             turns the joint about its bone
///   with IK: hand, foot   bend their limb; in the plane that faces the camera, a pinned foot on its own height
///            knee, elbow  turn about the line from the limb's one end to the other, and point to the pointer
///            others       bend the chain above them
///
/// Joints that turned are brought within their limits, then the legs of pinned feet are bent back to their pins.
class DragAction {
public:
  /// `view_direction`: along which the camera looks, unit. The skeleton and limbs must outlive it.
  DragAction(const rig::Skeleton& skeleton, std::span<const BodyLimb> limbs, DragSettings settings, EditState start,
             Grip grip, int joint, const Ray& press, const Vec3& view_direction);

  EditState at(const Ray& ray);

  Grip grip() const { return grip_; }
  int joint() const { return joint_; }

private:
  enum class Rule { root, bone, ring, limb, pole, chain, pinned_foot, nothing };
  Rule rule_for(Grip grip) const;
  Vec3 target_on_sphere(const Ray& ray);
  void turn(EditState& state, const Ray& ray);
  void apply_limit(EditState& state, int joint) const;
  void hold_pins(EditState& state) const;
  rig::FootPin* pin_of(EditState& state, int foot) const;

  const rig::Skeleton& skeleton_;
  std::span<const BodyLimb> limbs_;
  DragSettings settings_;
  EditState start_;
  Grip grip_;
  int joint_;
  Vec3 place_; ///< of the joint at the start
  Vec3 view_direction_;
  Vec3 last_; ///< of the joint now; which side of its sphere it is on
  std::optional<Ring> ring_;
  double first_angle_ = 0.0;
  Rule rule_;
};

} // namespace tutu::app
