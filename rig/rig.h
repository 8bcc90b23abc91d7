// rig: joints move.
//
//   file --import_character--> Skeleton + Mesh + Skin (+ ChannelClips)
//   BVH file --read_bvh--> its own Skeleton + Clip --retarget--> Clip
//   RawClip --build_clip--> Clip
//   Motion (a Clip: key poses, or a ChannelClip: a file's own curves) --pose_at--> model_from_joint
//   local pose --drag_joint, solve_limb, solve_chain--> local pose
//   model_from_joint --skinning_palette--> palette --skin_vertices--> the posed mesh (only when something asks for it)
//
// Spaces. `local`: to the parent joint. `model`: to the character's root; right-handed, +Y up, the character faces +Z.
// Units: m, s, rad. Import converts; everything behind it is SI.
// Descriptions (Skeleton, Mesh, Skin, Clip) are immutable flat arrays; poses are spans that the caller owns.
//
// Folders, each above the ones before it: rig itself (joints, meshes, clips in memory), io (files), import (characters
// of other programs), mannequin (a built-in body).
#pragma once

// What a caller needs first.
#include "rig/character.h"     // IWYU pragma: export
#include "rig/clip.h"          // IWYU pragma: export
#include "rig/error.h"         // IWYU pragma: export
#include "rig/import/import.h" // IWYU pragma: export
#include "rig/io/clip_file.h"  // IWYU pragma: export

// The rest.
#include "rig/body_regions.h"        // IWYU pragma: export
#include "rig/channel_clip.h"        // IWYU pragma: export
#include "rig/curve.h"               // IWYU pragma: export
#include "rig/drag.h"                // IWYU pragma: export
#include "rig/flight.h"              // IWYU pragma: export
#include "rig/ik.h"                  // IWYU pragma: export
#include "rig/import/surface.h"      // IWYU pragma: export
#include "rig/interpolation.h"       // IWYU pragma: export
#include "rig/io/bvh.h"              // IWYU pragma: export
#include "rig/io/file_io.h"          // IWYU pragma: export
#include "rig/io/json_file.h"        // IWYU pragma: export
#include "rig/io/memory_limit.h"     // IWYU pragma: export
#include "rig/length_unit.h"         // IWYU pragma: export
#include "rig/mannequin/mannequin.h" // IWYU pragma: export
#include "rig/math.h"                // IWYU pragma: export
#include "rig/mesh.h"                // IWYU pragma: export
#include "rig/motion.h"              // IWYU pragma: export
#include "rig/skeleton.h"            // IWYU pragma: export
#include "rig/skin.h"                // IWYU pragma: export
#include "rig/strong_poses.h"        // IWYU pragma: export
#include "rig/text.h"                // IWYU pragma: export
