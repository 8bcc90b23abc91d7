// cloth: cloth collides.
//
//   JSON --read_garment--> GarmentDescription --build_garment--> Garment (rest shape, immutable)
//   a frame: Solver::step(FrameInput) = broad phase once, then substeps of
//            air -> integrate -> pins -> constraints or forces -> self-collision where asked for -> contacts
//            -> the divergence check
//
// Garments are authored in the character's model space at rest; particles move in world space. m, s, kg, N.
// Cloth knows no joint and no FCL: pins arrive as spans of targets, colliders as posed plain shapes behind
// CollisionQuery.
//
// Folders, each above the ones before it: state (particles, a frame's input, options, tolerances), garment (rest shapes
// and their files), air (its force, wind), contact (who meets whom), woven (the vector kernels of grids and tubes),
// cloth itself (the solvers, recovery, adaptive substeps, metrics).
#pragma once

// What a caller needs first.
#include "cloth/garment/garment.h"      // IWYU pragma: export
#include "cloth/garment/garment_file.h" // IWYU pragma: export
#include "cloth/recovery.h"             // IWYU pragma: export
#include "cloth/solver.h"               // IWYU pragma: export

// The rest.
#include "cloth/adaptive_substeps.h"      // IWYU pragma: export
#include "cloth/air/air.h"                // IWYU pragma: export
#include "cloth/air/wind.h"               // IWYU pragma: export
#include "cloth/contact/contact_search.h" // IWYU pragma: export
#include "cloth/contact/self_collision.h" // IWYU pragma: export
#include "cloth/contact/spatial_hash.h"   // IWYU pragma: export
#include "cloth/damping.h"                // IWYU pragma: export
#include "cloth/garment/dihedral.h"       // IWYU pragma: export
#include "cloth/garment/drape_file.h"     // IWYU pragma: export
#include "cloth/garment/elements.h"       // IWYU pragma: export
#include "cloth/garment/garment_memory.h" // IWYU pragma: export
#include "cloth/garment/reach.h"          // IWYU pragma: export
#include "cloth/garment/springs.h"        // IWYU pragma: export
#include "cloth/garment/uneven.h"         // IWYU pragma: export
#include "cloth/mass_spring.h"            // IWYU pragma: export
#include "cloth/mesh_xpbd.h"              // IWYU pragma: export
#include "cloth/metrics.h"                // IWYU pragma: export
#include "cloth/state/divergence.h"       // IWYU pragma: export
#include "cloth/state/frame.h"            // IWYU pragma: export
#include "cloth/state/particles.h"        // IWYU pragma: export
#include "cloth/state/solver_options.h"   // IWYU pragma: export
#include "cloth/state/tolerances.h"       // IWYU pragma: export
#include "cloth/xpbd.h"                   // IWYU pragma: export
