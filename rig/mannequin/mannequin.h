// A body of our own: a female dancer of 1.70 m, modelled as a smooth blend of volumes and meshed.
#pragma once

#include "rig/character.h"

#include <filesystem>
#include <string>

namespace tutu::rig {

/// The parts of the mannequin as they go into a file: two skins on two instances of one skeleton.
struct Mannequin {
  Skeleton skeleton;     ///< 52 joints with Mixamo names; rest rotations are all identity (axes of model space)
  Mesh surface, spheres; ///< a watertight body, and a small sphere at each joint
  Skin surface_skin, sphere_skin;
};

/// Always the same mannequin, to the bit.
Mannequin make_mannequin();

/// The mannequin as a Collada 1.4.1 document: two controllers, two skeleton instances. Same bytes every time.
std::string collada_of(const Mannequin& mannequin);

} // namespace tutu::rig
