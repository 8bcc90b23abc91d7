#include "rig/mannequin/detail/parts.h"

#include <array>
#include <string_view>

namespace tutu::rig {
namespace {

struct JointPlace {
  std::string_view name, parent; ///< bare names; "*" stands for "Left" and "Right"
  double x, y, z;                ///< of the left one where there are two; model space, m
};

// A-pose: arms 42 degrees below the horizontal, legs 4 degrees apart, feet forward. All joints of one side lie where
// those of the other do, mirrored in x = 0.
constexpr std::array<JointPlace, 29> k_joints = {{
    {"Hips", "", 0.0000, 0.9500, 0.0000},
    {"Spine", "Hips", 0.0000, 1.0300, -0.0040},
    {"Spine1", "Spine", 0.0000, 1.1200, -0.0100},
    {"Spine2", "Spine1", 0.0000, 1.2150, -0.0180},
    {"Neck", "Spine2", 0.0000, 1.4200, -0.0280},
    {"Head", "Neck", 0.0000, 1.5000, -0.0060},

    {"*Shoulder", "Spine2", 0.0350, 1.3850, -0.0200},
    {"*Arm", "*Shoulder", 0.1520, 1.3850, -0.0240},
    {"*ForeArm", "*Arm", 0.3526, 1.2043, -0.0300},
    {"*Hand", "*ForeArm", 0.5263, 1.0480, -0.0054},
    {"*HandThumb1", "*Hand", 0.5363, 1.0283, 0.0161},
    {"*HandThumb2", "*HandThumb1", 0.5505, 0.9981, 0.0432},
    {"*HandThumb3", "*HandThumb2", 0.5644, 0.9747, 0.0580},
    {"*HandIndex1", "*Hand", 0.5901, 0.9932, 0.0260},
    {"*HandIndex2", "*HandIndex1", 0.6170, 0.9633, 0.0338},
    {"*HandIndex3", "*HandIndex2", 0.6306, 0.9428, 0.0384},
    {"*HandMiddle1", "*Hand", 0.5940, 0.9911, 0.0068},
    {"*HandMiddle2", "*HandMiddle1", 0.6222, 0.9562, 0.0110},
    {"*HandMiddle3", "*HandMiddle2", 0.6348, 0.9314, 0.0135},
    {"*HandRing1", "*Hand", 0.5914, 0.9921, -0.0130},
    {"*HandRing2", "*HandRing1", 0.6166, 0.9598, -0.0137},
    {"*HandRing3", "*HandRing2", 0.6285, 0.9355, -0.0141},
    {"*HandPinky1", "*Hand", 0.5851, 0.9937, -0.0309},
    {"*HandPinky2", "*HandPinky1", 0.6064, 0.9691, -0.0360},
    {"*HandPinky3", "*HandPinky2", 0.6166, 0.9521, -0.0390},

    {"*UpLeg", "Hips", 0.0880, 0.9050, 0.0000},
    {"*Leg", "*UpLeg", 0.1173, 0.4860, 0.0040},
    {"*Foot", "*Leg", 0.1456, 0.0810, -0.0280},
    {"*ToeBase", "*Foot", 0.1516, 0.0160, 0.0980},
}};

std::string side_name(std::string_view name, std::string_view side) {
  std::string text = "mixamorig_";
  if (name.starts_with('*')) return text.append(side).append(name.substr(1));
  return text.append(name);
}

} // namespace

Skeleton mannequin_skeleton() {
  Skeleton skeleton;
  std::vector<Vec3> places;
  const auto add = [&](const JointPlace& joint, std::string_view side) {
    const Vec3 place(side == "Right" ? -joint.x : joint.x, joint.y, joint.z);
    const int parent = joint.parent.empty() ? k_no_parent : *skeleton.find(side_name(joint.parent, side));
    const Vec3 parent_place = parent == k_no_parent ? Vec3(Vec3::Zero()) : places[parent];
    skeleton.names.push_back(side_name(joint.name, side));
    skeleton.parents.push_back(parent);
    skeleton.rest_local.push_back({Quat::Identity(), place - parent_place});
    places.push_back(place);
  };
  for (const JointPlace& joint : k_joints)
    if (!joint.name.starts_with('*')) add(joint, "");
  for (const std::string_view side : {"Left", "Right"})
    for (const JointPlace& joint : k_joints)
      if (joint.name.starts_with('*')) add(joint, side);
  return skeleton;
}

} // namespace tutu::rig
