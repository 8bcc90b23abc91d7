// The twin of BodyMesh: every triangle asked, by other formulas, in long double.
#pragma once

#include "proxies/body/body_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace tutu::test {

class BruteMesh {
public:
  using Real = long double;
  using Vec3r = Eigen::Matrix<Real, 3, 1>;

  BruteMesh(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles) {
    for (const rig::Triangle& t : triangles) {
      const Vec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
      corners_.push_back({a.cast<Real>(), b.cast<Real>(), c.cast<Real>()});
      balls_.push_back({a, 1.001 * std::max((b - a).norm(), (c - a).norm())});
    }
  }

  /// The least over all triangles (but those whose ball about the first corner is farther) of: the plane's distance
  /// where the foot is inside by its three edges, and the distances from the edges.
  double distance(const Vec3& point) const {
    const Vec3r p = point.cast<Real>();
    Real least = std::numeric_limits<Real>::infinity();
    double limit = std::numeric_limits<double>::infinity(); // a little above the least distance
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const double beyond = limit + balls_[i].radius;
      if ((point - balls_[i].centre).squaredNorm() > beyond * beyond) continue;
      least = std::min(least, distance_squared(p, corners_[i]));
      limit = 1.001 * static_cast<double>(std::sqrt(least));
    }
    return static_cast<double>(std::sqrt(least));
  }

  /// Solid angles over 4 pi: the three dihedral angles of each triangle as seen from the point, less pi (Girard).
  double winding_number(const Vec3& point) const {
    const Vec3r p = point.cast<Real>();
    Real sum = 0;
    for (const auto& t : corners_) {
      const Vec3r u = t[0] - p, v = t[1] - p, w = t[2] - p;
      const Vec3r uv = u.cross(v), vw = v.cross(w), wu = w.cross(u);
      const Real excess = angle(-wu, uv) + angle(-uv, vw) + angle(-vw, wu) - static_cast<Real>(M_PIl);
      sum += u.dot(vw) < 0 ? -excess : excess;
    }
    return static_cast<double>(sum / (4 * static_cast<Real>(M_PIl)));
  }

private:
  static Real angle(const Vec3r& a, const Vec3r& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

  static Real distance_squared(const Vec3r& p, const std::array<Vec3r, 3>& t) {
    const Vec3r normal = (t[1] - t[0]).cross(t[2] - t[0]);
    bool over_face = normal.squaredNorm() > 0;
    Real least = std::numeric_limits<Real>::infinity();
    for (int e = 0; e < 3; ++e) {
      const Vec3r &from = t[e], along = t[(e + 1) % 3] - from;
      over_face = over_face && normal.cross(along).dot(p - from) >= 0;
      const Real length_squared = along.squaredNorm();
      const Real s =
          length_squared > 0 ? std::clamp((p - from).dot(along) / length_squared, Real(0), Real(1)) : Real(0);
      least = std::min(least, (p - from - s * along).squaredNorm());
    }
    if (!over_face) return least;
    const Real height = normal.dot(p - t[0]);
    return std::min(least, height * height / normal.squaredNorm());
  }

  struct Ball {
    Vec3 centre;
    double radius;
  };

  std::vector<std::array<Vec3r, 3>> corners_;
  std::vector<Ball> balls_; ///< each holds its triangle
};

} // namespace tutu::test
