// What becomes of cloth between two colliders that leave it no room.
#pragma once

#include "cloth/garment/elements.h"
#include "proxies/contact.h"

#include <optional>
#include <span>
#include <vector>

namespace tutu::cloth {

/// A collider that a particle is nearer to than it has to keep, or may come to be as others push it.
struct NearCollider {
  int collider = 0;
  proxies::Contact contact;
  double need = 0.0;           ///< m that the particle has to keep from it
  bool is_limited = false;     ///< less than cloth keeps, by what holds it
  Vec3 surface = Vec3::Zero(); ///< how far the surface there has moved in this substep, m
  double moved = 0.0;          ///< how far the collider's fastest point has, m
  double friction = 0.0;

  double lacks() const { return need - contact.distance; } ///< m; <= 0 where it does not touch
};

/// Indices of two of some colliders.
struct Opposed {
  std::size_t first = 0, second = 0;
};
/// The two whose normals are the most opposed of those that leave no room: both touch, or one would as the other pushes
/// straight at it. Nothing where none do.
std::optional<Opposed> opposed(std::span<const NearCollider> near);

/// The rule. A particle that two colliders A, B push apart (normals with nA . nB < 0; of more the two that are the most
/// opposed) cannot keep what it needs of both: it goes to where it lacks as much of one as of the other, along nA - nB
/// and never across, where a push explodes as the two line up; sticks to the mean of both surfaces as far as friction
/// carries; and takes their velocity along nA and nB, so that neither throws it when it lets go [flypapering: Baraff,
/// Witkin, Kass 2003, Untangling Cloth, 4.1, which holds it to one collider]. No push makes a thread to a neighbour
/// longer than k_pinched_thread times its length (or than it is), and of what hangs on a held particle no more is asked
/// than its thread can reach from there: a held particle within a limb is a limit of the limb, not the thread's end.
class BetweenColliders {
public:
  explicit BetweenColliders(const Garment& garment);

  /// Where a particle is and began the substep.
  struct Place {
    int particle = 0;
    Vec3 start;
    double push_step = 0.0; ///< m that a particle may be pushed beyond what it and a collider moved
  };
  struct Settled {
    Vec3 way = Vec3::Zero();   ///< to be added to the particle's place
    Vec3 start = Vec3::Zero(); ///< and to where it began, so that the way leaves no velocity
    int by = -1;               ///< index of the collider that pushed
  };
  /// Nothing where no two of `near` are opposed. `x`: all particles.
  std::optional<Settled> settle(const Place& place, std::span<const NearCollider> near, std::span<const Vec3> x) const;

  /// `way` of a particle cut to what its threads allow.
  Vec3 fitted(int particle, const Vec3& way, std::span<const Vec3> x) const;

  /// What can be asked of a particle at a surface that the particle which holds it is `distance` from.
  double need(int particle, double offset, double distance) const;
  int held_by(int particle) const { return anchors_[particle]; } ///< -1: by none

  struct Thread {
    int other;
    double length; ///< m
  };
  std::span<const Thread> threads_of(int particle) const {
    return std::span(threads_).subspan(begin_[particle], begin_[particle + 1] - begin_[particle]);
  }

private:
  std::vector<int> begin_; ///< of each particle in threads_
  std::vector<Thread> threads_;
  std::vector<int> anchors_;
  std::vector<double> reach_; ///< m, along the cloth to the anchor
};

} // namespace tutu::cloth
