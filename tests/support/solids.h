// Closed and open surfaces for tests and benchmarks.
#pragma once

#include "rig/mesh.h"

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace tutu::test {

struct Surface {
  std::vector<Vec3f> positions;
  std::vector<rig::Triangle> triangles;

  std::vector<Vec3> points() const {
    std::vector<Vec3> all;
    for (const Vec3f& p : positions) all.push_back(p.cast<double>());
    return all;
  }
};

/// Every triangle in four: edges are halved, as `place` says where the middle goes.
template <class Place> Surface subdivided(const Surface& coarse, const Place& place) {
  Surface fine{coarse.positions, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), fine.positions.size());
    if (is_new) fine.positions.push_back(place(0.5f * (coarse.positions[a] + coarse.positions[b])));
    return found->second;
  };
  for (const rig::Triangle& t : coarse.triangles) {
    const std::uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    for (const rig::Triangle& part : {rig::Triangle{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}})
      fine.triangles.push_back(part);
  }
  return fine;
}

inline Surface subdivided(const Surface& coarse) {
  return subdivided(coarse, [](const Vec3f& p) { return p; });
}

/// An axis-aligned box about the origin.
inline Surface box_surface(const Vec3f& half) {
  Surface box;
  for (int i = 0; i < 8; ++i)
    box.positions.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                               i & 4 ? half.z() : -half.z());
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

/// A sphere: a box, halved `rounds` times and blown up. 12 * 4^rounds triangles.
inline Surface sphere_surface(double radius, int rounds, const Vec3f& centre = Vec3f::Zero()) {
  const auto blow_up = [&](const Vec3f& p) { return Vec3f(static_cast<float>(radius) * p.normalized()); };
  Surface sphere = box_surface(Vec3f::Ones());
  for (Vec3f& p : sphere.positions) p = blow_up(p);
  for (int i = 0; i < rounds; ++i) sphere = subdivided(sphere, blow_up);
  for (Vec3f& p : sphere.positions) p += centre;
  return sphere;
}

/// A ring of circles about +Y.
inline Surface torus_surface(double ring, double tube, int around, int across) {
  Surface torus;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2.0 * std::numbers::pi * i / around, v = 2.0 * std::numbers::pi * j / across;
      const double r = ring + tube * std::cos(v);
      torus.positions.push_back(Vec3(r * std::cos(u), tube * std::sin(v), r * std::sin(u)).cast<float>());
      const auto at = [&](int a, int b) { return static_cast<std::uint32_t>((a % around) * across + b % across); };
      torus.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      torus.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return torus;
}

/// A sphere with each vertex at a radius of its own: ridges, valleys and spikes, closed and never through itself.
inline Surface spiky_surface(std::mt19937_64& random) {
  std::uniform_real_distribution<float> stretch(0.4f, 1.0f);
  Surface spiky = sphere_surface(1.0, 2);
  for (Vec3f& p : spiky.positions) p *= stretch(random);
  return spiky;
}

inline void append(Surface& surface, const Surface& more) {
  const auto first = static_cast<std::uint32_t>(surface.positions.size());
  surface.positions.insert(surface.positions.end(), more.positions.begin(), more.positions.end());
  for (const rig::Triangle& t : more.triangles) surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

inline Surface inside_out(Surface surface) {
  for (rig::Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  return surface;
}

} // namespace tutu::test
