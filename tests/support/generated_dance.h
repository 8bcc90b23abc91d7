// Dances that nobody made: seeded key poses of the built-in dancer in which limbs reach, cross, clap, squat and rest on
// the hip, no joint faster than those of the shipped dance.
#pragma once

#include "rig/skeleton.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <random>
#include <string>

namespace tutu::test {

namespace detail {

/// Rotation vectors of joints from their rest, degrees, about the axes of the rest pose; of the left side.
struct Limbs {
  Vec3 arm = {-30, -25, 30}, fore_arm = Vec3::Zero(), thigh = {-18, 18, 2}, shin = {20, 0, 0};
};

/// The elbow bends about this axis, by degrees.
inline Vec3 bent_elbow(double degrees) { return degrees * Vec3(-0.66, -0.75, 0.0); }

inline Vec3 mirrored(const Vec3& rotation) { return {rotation.x(), -rotation.y(), -rotation.z()}; }

inline Limbs random_limbs(std::mt19937_64& random, int move, bool is_first_side) {
  std::uniform_real_distribution<double> off(-1.0, 1.0);
  const auto about = [&](const Vec3& v, double degrees) {
    return Vec3(v + degrees * Vec3(off(random), off(random), off(random)));
  };
  Limbs limbs;
  limbs.arm = about(limbs.arm, 10);
  limbs.fore_arm = bent_elbow(15 + 10 * off(random));
  limbs.thigh = about(limbs.thigh, 6);
  if (move == 0) limbs.arm = about({-20, -30, 55}, 20);                                // reach
  if (move == 1) limbs.thigh = is_first_side ? Vec3(-35, 10, -18) : Vec3(12, 10, -18); // legs cross
  if (move == 2) {                                                                     // clap
    limbs.arm = about({-35, -70, 20}, 6);
    limbs.fore_arm = bent_elbow(25 + 10 * off(random));
  }
  if (move == 3) { // squat
    limbs.thigh = about({-75, 25, 5}, 6);
    limbs.shin = {100 + 8 * off(random), 0, 0};
  }
  if (move == 4) { // hand on hip, elbow out
    limbs.arm = about({-15, 15, -15}, 6);
    limbs.fore_arm = bent_elbow(85 + 15 * off(random));
  }
  return limbs;
}

} // namespace detail

/// A clip in JSON, of `seconds` and a little more.
inline std::string generated_dance(std::uint64_t seed, double seconds) {
  constexpr int k_moves = 5;
  constexpr double k_fastest = 4.4; // rad/s, a thigh of the shipped dance
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> off(-1.0, 1.0);
  std::uniform_int_distribution<int> any_move(0, k_moves - 1);
  std::map<std::string, Vec3> before;
  std::string keys;
  double time = 0.0;
  while (time < seconds) {
    int left_move = any_move(random), right_move = off(random) < 0.3 ? left_move : any_move(random);
    if (keys.empty()) left_move = right_move = k_moves; // stands
    std::map<std::string, Vec3> pose;
    for (const bool is_left : {true, false}) {
      const detail::Limbs limbs = detail::random_limbs(random, is_left ? left_move : right_move, is_left);
      const std::string side = is_left ? "Left" : "Right";
      const auto put = [&](const char* joint, const Vec3& v) {
        pose[side + joint] = is_left ? v : detail::mirrored(v);
      };
      put("Arm", limbs.arm);
      put("ForeArm", limbs.fore_arm);
      put("UpLeg", limbs.thigh);
      put("Leg", limbs.shin);
    }
    for (const char* joint : {"Spine", "Spine1", "Spine2"})
      pose[joint] = 8.0 * Vec3(off(random), off(random), off(random));
    pose["Hips"] = 12.0 * Vec3(0.3 * off(random), off(random), 0.3 * off(random));
    double farthest = 0.0; // degrees
    for (const auto& [joint, rotation] : pose)
      if (before.contains(joint)) farthest = std::max(farthest, (rotation - before[joint]).norm());
    // Eased between keys, so that the fastest is half as fast again.
    if (!keys.empty()) time += std::max(0.35 + 0.15 * off(random), 1.5 * (farthest * M_PI / 180.0) / k_fastest);
    const double low = left_move == 3 && right_move == 3 ? 0.25 : 0.0;
    keys += fmt::format("{}{{\"time\": {:.6f}, \"joints\": {{", keys.empty() ? "" : ",\n", time);
    bool is_first = true;
    for (const auto& [joint, rotation] : pose) {
      const double angle = rotation.norm() * M_PI / 180.0;
      const Vec3 v = angle > 0.0 ? Vec3(std::sin(0.5 * angle) * rotation.normalized()) : Vec3(Vec3::Zero());
      keys += fmt::format("{}\"{}\": {{{}\"rotation\": [{:.9f}, {:.9f}, {:.9f}, {:.9f}]}}", is_first ? "" : ", ", joint,
                          joint == "Hips" ? fmt::format("\"translation\": [0, {:.4f}, 0], ", 0.94 - low) : "", v.x(),
                          v.y(), v.z(), std::cos(0.5 * angle));
      is_first = false;
    }
    keys += "}}";
    before = pose;
  }
  return "{\"name\": \"generated\", \"keys\": [" + keys + "]}";
}

} // namespace tutu::test
