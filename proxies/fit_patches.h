// The surface of a capsule in cells, each with a middle and a radius: for bounds on what lies between samples.
#pragma once

#include "proxies/shapes.h"

#include <vector>

namespace tutu::proxies::fit {

/// A piece of a capsule's surface: height along the unrolled side and caps, and angle about the axis.
/// Heights run over [-1, 0] on the cap of a, [0, 1] on the side, [1, 2] on the cap of b.
struct Patch {
  double low = 0.0, high = 0.0;    ///< height; never across 0 or 1
  double from = 0.0, to = 0.0;     ///< angle, rad
  Vec3 middle = Vec3::Zero();      ///< on the surface
  double area = 0.0, radius = 0.0; ///< m2; no point of the patch is farther than `radius` from the middle
};

/// All of the surface, in cells about `size` (m) wide.
std::vector<Patch> patches_of(const Capsule& capsule, double size);
/// The four quarters of one.
std::vector<Patch> quarters(const Capsule& capsule, const Patch& patch);

} // namespace tutu::proxies::fit
