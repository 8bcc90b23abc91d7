// The nearest point of a triangle, in closed form, in double.
#pragma once

#include "proxies/body_mesh.h"

namespace tutu::proxies {

/// The point of triangle a b c that is nearest to `point`, and what of the triangle it lies on [Ericson 2005, Real-Time
/// Collision Detection, 5.1.5]. A triangle without area is its edges. `triangle` of the result is left at 0.
MeshPoint nearest_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

} // namespace tutu::proxies
