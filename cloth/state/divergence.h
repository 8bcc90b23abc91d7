// Why a run cannot go on: what was found, where, and what brought it about.
#pragma once

#include "rig/math.h"

#include <optional>
#include <string>

namespace tutu::cloth {

/// What was found. Where several are true of one state, the first of this list is told that is.
enum class Trouble {
  bad_target,   ///< the target of a pin was no number: nothing was computed
  bad_collider, ///< a collider, or a vertex of the true body, was none: nothing was computed
  no_number,    ///< the place or the velocity of a particle was none
  out_of_world, ///< a particle was farther from the origin than k_world_radius, along an axis
  too_fast,     ///< a particle went faster than that in a second, or as far in a substep
  long_edge,    ///< a spring was longer than (1 + k_diverged_stretch) of its rest length
  long_tether   ///< so was the way from a particle to the held one that it hangs on
};

/// The worst that was found, in the state in which it was found.
struct Divergence {
  Trouble trouble = Trouble::no_number;
  int substep = 0;              ///< of the frame, from 0
  int particle = 0;             ///< of an edge the end that was faster; not of a collider
  Vec3 position = Vec3::Zero(); ///< of it, world, m; where that is no number, the last one known that is

  int other = -1;           ///< the other end of an edge; what a tether hangs on
  double length = 0.0;      ///< m, of the edge or tether
  double rest_length = 0.0; ///< m, of the edge; of a tether the longest it may be
  double speed = 0.0;       ///< m/s, of `particle` in this substep

  /// A held particle that is nearest to `particle` at rest, that one itself where it is held.
  struct Held {
    int particle = 0;
    double way = 0.0; ///< m that its pin moved it in this substep
  };
  std::optional<Held> held;
  int strongest_particle = 0;
  double strongest_force = 0.0; ///< N, the largest of the springs' that is a number; 0 where it was not looked for

  double stretch() const { return length / rest_length - 1.0; } ///< of an edge or tether
  bool is_of_length() const { return trouble == Trouble::long_edge || trouble == Trouble::long_tether; }
};

/// What was found and what brought it about, as parts of a sentence in the past tense: no capital, no full stop.
std::string what_was_found(const Divergence& divergence);

/// A frame that was not taken because FrameInput::stop said so.
struct Stopped {
  int substeps = 0; ///< that were done
};

} // namespace tutu::cloth
