// Triangles that were turned over, turned back where there is no doubt which those are.
#pragma once

#include "proxies/body/detail/mesh_topology.h"
#include "rig/math.h"

namespace tutu::proxies {

/// Turns triangles that run against their neighbours (MeshTopology::turned) in `triangles` and `topology`. In a closed
/// shell with two sides all run one way when the few follow the many, and outward when the volume is positive, which
/// decides where no other shell could be around this one. In an open one only a tenth or less follows the others. A
/// one-sided shell stays as it is. Returns how many it turned; takes time only where there are such.
int mend_turned_triangles(std::span<const Vec3> positions, std::vector<rig::Triangle>& triangles,
                          MeshTopology& topology);

} // namespace tutu::proxies
