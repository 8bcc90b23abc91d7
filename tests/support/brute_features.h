// The twin of BodyFeatures: every vertex and edge of every triangle asked, found again by where they are, by other
// formulas, in long double; the side from a shape that is known.
#pragma once

#include "proxies/body/body_features.h"
#include "tests/support/brute_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <vector>

namespace tutu::test {

/// What the twin says of a pair. `margin`: the least by which it passes (> 0) or the most by which it fails (< 0) what
/// makes it a contact; lengths as shares of millimetres, angles as sines.
struct BrutePair {
  proxies::BodyPair pair;
  Vec3 cloth, body, normal;
  double distance, margin;
};

class BruteFeatures {
public:
  using Real = BruteMesh::Real;
  using Vec3r = BruteMesh::Vec3r;
  /// Out of the shape at a point of its surface; of any length.
  using Outward = std::function<Vec3(const Vec3&)>;

  BruteFeatures(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles, Outward outward)
      : solid_(positions, triangles), outward_(std::move(outward)) {
    for (const rig::Triangle& t : triangles)
      triangles_.push_back({positions[t[0]].cast<Real>(), positions[t[1]].cast<Real>(), positions[t[2]].cast<Real>()});
    for (const auto& t : triangles_)
      for (int k = 0; k < 3; ++k) {
        const Vec3r &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
        around_[key(a)].push_back(b);
        around_[key(a)].push_back(c);
        opposite_[key(a) < key(b) ? std::pair(key(a), key(b)) : std::pair(key(b), key(a))].push_back(c);
      }
  }

  /// All pairs whose margin is above `least`, which must be below 0.
  std::vector<BrutePair> pairs(const std::array<Vec3, 3>& cloth, const proxies::BodyReach& reach, double least) const {
    std::vector<BrutePair> found;
    const std::array<Vec3r, 3> q = {cloth[0].cast<Real>(), cloth[1].cast<Real>(), cloth[2].cast<Real>()};
    for (const auto& [at, others] : around_) add(face_vertex(q, point(at), others, reach, least), least, found);
    for (const auto& [ends, others] : opposite_)
      for (int k = 0; k < 3; ++k)
        add(edge_edge(q[k], q[(k + 1) % 3], point(ends.first), point(ends.second), others, reach, least), least, found);
    return found;
  }

private:
  using Key = std::array<Real, 3>;
  static Key key(const Vec3r& p) { return {p.x(), p.y(), p.z()}; }
  static Vec3r point(const Key& k) { return {k[0], k[1], k[2]}; }
  static constexpr Real k_slack = 0.05L, k_same_side = 0.25L;

  static void add(const BrutePair& pair, double least, std::vector<BrutePair>& found) {
    if (pair.margin > least) found.push_back(pair);
  }

  /// Least squares for the foot: |q0 + v e + w f - p| least, from its normal equations.
  BrutePair face_vertex(const std::array<Vec3r, 3>& q, const Vec3r& p, const std::vector<Vec3r>& others,
                        const proxies::BodyReach& reach, double least) const {
    const Vec3r e = q[1] - q[0], f = q[2] - q[0], r = p - q[0];
    const Real ee = e.dot(e), ef = e.dot(f), ff = f.dot(f), re = r.dot(e), rf = r.dot(f);
    const Real det = ee * ff - ef * ef, v = (re * ff - rf * ef) / det, w = (rf * ee - re * ef) / det;
    Real margin = std::min({v, w, 1 - v - w});
    Vec3r normal = e.cross(f).normalized();
    const Vec3 out = outward_(p.cast<double>()).normalized();
    if (normal.cast<double>().dot(out) < 0) normal = -normal;
    for (const Vec3r& other : others) margin = std::min(margin, k_slack - normal.dot(other - p) / (other - p).norm());
    return judged(proxies::BodyPair::face_vertex, q[0] + v * e + w * f, p, normal, margin, reach, least);
  }

  /// Two lines from the normal equations of |p + s u - a - t v|.
  BrutePair edge_edge(const Vec3r& p, const Vec3r& q, const Vec3r& a, const Vec3r& b, const std::vector<Vec3r>& others,
                      const proxies::BodyReach& reach, double least) const {
    const Vec3r u = q - p, v = b - a, w = p - a;
    const Real uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w), det = uu * vv - uv * uv;
    const Real s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
    Real margin = std::min({s, 1 - s, t, 1 - t, std::sqrt(det / (uu * vv)) - 1e-3L});
    if (!(margin > least)) return {{}, {}, {}, {}, 0.0, static_cast<double>(margin)};
    Vec3r normal = u.cross(v).normalized();
    const Vec3 out = outward_((a + 0.5L * v).cast<double>()).normalized();
    if (normal.cast<double>().dot(out) < 0) normal = -normal;
    const Vec3r along = v.normalized();
    std::vector<Vec3r> into;
    for (const Vec3r& other : others) into.push_back((other - a - along.dot(other - a) * along).normalized());
    for (const Vec3r& direction : into) margin = std::min(margin, k_slack - normal.dot(direction));
    // Convex or flat: one side's direction is below the other's plane, as seen from outside.
    if (into.size() == 2) {
      const Vec3r face = along.cross(into[0]).normalized();
      margin = std::min(margin, 1e-3L - (face.dot(out.cast<Real>()) < 0 ? -face : face).dot(into[1]));
    }
    return judged(proxies::BodyPair::edge_edge, p + s * u, a + t * v, normal, margin, reach, least);
  }

  BrutePair judged(proxies::BodyPair pair, const Vec3r& cloth, const Vec3r& body, const Vec3r& normal, Real margin,
                   const proxies::BodyReach& reach, double least) const {
    const Real distance = normal.dot(cloth - body);
    margin = std::min({margin, (reach.outside - distance) * 1000, (distance + reach.depth) * 1000});
    if (margin > least && distance < 0) {
      const Vec3 at = cloth.cast<double>();
      const Vec3r way = way_out(cloth);
      if (way.norm() < -distance * (1 - 1e-5L)) {
        margin = std::min(margin, normal.dot(way) / way.norm() - k_same_side);
        margin = std::min(margin, static_cast<Real>(solid_.winding_number(at) > 0.5 ? 1 : -1));
      }
    }
    return {pair,
            cloth.cast<double>(),
            body.cast<double>(),
            normal.cast<double>(),
            static_cast<double>(distance),
            static_cast<double>(margin)};
  }

  /// To the nearest point of all triangles: each asked by its plane, where the foot is inside, and by its edges.
  Vec3r way_out(const Vec3r& p) const {
    Vec3r best = Vec3r::Constant(std::numeric_limits<Real>::max());
    Real least = std::numeric_limits<Real>::infinity();
    const auto offer = [&](const Vec3r& way) {
      if (way.squaredNorm() < least) least = way.squaredNorm(), best = way;
    };
    for (const auto& t : triangles_) {
      const Vec3r normal = (t[1] - t[0]).cross(t[2] - t[0]);
      bool over = normal.squaredNorm() > 0;
      for (int k = 0; k < 3; ++k) {
        const Vec3r along = t[(k + 1) % 3] - t[k];
        over = over && normal.cross(along).dot(p - t[k]) >= 0;
        const Real square = along.squaredNorm();
        const Real s = square > 0 ? std::clamp((p - t[k]).dot(along) / square, Real(0), Real(1)) : Real(0);
        offer(t[k] + s * along - p);
      }
      if (over) offer(normal * (normal.dot(t[0] - p) / normal.squaredNorm()));
    }
    return best;
  }

  BruteMesh solid_;
  Outward outward_;
  std::vector<std::array<Vec3r, 3>> triangles_;
  std::map<Key, std::vector<Vec3r>> around_;                   ///< vertex: those it shares triangles with
  std::map<std::pair<Key, Key>, std::vector<Vec3r>> opposite_; ///< edge: the third corners of its triangles
};

} // namespace tutu::test
