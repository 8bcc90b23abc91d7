// A body whose shape is known: a capsule as a closed mesh of triangles, its vertices on the capsule.
#pragma once

#include "proxies/distance/signed_distance.h"
#include "rig/mesh.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace tutu::test {

struct CapsuleBody {
  std::vector<Vec3f> positions;
  std::vector<rig::Triangle> triangles;

  /// Appends a capsule along +Y; `around` >= 3 vertices a ring, `bands` rings a cap, `along` pieces of the side.
  void add(const proxies::Capsule& capsule, int around, int bands, int along) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    const double length = capsule.b.y() - capsule.a.y();
    const auto put = [&](double height, double radius) {
      for (int k = 0; k < around; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / around;
        const Vec3 p = capsule.a + Vec3(radius * std::sin(angle), height, radius * std::cos(angle));
        positions.push_back(p.cast<float>());
      }
    };
    const double sine = proxies::cone_sine(capsule), rim = std::asin(sine), ra = capsule.radius_at(0),
                 rb = capsule.radius_at(1);
    const auto latitude = [&](double from, int band) { return from + (0.5 * std::numbers::pi - from) * band / bands; };
    positions.push_back((capsule.a - ra * Vec3::UnitY()).cast<float>());
    for (int band = bands - 1; band >= 0; --band)
      put(-ra * std::sin(latitude(rim, band)), ra * std::cos(latitude(rim, band)));
    for (int k = 1; k < along; ++k) {
      const double share = static_cast<double>(k) / along; // from rim to rim
      put(length * share - capsule.radius_at(share) * sine, capsule.radius_at(share) * std::cos(rim));
    }
    for (int band = 0; band < bands; ++band)
      put(length + rb * std::sin(latitude(-rim, band)), rb * std::cos(latitude(-rim, band)));
    positions.push_back((capsule.b + rb * Vec3::UnitY()).cast<float>());

    const int rings = 2 * bands + along - 1;
    const auto at = [&](int ring, int k) { return first + 1 + static_cast<std::uint32_t>(ring * around + k % around); };
    for (int k = 0; k < around; ++k) {
      triangles.push_back({first, at(0, k + 1), at(0, k)});
      for (int ring = 0; ring + 1 < rings; ++ring) {
        triangles.push_back({at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)});
        triangles.push_back({at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)});
      }
      triangles.push_back({at(rings - 1, k), at(rings - 1, k + 1), static_cast<std::uint32_t>(positions.size()) - 1});
    }
  }
};

} // namespace tutu::test
