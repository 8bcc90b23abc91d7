// A sheet of cloth made into a closed surface with a front, a back and a rim.
#pragma once

#include "rig/mesh.h"

#include <span>
#include <vector>

namespace tutu::app {

/// The triangles of a sheet's closed skin: front, back (vertex + vertex_count, turned round) and two for each edge of
/// `triangles` that only one triangle has.
std::vector<rig::Triangle> closed_skin(std::span<const rig::Triangle> triangles, std::uint32_t vertex_count);

} // namespace tutu::app
