// Cloth keeps away from itself: particles of one garment that come near each other are pushed apart.
#pragma once

#include "cloth/contact/spatial_hash.h"
#include "cloth/garment/garment.h"
#include "cloth/state/frame.h"
#include "cloth/state/particles.h"
#include "proxies/query/collision_query.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tutu::cloth {

/// Self-collision of one garment, particle against particle.
///
/// What is kept. Particle i has a distance d_i, the fabric's thickness or k_cover times the covering radius of its
/// triangles at rest, whichever is more: the covering radius R of a triangle is that of the least equal balls about its
/// corners that leave no hole in it (half the diagonal of a rectangular cell). Two particles keep D = max(d_i, d_j),
/// unless they are closer than k_same_patch D at rest: those belong to one patch of cloth, and to keep them at their
/// rest distance would forbid it to bend. Cloth is thin and its cells are not, so it is the cells that decide: two
/// layers of square cells of side s rest between 0.53 s (one's particles over the other's cells) and 0.88 s (over its
/// particles) apart. Particles against triangles would lie closer, but there are twice as many triangles, each asks for
/// more than a distance, and to be safe edges must be kept from edges as well; a fold narrower than a cell is not
/// resolved anyhow.
///
/// The bound. At the moment when a particle p passes through a triangle it is within R of one of its corners q, R the
/// triangle's covering radius then, at most k_worn_cell times that at rest. When p and q are at least H = k_held D
/// apart before and after a substep and have moved by u against each other, on straight ways, they were never closer
/// than sqrt(H^2 - |u|^2 / 4). So nothing passes while
///   |u| < 2 sqrt(H^2 - R^2) <= 2 k_safe D   for all pairs,   k_safe = sqrt(k_held^2 - (k_worn_cell / k_cover)^2),
/// k_safe = 0.36: 0.63 s for square cells. Before pairs are pushed apart half of that is allowed (k_safe D): the other
/// half is for the push, which is not bounded itself when many pairs push one particle. Where a pair that may touch
/// within the substep has moved farther, its particles are taken back to k_safe d_i / 2 each, measured against the mean
/// way of the pinned particles (without pins: against the world), which stands for what the cloth lies on: slowed
/// against the mean of all, cloth on the ground would be driven into it by what falls on it. (It is taken at most
/// k_most_off times the least d_i from the mean of the free ones.) They are counted as slowed. So is a particle that
/// goes farther than k_farthest_way d_i against the mean way of the free ones, touching or not: it has been thrown.
/// Neither can be done to pinned particles. A pair that begins a substep closer than H, and one that was too fast with
/// a pinned end, is counted as loose: for the substep no bound is claimed. What moves particles after resolve() (a
/// body's contacts) shows there.
///
/// What is skipped, exactly: the candidates are the pairs closer than D + room when the hash was built; until a
/// particle has travelled its share of the room (against the mean way: a common translation changes no distance) no
/// other pair can touch. Of the candidates those are asked whose two particles have travelled far enough since the last
/// time. The result is that of all pairs, to the bit.
class SelfCollision {
public:
  /// The garment must outlive it.
  explicit SelfCollision(const Garment& garment);

  /// The cloth was put elsewhere.
  void forget() { begin_.clear(); }

  /// A substep of `h` seconds from `start` to `positions`, which are changed. Pairs that began nearer than they keep
  /// are parted at k_push_out_speed at most; the sliding of two that touch is taken back by at most k_cloth_friction
  /// times the push. Pairs are pushed in the order of their numbers: same input, same bits. False, and nothing done,
  /// when a position is no number or out of the world.
  bool resolve(std::span<const Vec3> start, std::span<Vec3> positions, double h);

  /// Particles that resolve() moved, in no order.
  std::span<const int> moved() const { return moved_; }

  const SelfCollisionCounts& counts() const { return counts_; }
  double kept_by(int particle) const { return kept_[particle]; } ///< d_i above, m

private:
  struct Pair {
    int i = 0, j = 0;     ///< i < j
    double kept = 0.0;    ///< D, m
    double before = 0.0;  ///< distance at the substep's start, m
    double reached = 0.0; ///< what the push goes to, m: D or, for what began nearer, less
    bool touched = false;
  };

  void account_ways(std::span<const Vec3> start, std::span<Vec3> positions);
  void allow_slowing(std::span<const Vec3> start);
  void cover(std::span<const Vec3> start);
  void search(std::span<const Vec3> start);
  void wake_pairs(std::span<const Vec3> start);
  bool is_too_fast(const Pair& pair, std::span<const Vec3> start, std::span<const Vec3> positions) const;
  bool slow_down(int particle, const Vec3& start, Vec3& position);
  void slow_down(std::span<const Vec3> start, std::span<Vec3> positions);
  std::int64_t find_near(std::span<const Vec3> start, std::span<const Vec3> positions, double h);
  void push_apart(Pair& pair, std::span<const Vec3> start, std::span<Vec3> positions);
  void touch(int particle);

  const Garment* garment_;
  std::vector<double> kept_;           ///< of each particle, m
  std::vector<double> inverse_masses_; ///< 1/kg; 0 where pinned
  double least_kept_ = 0.0;            ///< m
  int free_ = 0;                       ///< particles
  SpatialHash hash_;
  double room_ = 0.0;                     ///< a particle may travel room_ * kept_ before candidates are found anew
  std::vector<std::array<int, 2>> found_; ///< by the hash, in its order
  std::vector<int> begin_, others_; ///< candidates of particle i: others_[begin_[i] .. begin_[i + 1]), rising, > i
  std::vector<double> wake_;        ///< of each: sum of both travels at which it may touch
  std::vector<double> travel_;      ///< m since the search, against the mean way
  std::vector<double> way_;         ///< m in this substep, against the mean way, at most
  Vec3 mean_way_ = Vec3::Zero();    ///< in this substep, of free particles
  Vec3 held_way_ = Vec3::Zero();    ///< of pinned ones, at most k_most_off of the least kept_ from that
  std::vector<Vec3> seen_;          ///< where each particle was when its travel was last accounted
  std::vector<Pair> awake_, near_;
  std::vector<std::uint8_t> is_slowed_, is_moved_;
  std::vector<int> moved_;
  SelfCollisionCounts counts_;
};

/// 2 k_safe D above: two particles that keep `kept` from each other may move so far against each other in a substep, m.
double safe_way(double kept);

/// Radius of the least equal balls about the corners of a triangle that cover it, m.
double covering_radius(const Vec3& a, const Vec3& b, const Vec3& c);

} // namespace tutu::cloth
