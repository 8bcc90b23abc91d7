// Garments that are not woven in rows and columns. Private to the folder.
#pragma once

#include "cloth/garment/garment.h"

namespace tutu::cloth {

/// How many particles triangulated() gives, of a disc that it does not refuse.
std::uint64_t disc_particles(const DiscShape& disc);

/// The disc's triangles. Ring k has about 6 particles for each radius step it is away from the centre, so that
/// triangles are nearly equilateral. Throws InputError naming `description` when the shape has no area or too many
/// particles.
MeshShape triangulated(const DiscShape& disc, const GarmentDescription& description);

/// Fills positions, masses, springs and triangles. A spring of an edge has the stiffness K = k (A1 + A2) / L^2 for
/// sheet stiffness k and the areas of the triangles beside it: equilateral triangles of such springs are a sheet that
/// takes k per metre of width and unit strain when pulled any way, with a Poisson ratio of 1/3 and a shear stiffness of
/// 3/8 k. (Fabric::shear does not count.) Throws InputError on indices out of range and when no triangle has an area.
void build_from_triangles(const MeshShape& mesh, const GarmentDescription& description, Garment& garment);

} // namespace tutu::cloth
