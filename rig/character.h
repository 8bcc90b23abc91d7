// A character: skeleton, mesh and skin as one.
#pragma once

#include "rig/clip.h"
#include "rig/mesh.h"
#include "rig/skeleton.h"
#include "rig/skin.h"

#include <string>

namespace tutu::rig {

struct Character {
  std::string file; ///< where it came from
  Skeleton skeleton;
  Mesh mesh;
  Skin skin;
};

} // namespace tutu::rig
