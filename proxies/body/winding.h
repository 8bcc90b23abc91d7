// How often a surface goes round a point, fast: far triangles are taken together.
#pragma once

#include "rig/mesh.h"

#include <span>
#include <vector>

namespace tutu::proxies {

/// The generalised winding number [Jacobson et al. 2013], groups of triangles farther off than twice their size
/// replaced by their area normals [Barill et al. 2018]: within some hundredths, which is enough to tell 0 from 1.
class Winding {
public:
  /// Triangles that follow each other should be neighbours (neighbours_together). The spans must outlive it.
  Winding(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles);
  double at(const Vec3& point) const;

private:
  /// Runs of triangles: centre, sum of area normals, and the square of the distance from which that is enough.
  struct Groups {
    std::vector<float> x, y, z, nx, ny, nz, near2;
    void add(std::span<const Vec3> positions, std::span<const rig::Triangle> run);
    /// Adds the solid angle of the far ones among first..last, and calls `near` with each of the others.
    template <typename Near> double solid_angle(const Vec3& point, int first, int last, const Near& near) const;
  };

  std::span<const Vec3> positions_;
  std::span<const rig::Triangle> triangles_;
  Groups small_, large_; ///< a large one is k_large small ones
};

/// The same triangles in an order in which neighbours stand together.
std::vector<rig::Triangle> neighbours_together(std::span<const Vec3> positions,
                                               std::span<const rig::Triangle> triangles);

} // namespace tutu::proxies
