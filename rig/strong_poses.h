// Poses at the ends of what a dancer does, for any skeleton whose joints have names that say what they are.
#pragma once

#include "rig/skeleton.h"

#include <string>
#include <vector>

namespace tutu::rig {

struct NamedPose {
  std::string name;
  std::vector<Transform> model; ///< model_from_joint, m
};

/// The rest pose, then about 40 others, the same each time: a leg raised 100 degrees to the front and to the side,
/// knees bent 120 degrees, lunge, split, squat, arms up and forward, spine bent and twisted, and ways between. Limbs
/// are turned by directions, not by angles from rest, so that bodies that rest with arms out and with arms down come to
/// the same poses. Joints are found by name (Mixamo's and other usual ones, either side); what is not found stays at
/// rest. Empty but for the rest pose when neither a leg nor an arm is found.
std::vector<NamedPose> strong_poses(const Skeleton& skeleton);

/// "Left", "right", or neither, from a joint's name.
enum class Side { middle, left, right };
Side side_of(std::string_view joint_name);

/// The name of the joint on the other side: "mixamorig:LeftArm" -> "mixamorig:RightArm", "B_Knee_Left" ->
/// "B_Knee_Right", "thigh_l" -> "thigh_r". Empty for names without a side.
std::string name_on_other_side(std::string_view joint_name);

/// What garments seldom touch and few shapes cannot follow.
enum class BodyPart { garment, head, hand, toes };
/// Of each joint, by its name and those above it: what hangs on a hand or the head belongs to it.
std::vector<BodyPart> body_parts(const Skeleton& skeleton);

} // namespace tutu::rig
