// proxies: shapes follow.
//
//   JSON --read_proxies--> Proxy on joints --ColliderSet--> capsules at both ends of a frame (world space)
//   capsules --CollisionQuery--> candidates once a frame, contacts each substep
//
// Units m. Signed distance is negative inside; a contact normal is unit and points from the collider to the particle:
// particle = closest + distance * normal. Spheres are capsules of no length, so the hot path knows one shape.
//
// Folders, each above the ones before it: proxies itself (shapes, proxies on joints, their files), distance (closed
// forms: a point, an edge, a triangle against a shape), motion (where colliders are between the ends of a frame, and
// when they first touch), crossing (what goes through what, exactly), body (the true, skinned body as a solid), query
// (broad and narrow phase), validate (how far posed proxies are from the posed body, with a bound), fit (proxies made
// for a character). FCL is asked only in query/detail/broad_phase.cpp, query/detail/narrow_phase.cpp and
// body/detail/mesh_tree.cpp.
#pragma once

// What a caller needs first.
#include "proxies/motion/collider_set.h"   // IWYU pragma: export
#include "proxies/proxy_file.h"            // IWYU pragma: export
#include "proxies/query/collision_query.h" // IWYU pragma: export
#include "proxies/shapes.h"                // IWYU pragma: export

// The rest.
#include "proxies/body/body_features.h"         // IWYU pragma: export
#include "proxies/body/body_mesh.h"             // IWYU pragma: export
#include "proxies/body/point_triangle.h"        // IWYU pragma: export
#include "proxies/body/winding.h"               // IWYU pragma: export
#include "proxies/collider.h"                   // IWYU pragma: export
#include "proxies/contact.h"                    // IWYU pragma: export
#include "proxies/crossing/capsule_surface.h"   // IWYU pragma: export
#include "proxies/crossing/orientation.h"       // IWYU pragma: export
#include "proxies/crossing/segment_passages.h"  // IWYU pragma: export
#include "proxies/crossing/segment_triangle.h"  // IWYU pragma: export
#include "proxies/crossing/surface_crossings.h" // IWYU pragma: export
#include "proxies/distance/capsule_union.h"     // IWYU pragma: export
#include "proxies/distance/closed_forms.h"      // IWYU pragma: export
#include "proxies/distance/feature_contact.h"   // IWYU pragma: export
#include "proxies/distance/signed_distance.h"   // IWYU pragma: export
#include "proxies/distance/surface_cells.h"     // IWYU pragma: export
#include "proxies/fit/fit.h"                    // IWYU pragma: export
#include "proxies/motion/collider_motion.h"     // IWYU pragma: export
#include "proxies/motion/sweep.h"               // IWYU pragma: export
#include "proxies/validate/error_figures.h"     // IWYU pragma: export
#include "proxies/validate/skin_samples.h"      // IWYU pragma: export
#include "proxies/validate/validate.h"          // IWYU pragma: export
