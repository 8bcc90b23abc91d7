// Colliders and particles for tests and benchmarks: one builder for both.
#pragma once

#include "proxies/motion/collider_set.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace tutu::test {

inline Vec3 random_point(std::mt19937_64& random, double extent) {
  std::uniform_real_distribution<double> uniform(-extent, extent);
  return {uniform(random), uniform(random), uniform(random)};
}

/// For the i-th capsule of a test: 0 for one of three, else what makes the other radius 0.3 to 2 times the first.
inline double random_taper(std::mt19937_64& random, double radius, int i) {
  const double share = std::uniform_real_distribution<double>(0.3, 2.0)(random);
  return i % 3 == 1 ? 0.0 : radius * (share - 1.0);
}

/// Capsules at both ends of a frame, and the points that ask.
struct ColliderScene {
  std::vector<proxies::Capsule> start, end;
  std::optional<proxies::Plane> ground;
  std::vector<Vec3> points;

  proxies::SweptColliders swept() const { return {start, end, ground}; }
  std::vector<proxies::Capsule> at(double s) const {
    std::vector<proxies::Capsule> now;
    for (std::size_t i = 0; i < start.size(); ++i) now.push_back(proxies::capsule_at(start[i], end[i], s));
    return now;
  }
};

/// Capsules of any direction in a cube of 80 cm; every fifth a sphere, of the others most with two radii, some of which
/// are so short that one end holds the other. Their ends go up to `motion` (m) along each
/// axis.
inline ColliderScene random_scene(std::mt19937_64& random, int colliders, int points, double motion) {
  std::uniform_real_distribution<double> radius(0.02, 0.12);
  ColliderScene scene;
  for (int i = 0; i < colliders; ++i) {
    const Vec3 a = random_point(random, 0.4), move = random_point(random, motion);
    const Vec3 length = i % 5 == 0 ? Vec3(Vec3::Zero()) : random_point(random, 0.3);
    const Vec3 turn = i % 5 == 0 ? Vec3(Vec3::Zero()) : random_point(random, motion);
    const double at_a = radius(random), taper = i % 5 == 0 ? 0.0 : random_taper(random, at_a, i);
    scene.start.push_back({a, a + length, at_a, taper});
    scene.end.push_back({a + move, a + length + move + turn, at_a, taper});
  }
  for (int i = 0; i < points; ++i) scene.points.push_back(random_point(random, 0.5));
  return scene;
}

/// A standing body of `k_body_colliders` capsules, 1.7 m tall, in mid-step, and a skirt of `points` particles about its
/// hips.
inline constexpr int k_body_colliders = 27;
inline ColliderScene dancer_scene(int points) {
  ColliderScene scene;
  const auto limb = [&](const Vec3& a, const Vec3& b, double radius, const Vec3& move) {
    scene.start.push_back({a, b, radius});
    scene.end.push_back({a + 0.5 * move, b + move, radius});
  };
  for (int i = 0; i < 7; ++i) // pelvis to head
    limb({-0.08 + 0.002 * i, 0.95 + 0.1 * i, 0}, {0.08 - 0.002 * i, 0.95 + 0.1 * i, 0}, 0.12 - 0.008 * i,
         {0.005, 0, 0.01});
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < 6; ++i) // hip to toe
      limb({side * 0.1, 0.9 - 0.14 * i, 0.01 * i}, {side * 0.11, 0.76 - 0.14 * i, 0.01 * i + 0.01}, 0.085 - 0.008 * i,
           {0, 0.004 * i, side * 0.006 * i});
    for (int i = 0; i < 4; ++i) // shoulder to hand
      limb({side * (0.2 + 0.14 * i), 1.42, 0}, {side * (0.34 + 0.14 * i), 1.42, 0}, 0.05 - 0.005 * i, {0, 0.01 * i, 0});
  }
  scene.ground = proxies::Plane{};
  const int around = static_cast<int>(std::lround(std::sqrt(2.0 * points)));
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i % around) / around;
    const double down = static_cast<double>(i / around) * around / points; // 0 at the waist, 1 at the hem
    const double radius = 0.14 + 0.2 * down + 0.02 * std::sin(8.0 * angle) * down;
    scene.points.push_back({radius * std::sin(angle), 1.02 - 0.5 * down, radius * std::cos(angle)});
  }
  return scene;
}

} // namespace tutu::test
