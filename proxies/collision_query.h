// How cloth asks colliders: one interface, one meaning, several ways.
//
// A frame:    find_candidates(swept colliders, points, reach)      broad phase, once, for particles
//             find_for_boxes(swept colliders, boxes)               and for whatever has a box: edges, triangles, tiles
// a substep:  place(colliders at this moment)                      then, for each candidate pair,
//             contact(point, collider)                             narrow phase: distance, normal, closest point
#pragma once

#include "proxies/collider_set.h"
#include "proxies/contact.h"

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tutu::proxies {

/// Which colliders each point (or box) may meet, in compressed rows: those of point i are colliders[begin[i]] ..
/// colliders[begin[i + 1] - 1], rising. Memory is reused from call to call.
struct Candidates {
  std::vector<int> begin; ///< points + 1 entries
  std::vector<int> colliders;

  std::span<const int> of(int point) const {
    return {colliders.data() + begin[point], static_cast<std::size_t>(begin[point + 1] - begin[point])};
  }
};

class CollisionQuery {
public:
  virtual ~CollisionQuery() = default;

  virtual std::string_view name() const = 0; ///< as on the command line: one of k_backend_names

  /// For each point every collider whose surface comes within `reach` (m, >= 0) of it at any time of the frame. May
  /// hold more, never fewer. The ground (index size()) is always a candidate where there is one. Points and colliders
  /// must be finite.
  virtual void find_candidates(const SweptColliders& colliders, std::span<const Vec3> points, double reach,
                               Candidates& out) = 0;

  /// For each box (world, m, already grown by whatever reach is wanted) every collider whose swept box touches it. May
  /// hold more, never fewer. The ground as above. Boxes must be finite and not empty.
  virtual void find_for_boxes(const SweptColliders& colliders, std::span<const Box> boxes, Candidates& out) = 0;

  /// Puts the colliders where they are now. Same order and count as in find_candidates.
  virtual void place(std::span<const Capsule> colliders, const std::optional<Plane>& ground) = 0;

  /// One point against one placed collider. Signed distance and conventions of proxies/contact.h.
  virtual Contact contact(const Vec3& point, int collider) const = 0;
};

enum class Backend {
  fcl,    ///< FCL tree, per particle; FCL distance asked in the one sound way
  hybrid, ///< FCL tree or a plain list, whichever is quicker, per run of particles; closed form in double
  brute   ///< every pair, closed form in double: the twin that tests compare with
};

/// As in scene files and on the command line, in the order of Backend.
inline constexpr std::array<std::string_view, 3> k_backend_names = {"fcl", "hybrid", "brute"};
Backend backend_named(std::string_view name); ///< one of k_backend_names; std::invalid_argument for any other

std::unique_ptr<CollisionQuery> make_query(Backend backend);

} // namespace tutu::proxies
