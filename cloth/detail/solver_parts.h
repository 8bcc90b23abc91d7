// What the solvers share within a substep. Private to the folder.
#pragma once

#include "cloth/garment/elements.h"
#include "cloth/solver.h"

#include <chrono>
#include <vector>

namespace tutu::cloth {

using Clock = std::chrono::steady_clock;

/// Adds the time since `from` to `sum` (ms) and returns now.
Clock::time_point lap(Clock::time_point from, double& sum);

/// Pinned particles at their targets at `s` of the frame, with the velocity that took them there within `h` seconds.
void follow_pins(const Garment& garment, const FrameInput& input, double s, double h, Particles& particles);

/// Velocities after the air of the substep that ends at `s`; none where the fabric has no air.
void meet_air(const Garment& garment, std::span<const std::uint8_t> pinned, const FrameInput& input, double s, double h,
              Particles& particles);

/// Where the sides of a seam meet, from the first (0) to the second (1): their centre of mass; a pinned side leads.
double share_of_second(const Garment& garment, std::span<const std::uint8_t> pinned, const Seam& seam);

/// Both sides of a seam meet at their common centre of mass with their common momentum; a pinned side leads.
void close_seams(const Garment& garment, std::span<const std::uint8_t> pinned, Particles& particles);

/// A substep in which something is wrong, for finding out what.
struct Moment {
  const Garment& garment;
  std::span<const std::uint8_t> pinned; ///< one a particle
  int substep = 0;
  double h = 0.0;                    ///< s
  const Particles& particles;        ///< as they were when it was noticed
  std::span<const Vec3> starts = {}; ///< where they were when the substep began; empty where that is not known
  std::span<const Vec3> forces = {}; ///< N, of the springs at these positions; empty: worked out where asked for
};

/// What is_in_world() objects to: the first particle whose place or velocity is no number, else the one that is the
/// farthest out of the world, else the fastest beyond it. What was so when the substep began comes before what it has
/// spread to since.
std::optional<Divergence> find_lost(const Moment& moment);

/// Before a frame begins: a place or a velocity that is no number, or that no collision query would take. (A state that
/// was restored may have any; a step that went well leaves none.)
std::optional<Divergence> find_unusable(const Garment& garment, std::span<const std::uint8_t> pinned,
                                        const Particles& particles);

/// Where a solver looks for what is too long, besides structural springs.
struct WatchedEdges {
  bool shear = false;       ///< diagonals of cells
  bool between_pins = true; ///< edges without a free end
  double rounding = 0.0;    ///< share of a length that the solver may measure wrong
  std::span<const Tether> tethers = {};
};
/// Of the edges, and of the tethers of free particles, that are longer than (1 + k_diverged_stretch) of what they may
/// be the longest, for what it may be.
std::optional<Divergence> find_overlong(const Moment& moment, const WatchedEdges& watched);

/// Whichever there is. Where there is neither, what the solver noticed is a speed: of the particle that went the
/// farthest from where the substep began (without `starts`: that is the farthest from the origin). `speed`: m/s where
/// the solver knows it.
Divergence find_trouble(const Moment& moment, const WatchedEdges& watched, std::optional<double> speed = std::nullopt);

} // namespace tutu::cloth
