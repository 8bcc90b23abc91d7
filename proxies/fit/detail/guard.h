// What keeps shapes from leaving the body where no point of the skin would see it.
#pragma once

#include "proxies/fit/detail/model.h"

namespace tutu::proxies::fit {

/// Distance from the body on a grid, in one pose: > 0 outside, about. From points of the skin, so only what is farther
/// out than their spacing is told well; that is all a guard needs.
class DistanceGrid {
public:
  /// Positions and outward normals of points spread evenly over the whole skin, `spacing` apart.
  DistanceGrid(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals, float cell, float spacing);
  /// And its gradient; beyond the grid, that of the nearest place in it plus the way there.
  double at(const Vec3& point, Vec3& gradient) const;

private:
  Vec3f origin_;
  float cell_;
  std::array<int, 3> size_;
  std::vector<float> value_;
};

/// Adds to a fit's cost, for surface points q of each capsule in some poses, the weight of their patch times
/// (distance of q from the body - dead)+^2.
class Guard {
public:
  /// `poses`: of the motion, in which to look.
  Guard(const rig::Character& character, const std::vector<std::vector<Transform>>& all, std::vector<int> poses,
        const BodyMotion& motion);

  struct Strength {
    double weight = 0.1; ///< of the whole mesh's area, against the skin's 1
    double dead = 0.020; ///< m, that is free
  };
  /// Cost of one unit; where `hessian` is given, adds the Gauss-Newton terms of its parameters.
  double cost(const Unit& unit, const BodyMotion& motion, const Strength& strength, Hessian* hessian,
              Row* gradient) const;

private:
  std::vector<int> poses_;
  std::vector<DistanceGrid> grids_;
};

} // namespace tutu::proxies::fit
