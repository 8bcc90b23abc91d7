// One frame of a run, kept: all there is to draw and to explain, without the session that made it.
#pragma once

#include "src/run/session.h"

namespace tutu::app {

/// A broad phase of one garment, as cloth::BroadPhaseView has it.
struct BroadPhaseState {
  std::vector<proxies::Box> boxes;
  std::vector<int> begin, colliders;
};

/// World space, m. Vectors are reused from capture to capture.
struct FrameState {
  int index = 0;     ///< of the motion: time * frames per second
  double time = 0.0; ///< s since the motion's start
  std::vector<Transform> joints;
  std::vector<proxies::Capsule> colliders_start, colliders_end; ///< at both ends of the frame
  std::vector<Vec3> spin;
  std::vector<std::vector<std::uint8_t>> ignored; ///< [garment][collider]: what it does not meet; empty: it meets all
  std::optional<proxies::Plane> ground;
  std::vector<cloth::Particles> garments;
  std::vector<BroadPhaseState> broad; ///< [garment]
  std::vector<int> substeps;          ///< [garment], of the frame
  FrameTimes times;
  int recoveries = 0; ///< since the start

  proxies::SweptColliders swept() const { return {colliders_start, colliders_end, ground, spin}; }
  proxies::SweptColliders swept(std::size_t garment) const {
    return {colliders_start, colliders_end, ground, spin, {}, {}, ignored[garment]};
  }
  std::size_t bytes() const; ///< that it takes
};

/// The session's present frame.
void capture(const Session& session, FrameState& out);

/// As Session::state_hash of that frame.
std::uint64_t state_hash(const FrameState& state);

} // namespace tutu::app
