// FCL's tree of boxes over the triangles of a mesh that moves, and what is asked of it. FCL is not seen here.
#pragma once

#include "proxies/body/body_mesh.h"

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tutu::proxies {

/// A triangle that asks what is around it (world, m), as its box and the plane it lies in. Bounds from below alone.
class TriangleProbe {
public:
  explicit TriangleProbe(const std::array<Vec3, 3>& corners);

  /// m; no point of a box is nearer to the triangle.
  double least_distance(const Vec3& low, const Vec3& high) const {
    const double apart = (low - high_).cwiseMax(low_ - high).cwiseMax(0.0).squaredNorm();
    const double middle = 0.5 * normal_.dot(low + high) - level_, half = 0.5 * normal_.cwiseAbs().dot(high - low);
    const double above = std::abs(middle) - half;
    return above > 0.0 && above * above > apart ? above : std::sqrt(apart);
  }
  /// m; no point of triangle a b c is nearer to the triangle's plane, and so to the triangle. 0 where it has no plane.
  double least_height(const Vec3& a, const Vec3& b, const Vec3& c) const;

private:
  Vec3 low_, high_;
  Vec3 normal_ = Vec3::Zero(); ///< unit; zero where the triangle has no area
  double level_ = 0.0;         ///< the plane: normal . x = level
};

class MeshTree {
public:
  MeshTree(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles);
  ~MeshTree();

  /// The vertices are there now. Boxes grow and shrink; the tree keeps its shape. Without its dipoles the tree cannot
  /// answer winding_number.
  void refit(const std::vector<Vec3>& positions, bool with_dipoles);

  // Questions may be asked from several threads at once, not during refit.

  /// The nearest point of the triangles, where one is nearer than `within`. Triangles with skip[triangle] are not
  /// there; an empty span leaves out none.
  std::optional<MeshPoint> nearest(const Vec3& point, double within, std::span<const std::uint8_t> skip) const;

  /// The winding number, far parts of the surface taken for dipoles [Barill et al. 2018]: those seen from more than
  /// `beta` times their radius away.
  double winding_number(const Vec3& point, double beta) const;

  bool box_holds(const Vec3& point) const; ///< the box of the whole mesh

  /// m; no triangle of the mesh is nearer to the probe, by boxes and planes. 0 where one may be within
  /// `enough`. Triangles with skip[triangle] are not there; an empty span leaves out none.
  double clearance(const TriangleProbe& probe, double enough, std::span<const std::uint8_t> skip) const;

  /// Calls `visit` with the triangles whose boxes are within `within` (m) of the probe, in any order.
  void around(const TriangleProbe& probe, double within, const std::function<void(int)>& visit) const;

  /// Appends the triangles that a capsule touches, rising.
  void touching(const Capsule& capsule, std::vector<int>& triangles) const;

private:
  struct Boxes;
  struct Dipole {
    Vec3 centre = Vec3::Zero();  ///< mean of the triangles' middles, by area
    Vec3 area = Vec3::Zero();    ///< sum of area normals, m2
    double radius_squared = 0.0; ///< m2; no corner is farther from the centre
    double weight = 0.0;         ///< sum of areas, m2
    int first_child = 0;         ///< as in the tree: the next one is its sibling; below 0: -1 - triangle
  };

  void find_dipoles();

  std::span<const Vec3> positions_;
  std::span<const rig::Triangle> triangles_;
  std::unique_ptr<Boxes> boxes_;
  std::vector<Dipole> dipoles_; ///< of each node of the tree
};

} // namespace tutu::proxies
