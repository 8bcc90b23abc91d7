// Signed distance of a point from all colliders together: the cheap closed form, without normals.
#pragma once

#include "proxies/shapes.h"

#include <algorithm>
#include <cmath>
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
    for (const Capsule& capsule : capsules) {
      const Vec3 axis = capsule.b - capsule.a;
      const double squared = axis.squaredNorm(), taper = capsule.taper;
      if (taper == 0.0) parts_.push_back({capsule.a, axis, squared > 0.0 ? 1.0 / squared : 0.0, capsule.radius, 0, 0});
      else if (taper * taper < squared) {
        const double lean = taper / std::sqrt(squared * (squared - taper * taper));
        parts_.push_back({capsule.a, axis, 1.0 / squared, capsule.radius, taper, lean});
      } else { // one ball holds the other
        parts_.push_back({taper > 0.0 ? capsule.b : capsule.a, Vec3::Zero(), 0.0, capsule.widest(), 0, 0});
      }
    }
  }

  std::size_t size() const { return parts_.size(); }

  double distance(const Vec3& point, std::size_t capsule) const {
    const Part& part = parts_[capsule];
    const Vec3 from_a = point - part.a;
    const double foot = from_a.dot(part.axis) * part.inverse_squared;
    if (part.taper == 0.0) return (from_a - std::clamp(foot, 0.0, 1.0) * part.axis).norm() - part.radius;
    const double across = (from_a - foot * part.axis).norm(); // as in nearest_on_axis
    const double t = std::clamp(foot + across * part.lean, 0.0, 1.0);
    return (from_a - t * part.axis).norm() - part.radius - t * part.taper;
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
  struct Part {
    Vec3 a, axis;           ///< b - a
    double inverse_squared; ///< 1 / |axis|^2; 0 for a sphere
    double radius, taper;
    double lean; ///< what a unit of distance from the axis adds to the nearest ball's share of it, 1/m
  };
  std::vector<Part> parts_;
};

} // namespace tutu::proxies
