// How cloth asks colliders: one interface, one meaning, several ways.
//
// A frame:    find_candidates(swept colliders, points, reach)      broad phase, once, for particles
//             find_for_boxes(swept colliders, boxes)               and for whatever has a box: edges, triangles, tiles
// a substep:  place(colliders at this moment)                      then, for each candidate pair,
//             contact(point, collider)                             narrow phase: distance, normal, closest point
//             (or neither, where leaves_contacts(): the closed forms of proxies/distance, for many points at once)
//
// Against the true body in the place of proxies: make_mesh_query, and body().
#pragma once

#include "proxies/body/moving_body.h"
#include "proxies/contact.h"
#include "proxies/motion/collider_set.h"

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

  /// Whether who asks may work contacts out itself: true where contact() is no more than the closed forms
  /// (proxies/distance/closed_forms_inl.h) of the collider, and the backend's worth is in its candidates. Cloth that
  /// has vectors of particles then asks for candidates alone, and takes the same forms for as many points at once as a
  /// vector holds; place() and contact() are for those that have one point at a time.
  virtual bool leaves_contacts() const { return false; }

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

  /// The true body, of the backend that has it; it is to be placed beside place(). Null of the others.
  virtual MovingBody* body() { return nullptr; }
};

enum class Backend {
  fcl,    ///< candidates by FCL's tree, per particle; contacts by FCL's distance, asked in the one sound way
  hybrid, ///< candidates by FCL's tree or a list, whichever is quicker; contacts, the closed forms, left to who asks
  brute,  ///< every pair is a candidate; contacts by the closed forms: the twin that tests compare with
  mesh    ///< no proxies: the true, skinned body (BodyMesh), for reference runs
};

/// As in scene files and on the command line, in the order of Backend.
inline constexpr std::array<std::string_view, 4> k_backend_names = {"fcl", "hybrid", "brute", "mesh"};
inline constexpr std::span k_proxy_backend_names = std::span(k_backend_names).first<3>(); ///< those of make_query
Backend backend_named(std::string_view name); ///< one of k_backend_names; std::invalid_argument for any other

/// std::invalid_argument for Backend::mesh, which needs a body.
std::unique_ptr<CollisionQuery> make_query(Backend backend);

/// Backend::mesh: the body in all poses that SweptColliders::body_start and body_end give its vertices, and the ground.
/// There are no other colliders.
std::unique_ptr<CollisionQuery> make_mesh_query(BodyMesh body);

} // namespace tutu::proxies
