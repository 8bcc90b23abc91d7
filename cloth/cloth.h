// cloth: cloth collides.
//
//   JSON --read_garment--> GarmentDescription --build_garment--> Garment (rest shape, immutable)
//   a frame: Solver::step(FrameInput) = broad phase once, then substeps of
//            integrate -> pins -> constraints or forces -> self-collision where asked for -> contacts (ContactSearch)
//            -> the divergence check
//
// Garments are authored in the character's model space at rest; particles move in world space. m, s, kg, N.
// Cloth knows no joint and no FCL: pins arrive as spans of targets, colliders as posed plain shapes behind
// CollisionQuery.
#pragma once

#include "cloth/adaptive_substeps.h" // IWYU pragma: export
#include "cloth/contact_search.h"    // IWYU pragma: export
#include "cloth/dihedral.h"          // IWYU pragma: export
#include "cloth/drape_file.h"        // IWYU pragma: export
#include "cloth/garment.h"           // IWYU pragma: export
#include "cloth/garment_elements.h"  // IWYU pragma: export
#include "cloth/garment_file.h"      // IWYU pragma: export
#include "cloth/mass_spring.h"       // IWYU pragma: export
#include "cloth/mesh_xpbd.h"         // IWYU pragma: export
#include "cloth/metrics.h"           // IWYU pragma: export
#include "cloth/particles.h"         // IWYU pragma: export
#include "cloth/reach.h"             // IWYU pragma: export
#include "cloth/recovery.h"          // IWYU pragma: export
#include "cloth/solver.h"            // IWYU pragma: export
#include "cloth/spatial_hash.h"      // IWYU pragma: export
#include "cloth/tolerances.h"        // IWYU pragma: export
#include "cloth/xpbd.h"              // IWYU pragma: export
