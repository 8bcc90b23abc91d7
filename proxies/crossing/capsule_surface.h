// The surface of a sphere, capsule or cone as triangles, as fine as asked.
#pragma once

#include "proxies/shapes.h"
#include "rig/mesh.h"

#include <vector>

namespace tutu::proxies {

/// A closed surface, normals out, same space as the capsule.
struct CapsuleTriangles {
  std::vector<Vec3> positions;
  std::vector<rig::Triangle> triangles;
};

/// The surface of the solid that Capsule describes: rings of `around` corners (>= 3), one every 2 pi / around of the
/// end balls. All corners lie on the solid, so the surface is within it, by at most widest() * (1 - cos^2(pi / around))
/// (0.2 mm of 10 mm radius at 24): what is less deep than that is not seen by it.
CapsuleTriangles capsule_surface(const Capsule& capsule, int around);

} // namespace tutu::proxies
