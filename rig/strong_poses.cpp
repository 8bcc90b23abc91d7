#include "rig/strong_poses.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>

namespace tutu::rig {
namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }
Quat about(const Vec3& axis, double degrees) { return Quat(Eigen::AngleAxisd(radians(degrees), axis)); }

/// The joints that poses turn. -1 where there is none.
struct Roles {
  std::array<int, 2> upper_leg{-1, -1}, lower_leg{-1, -1}, foot{-1, -1}, upper_arm{-1, -1}, forearm{-1, -1},
      hand{-1, -1};
  std::vector<int> spine; ///< from the hips up
};

std::string plain(std::string_view joint) { // lower case, letters only
  std::string result;
  for (const char c : bare_joint_name(joint))
    if (std::isalpha(static_cast<unsigned char>(c))) result += static_cast<char>(std::tolower(c));
  return result;
}

bool has(const std::string& name, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view w) { return name.find(w) != std::string::npos; });
}

bool is_below(const Skeleton& skeleton, int joint, int above) {
  while (joint != k_no_parent && joint != above) joint = skeleton.parents[joint];
  return joint == above;
}

Roles find_roles(const Skeleton& skeleton) {
  Roles roles;
  const auto take = [&](std::array<int, 2>& role, std::size_t side, int joint) {
    if (role[side] < 0) role[side] = joint;
  };
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const Side side = side_of(skeleton.names[j]);
    const std::string name = plain(skeleton.names[j]);
    if (side == Side::middle) {
      if (has(name, {"spine", "chest", "torso", "abdomen"})) roles.spine.push_back(j);
      continue;
    }
    if (has(name, {"twist", "roll", "finger", "thumb", "index", "toe"})) continue;
    const std::size_t s = side == Side::left ? 0 : 1;
    if (has(name, {"upleg", "upperleg", "thigh", "hip"})) take(roles.upper_leg, s, j);
    else if (has(name, {"leg", "knee", "calf", "shin"})) take(roles.lower_leg, s, j);
    else if (has(name, {"foot", "ankle"})) take(roles.foot, s, j);
    else if (has(name, {"forearm", "lowerarm", "elbow"})) take(roles.forearm, s, j);
    else if (has(name, {"arm"})) take(roles.upper_arm, s, j);
    else if (has(name, {"hand", "wrist"})) take(roles.hand, s, j);
  }
  for (std::size_t s = 0; s < 2; ++s) {
    if (roles.lower_leg[s] >= 0 && !is_below(skeleton, roles.lower_leg[s], roles.upper_leg[s])) roles.lower_leg[s] = -1;
    if (roles.forearm[s] >= 0 && !is_below(skeleton, roles.forearm[s], roles.upper_arm[s])) roles.forearm[s] = -1;
  }
  return roles;
}

/// What one pose asks for, at a share of its full strength. Directions are those of the left side; of the right
/// they are mirrored.
struct LimbPose {
  std::optional<Vec3> upper; ///< direction of the upper leg or arm, as seen from the pelvis or chest
  double bend = 0.0;         ///< of the knee or elbow, degrees
};
struct Plan {
  const char* name;
  LimbPose left_leg = {}, right_leg = {}, left_arm = {}, right_arm = {};
  double forward = 0.0, side = 0.0, twist = 0.0; ///< of the whole spine, degrees; side: to the left
  double pelvis = 0.0;                           ///< leaned forward, degrees
};

class Poser {
public:
  explicit Poser(const Skeleton& skeleton)
      : skeleton_(skeleton), rest_(rest_model(skeleton)), roles_(find_roles(skeleton)) {}

  const Roles& roles() const { return roles_; }

  std::vector<Transform> pose(const Plan& plan, double strength, bool mirrored) const {
    std::vector<Quat> turns(rest_.size(), Quat::Identity()); // in the axes of the model, before what the parent turns
    const double hand = mirrored ? -1.0 : 1.0;
    for (const int joint : roles_.spine) {
      const double share = strength / static_cast<double>(roles_.spine.size());
      turns[joint] = about(Vec3::UnitY(), hand * share * plan.twist) * about(Vec3::UnitZ(), -hand * share * plan.side) *
                     about(Vec3::UnitX(), share * plan.forward);
    }
    if (!roles_.spine.empty()) {
      const int pelvis = skeleton_.parents[roles_.spine.front()];
      if (pelvis != k_no_parent) turns[pelvis] = about(Vec3::UnitX(), strength * plan.pelvis);
    }
    const auto sides = mirrored ? std::array<std::size_t, 2>{1, 0} : std::array<std::size_t, 2>{0, 1};
    turn_limb(plan.left_leg, roles_.upper_leg[sides[0]], roles_.lower_leg[sides[0]], roles_.foot[sides[0]], mirrored,
              true, strength, turns);
    turn_limb(plan.right_leg, roles_.upper_leg[sides[1]], roles_.lower_leg[sides[1]], roles_.foot[sides[1]], !mirrored,
              true, strength, turns);
    turn_limb(plan.left_arm, roles_.upper_arm[sides[0]], roles_.forearm[sides[0]], roles_.hand[sides[0]], mirrored,
              false, strength, turns);
    turn_limb(plan.right_arm, roles_.upper_arm[sides[1]], roles_.forearm[sides[1]], roles_.hand[sides[1]], !mirrored,
              false, strength, turns);
    return apply(turns);
  }

private:
  void turn_limb(const LimbPose& limb, int upper, int lower, int end, bool right, bool leg, double strength,
                 std::vector<Quat>& turns) const {
    if (upper < 0) return;
    const Vec3 along = lower >= 0 ? Vec3(rest_[lower].translation - rest_[upper].translation) : Vec3(-Vec3::UnitY());
    Quat turn = Quat::Identity();
    if (limb.upper) {
      const Vec3 to = right ? Vec3(-limb.upper->x(), limb.upper->y(), limb.upper->z()) : *limb.upper;
      turn = nlerp(Quat::Identity(), rotation_between(along, to), strength);
      turns[upper] = turn;
    }
    if (lower < 0 || limb.bend == 0.0) return;
    // A knee bends backwards about the axis across the body; an elbow towards the front, or where it already is bent.
    Vec3 axis = Vec3::UnitX();
    if (!leg) {
      const Vec3 further = end >= 0 ? Vec3(rest_[end].translation - rest_[lower].translation) : Vec3::UnitZ();
      axis = along.normalized().cross(further.normalized());
      if (axis.norm() < 0.05) axis = along.cross(Vec3::UnitZ());
    }
    if (axis.norm() > 0.0) turns[lower] = about(axis.normalized(), strength * limb.bend);
  }

  /// A turn is about the joint's origin, in axes that were the model's at rest and have turned with the parent.
  std::vector<Transform> apply(const std::vector<Quat>& turns) const {
    std::vector<Transform> model(rest_.size());
    std::vector<Quat> carried(rest_.size());
    for (std::size_t j = 0; j < rest_.size(); ++j) {
      const int parent = skeleton_.parents[j];
      const Quat above = parent == k_no_parent ? Quat::Identity() : carried[parent];
      carried[j] = (above * turns[j]).normalized();
      model[j].rotation = (carried[j] * rest_[j].rotation).normalized();
      model[j].translation = rest_[j].translation;
      if (parent != k_no_parent)
        model[j].translation = model[parent].translation + above * (rest_[j].translation - rest_[parent].translation);
    }
    return model;
  }

  const Skeleton& skeleton_;
  std::vector<Transform> rest_;
  Roles roles_;
};

Vec3 direction(double out, double front_degrees, double side_degrees) {
  // Down, raised to the front, then opened to the side.
  const Vec3 raised = about(Vec3::UnitX(), -front_degrees) * Vec3(out, -1.0, 0.0).normalized();
  return about(Vec3::UnitZ(), side_degrees) * raised;
}

std::vector<Plan> plans() {
  const Vec3 front = direction(0.1, 100, 0), to_side = direction(0, 0, 100), back = direction(0.1, -45, 0);
  const Vec3 split_front = direction(0.05, 85, 0), split_back = direction(0.05, -75, 0);
  const Vec3 squat = direction(0.35, 95, 0), high = direction(0.15, 115, 0), down = Vec3(0.12, -1, 0);
  const Vec3 up = Vec3(0.15, 1, 0.05), ahead = Vec3(-0.05, 0, 1), out = Vec3(1, 0, 0), cross = Vec3(-0.6, -0.2, 1);
  std::vector<Plan> all;
  all.push_back({.name = "leg to the front", .left_leg = {front, 0}, .right_arm = {ahead, 0}});
  all.push_back({.name = "leg to the side", .left_leg = {to_side, 0}, .left_arm = {out, 0}, .right_arm = {up, 0}});
  all.push_back({.name = "leg to the back", .left_leg = {back, 20}, .right_arm = {ahead, 20}, .forward = 15});
  all.push_back({.name = "knee raised and bent", .left_leg = {high, 120}, .left_arm = {down, 90}});
  all.push_back({.name = "heel to the seat", .left_leg = {down, 120}, .left_arm = {out, 90}, .right_arm = {out, 0}});
  all.push_back({.name = "passe", .left_leg = {direction(0, 0, 75), 120}, .left_arm = {up, 40}, .right_arm = {up, 40}});
  all.push_back({.name = "split",
                 .left_leg = {split_front, 0},
                 .right_leg = {split_back, 0},
                 .left_arm = {out, 0},
                 .right_arm = {out, 0}});
  all.push_back({.name = "lunge",
                 .left_leg = {direction(0.1, 80, 0), 85},
                 .right_leg = {direction(0.1, -30, 0), 10},
                 .right_arm = {ahead, 10}});
  all.push_back({.name = "arms crossed", .left_arm = {cross, 60}, .right_arm = {cross, 60}, .twist = 25});
  all.push_back({.name = "bent to the side", .left_arm = {down, 20}, .right_arm = {up, 20}, .side = 40});
  all.push_back({.name = "twisted", .left_arm = {out, 45}, .right_arm = {out, 45}, .twist = 50});
  all.push_back({.name = "side leg, body leaning away",
                 .left_leg = {to_side, 30},
                 .left_arm = {up, 10},
                 .right_arm = {down, 0},
                 .side = -30,
                 .twist = -20});
  all.push_back({.name = "squat",
                 .left_leg = {squat, 120},
                 .right_leg = {squat, 120},
                 .left_arm = {ahead, 0},
                 .right_arm = {ahead, 0},
                 .forward = 20});
  all.push_back({.name = "straddle",
                 .left_leg = {direction(0, 30, 75), 0},
                 .right_leg = {direction(0, 30, 75), 0},
                 .left_arm = {out, 0},
                 .right_arm = {out, 0}});
  all.push_back({.name = "arms up", .left_arm = {up, 10}, .right_arm = {up, 10}});
  all.push_back({.name = "bent forward", .left_arm = {down, 0}, .right_arm = {down, 0}, .forward = 60, .pelvis = 30});
  all.push_back({.name = "bent back", .left_arm = {up, 0}, .right_arm = {up, 0}, .forward = -40});
  return all;
}

bool is_symmetric(const Plan& plan) {
  const auto same = [](const LimbPose& a, const LimbPose& b) { return a.upper == b.upper && a.bend == b.bend; };
  return same(plan.left_leg, plan.right_leg) && same(plan.left_arm, plan.right_arm) && plan.side == 0.0 &&
         plan.twist == 0.0;
}

} // namespace

std::vector<NamedPose> strong_poses(const Skeleton& skeleton) {
  const Poser poser(skeleton);
  std::vector<NamedPose> poses;
  poses.push_back({"rest", rest_model(skeleton)});
  const Roles& roles = poser.roles();
  const auto none = [](const std::array<int, 2>& pair) { return pair[0] < 0 && pair[1] < 0; };
  if (none(roles.upper_leg) && none(roles.upper_arm)) return poses;
  for (const Plan& plan : plans()) {
    poses.push_back({plan.name, poser.pose(plan, 1.0, false)});
    if (is_symmetric(plan)) {
      poses.push_back({std::string(plan.name) + ", half way", poser.pose(plan, 0.5, false)});
      continue;
    }
    poses.push_back({std::string(plan.name) + ", other side", poser.pose(plan, 1.0, true)});
    // The way there of every second, on alternating sides.
    if (poses.size() % 4 < 2)
      poses.push_back({std::string(plan.name) + ", half way", poser.pose(plan, 0.5, poses.size() % 8 < 4)});
  }
  return poses;
}

} // namespace tutu::rig
