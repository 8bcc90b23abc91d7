// How often a surface goes round a point, fast: far triangles are taken together.
#pragma once

#include "rig/mesh.h"

#include <span>
#include <vector>

namespace tutu::proxies::fit {

/// The generalised winding number [Jacobson et al. 2013], groups of triangles farther off than twice their size
/// replaced by their area normals [Barill et al. 2018]: within some hundredths, which is enough to tell 0 from 1.
/// Triangles that follow each other in the list should be neighbours, as they are in most files.
class Winding {
public:
  /// The spans must outlive it.
  Winding(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles);
  double at(const Vec3& point) const;

private:
  std::span<const Vec3> positions_;
  std::span<const rig::Triangle> triangles_;
  std::vector<float> x_, y_, z_, nx_, ny_, nz_, reach2_; ///< [group]: centre, sum of area normals, square of its reach
};

} // namespace tutu::proxies::fit
