// proxies: shapes follow.
//
//   JSON --read_proxies--> Proxy on joints --ColliderSet--> capsules at both ends of a frame (world space)
//   capsules --CollisionQuery--> candidates once a frame, contacts each substep
//   collider_motion: where a capsule is between the ends of a frame, what it covers, how its surface moves
//   body_mesh: the true, skinned body as a solid, for validation and for reference runs
//   validate: how far posed proxies are from the posed body, with a bound
//   signed_distance, feature_contact: a point, an edge, a triangle against a capsule; sweep: when they first touch
//
// Units m. Signed distance is negative inside; a contact normal is unit and points from the collider to the particle:
// particle = closest + distance * normal. Spheres are capsules of no length, so the hot path knows one shape.
// FCL is asked only in broad_phase.cpp, narrow_phase.cpp and mesh_tree.cpp.
#pragma once

#include "proxies/body_mesh.h"       // IWYU pragma: export
#include "proxies/capsule_union.h"   // IWYU pragma: export
#include "proxies/collider.h"        // IWYU pragma: export
#include "proxies/collider_motion.h" // IWYU pragma: export
#include "proxies/collider_set.h"    // IWYU pragma: export
#include "proxies/collision_query.h" // IWYU pragma: export
#include "proxies/contact.h"         // IWYU pragma: export
#include "proxies/error_figures.h"   // IWYU pragma: export
#include "proxies/feature_contact.h" // IWYU pragma: export
#include "proxies/fit.h"             // IWYU pragma: export
#include "proxies/proxy_file.h"      // IWYU pragma: export
#include "proxies/shapes.h"          // IWYU pragma: export
#include "proxies/signed_distance.h" // IWYU pragma: export
#include "proxies/skin_samples.h"    // IWYU pragma: export
#include "proxies/surface_cells.h"   // IWYU pragma: export
#include "proxies/sweep.h"           // IWYU pragma: export
#include "proxies/validate.h"        // IWYU pragma: export
