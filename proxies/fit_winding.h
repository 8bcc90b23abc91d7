// How often a surface goes round a point, fast: far triangles are taken together.
#pragma once

#include "rig/mesh.h"

#include <span>
#include <vector>

namespace tutu::proxies::fit {

/// The generalised winding number [Jacobson et al. 2013], groups of triangles farther off than twice their size
/// replaced by their area normals [Barill et al. 2018]: within some hundredths, which is enough to tell 0 from 1.
class Winding {
public:
  /// Triangles that follow each other should be neighbours (neighbours_together). The spans must outlive it.
  Winding(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles);
  double at(const Vec3& point) const;

private:
  std::span<const Vec3> positions_;
  std::span<const rig::Triangle> triangles_;
  std::vector<float> x_, y_, z_, nx_, ny_, nz_, reach2_; ///< [group]: centre, sum of area normals, square of its reach
};

/// The same triangles in an order in which neighbours stand together.
std::vector<rig::Triangle> neighbours_together(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles);

} // namespace tutu::proxies::fit
