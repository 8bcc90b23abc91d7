// Arms and legs of a skeleton, found by the names of its joints: what inverse kinematics bends.
#pragma once

#include "rig/ik.h"

#include <optional>
#include <vector>

namespace tutu::app {

struct BodyLimb {
  rig::Limb limb;
  bool leg = false;
};

/// Two bones above each hand and foot. Where more joints than two make the limb (of twist), the middle one is that
/// whose place at rest is nearest to the middle of the way.
std::vector<BodyLimb> find_limbs(const rig::Skeleton& skeleton);

/// The limb that ends at this joint, or bends at it.
std::optional<BodyLimb> limb_ending_at(std::span<const BodyLimb> limbs, int joint);
std::optional<BodyLimb> limb_bending_at(std::span<const BodyLimb> limbs, int joint);

/// A point (model space, m) to which knee or elbow points now; of a straight limb knees go forwards and elbows back,
/// as the body turns.
Vec3 pole_of(const rig::Skeleton& skeleton, std::span<const Transform> local, const BodyLimb& limb);

/// The joints that bend so that `joint` comes to a place: those above it, five at most, without the root.
std::vector<int> chain_ending_at(const rig::Skeleton& skeleton, int joint);

} // namespace tutu::app
