// Signed distance of a point from all colliders together: the cheap closed form, without normals.
#pragma once

#include "proxies/distance/closed_forms.h"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace tutu::proxies {

/// The solid that posed capsules and spheres fill together. World space, m; negative inside.
///
/// Outside, distance() is the exact distance from the union. Inside it is the depth below the capsule the point is
/// deepest in: a lower bound of the depth below the union's own surface. It is 1-Lipschitz everywhere, as a least of
/// distances is.
class CapsuleUnion {
public:
  static constexpr int k_none = -1;

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity(); ///< m; infinite without capsules
    int capsule = k_none;                                      ///< the one it belongs to; the first of equals
  };

  void assign(std::span<const Capsule> capsules) {
    parts_.clear();
    for (const Capsule& capsule : capsules) parts_.push_back(round_cone(capsule));
  }

  std::size_t size() const { return parts_.size(); }

  double distance(const Vec3& point, std::size_t capsule) const {
    const PlainCone& cone = parts_[capsule];
    const Vec3 from_a = point - cone.a;
    if (cone.taper == 0.0) return PlainForms::distance<false>(cone, from_a);
    return PlainForms::distance<true>(cone, from_a);
  }

  Nearest nearest(const Vec3& point) const {
    Nearest result;
    for (std::size_t c = 0; c < parts_.size(); ++c)
      if (const double d = distance(point, c); d < result.distance) result = {d, static_cast<int>(c)};
    return result;
  }

  double distance(const Vec3& point) const { return nearest(point).distance; }

  /// Distance from the union of all but one: where that one's surface is covered, and where it shows.
  double distance_without(const Vec3& point, std::size_t left_out) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < parts_.size(); ++c)
      if (c != left_out) least = std::min(least, distance(point, c));
    return least;
  }

private:
  std::vector<PlainCone> parts_;
};

} // namespace tutu::proxies
