#include "src/view/pose/joint_limits_file.h"

#include "rig/io/json_file.h"

#include <numbers>

namespace tutu::app {
namespace {

constexpr double k_radians = std::numbers::pi / 180.0; // a degree

rig::JointLimit read_limit(const JsonValue& value, const rig::Skeleton& skeleton) {
  value.only_keys({"joint", "axis", "swing_degrees", "twist_degrees"});
  rig::JointLimit limit;
  const JsonValue name = value.at("joint"), axis = value.at("axis"), twist = value.at("twist_degrees");
  const auto joint = skeleton.find(name.string());
  if (!joint) throw name.error("a joint of the character");
  limit.joint = *joint;
  if (!(axis.vec3().norm() > 0.0)) throw axis.error("a direction");
  limit.axis = axis.vec3().normalized();
  limit.most_swing = k_radians * value.at("swing_degrees").number_in(0.0, 180.0);
  const std::vector<double> ends = twist.numbers(2);
  if (!(-180.0 <= ends[0] && ends[0] <= ends[1] && ends[1] <= 180.0))
    throw twist.error("[least, most] within -180 to 180 degrees");
  limit.least_twist = k_radians * ends[0];
  limit.most_twist = k_radians * ends[1];
  return limit;
}

} // namespace

std::vector<rig::JointLimit> read_joint_limits(const std::filesystem::path& file, const rig::Skeleton& skeleton) {
  const JsonValue root = JsonValue::read(file);
  root.only_keys({"limits"});
  std::vector<rig::JointLimit> limits;
  for (const JsonValue& value : root.at("limits").items()) {
    limits.push_back(read_limit(value, skeleton));
    for (std::size_t i = 0; i + 1 < limits.size(); ++i)
      if (limits[i].joint == limits.back().joint) throw value.at("joint").error("every joint once");
  }
  return limits;
}

} // namespace tutu::app
