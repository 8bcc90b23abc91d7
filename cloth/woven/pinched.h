// Tiles of a woven sheet that are caught between colliders, particle by particle in double. Private to the folder.
#pragma once

#include "cloth/contact/between_colliders.h"
#include "cloth/contact/contact_set.h"
#include "cloth/woven/sheet.h"
#include "proxies/motion/collider_set.h"

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace tutu::cloth {

/// Where colliders are in a substep, and how they treat what they meet.
struct PlacedColliders {
  const proxies::SweptColliders& colliders;
  std::span<const proxies::Capsule> before, now;
  std::span<const double> friction; ///< of each collider, then the ground; empty: none
  double share = 1.0;               ///< of the frame that the substep takes
  double h = 0.0;                   ///< s
};

/// A collider of the sheet (the ground is the last) that particles keep `within`, m, from.
struct AskedCollider {
  int collider = 0;
  double within = 0.0;
  double gap = std::numeric_limits<double>::max(); ///< found: least distance, less that
};

/// What settling a tile did.
struct SettledTile {
  bool pinched = false;     ///< a particle was between two colliders
  double start_moved = 0.0; ///< m that a particle's start was moved by, at most
  std::int64_t contacts = 0;
};

template <class T> class PinchedCloth {
public:
  explicit PinchedCloth(const Garment& garment) : between_(garment), x_(garment.rest_positions.size()) {}

  void reserve(std::size_t colliders) { near_.reserve(colliders); } ///< room, so that no later frame asks for more
  /// Takes the places of all particles after the constraints, before the first tile of a substep is settled.
  void begin(const WovenSheet<T>& sheet) { sheet.get_positions(x_); }

  /// Whether a free particle of rows of a block is between two of those that are asked.
  bool is_pinched(const WovenSheet<T>& sheet, const WovenRows& rows, const PlacedColliders& placed,
                  std::span<AskedCollider> asked);

  /// Moves the free particles of rows of a block out of those that are `asked`: as BetweenColliders has it where two
  /// are opposed, else out of one after the other.
  SettledTile settle(WovenSheet<T>& sheet, const WovenRows& rows, const PlacedColliders& placed,
                     std::span<AskedCollider> asked, std::vector<ClothContact>* kept);

private:
  /// A collider at a particle, but for how its surface moves and rubs.
  NearCollider at(int particle, const AskedCollider& asked, const PlacedColliders& placed) const;
  bool is_pinched() const; ///< by near_
  /// Fills near_ with those of `asked` that a particle is nearer to than it can keep, and those that these may push it
  /// to.
  void find_near(int particle, std::span<AskedCollider> asked, const PlacedColliders& placed);

  BetweenColliders between_;
  std::vector<Vec3> x_; ///< of all particles, as they are settled
  std::vector<NearCollider> near_;
};

} // namespace tutu::cloth
