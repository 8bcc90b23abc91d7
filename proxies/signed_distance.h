// Closed-form signed distance of a point from each shape, in double.
#pragma once

#include "proxies/contact.h"
#include "proxies/shapes.h"

namespace tutu::proxies {

/// Distance to the segment minus the radius [Ericson 2005, Real-Time Collision Detection, 5.1.2].
/// A point exactly on the axis has no unique normal: it gets the unit vector perpendicular to the axis that is nearest to +Y
/// (+Y itself for a sphere, +X for a vertical axis), so a lone particle is pushed up, out of the limb.
Contact signed_distance(const Vec3& point, const Capsule& capsule);

Contact signed_distance(const Vec3& point, const Plane& plane);

} // namespace tutu::proxies
