// How the mannequin is made, step by step. Inside of rig/mannequin*.cpp only.
//
//   volumes (signed distance of the left half) --march--> fine triangles --remesh--> even triangles --mirror--> surface
//   volumes + joints --> weights
//
// Plain arithmetic and square roots only, one thread: the same bits with every compiler and at every optimisation.
#pragma once

#include "rig/mesh.h"
#include "rig/skeleton.h"
#include "rig/skin.h"

namespace tutu::rig {

/// 52 joints in the rest pose: rest rotations are identity; the character's left is +X.
Skeleton mannequin_skeleton();

} // namespace tutu::rig
