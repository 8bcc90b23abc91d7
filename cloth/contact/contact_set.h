// What cloth did where it met colliders: each contact as the solver resolved it, kept for who watches.
#pragma once

#include "proxies/body/body_features.h"
#include "proxies/body/body_mesh.h"
#include "proxies/contact.h"
#include "proxies/distance/feature_contact.h"
#include "proxies/shapes.h"
#include "rig/math.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tutu::cloth {

enum class ContactCause : std::uint8_t {
  depth, ///< where cloth was when the substep ended
  sweep, ///< it had gone through in the substep: found by its time of impact
  pinch  ///< in cloth that is caught between colliders: `moved` is what between_colliders.h makes of the push
};

/// What the cloth met. A cone is a proxy with two radii; the last three are of the true body.
enum class ColliderFeature : std::uint8_t { sphere, capsule, cone, ground, body_vertex, body_edge, body_face };

/// A point of the cloth that is nearer to a collider than the cloth keeps, and what the solver did about it. World
/// space, m. The first of `particles` (a particle), two (an edge) or three (a face) have a part; in a ContactSet the
/// others are -1, and their numbers 0.
///   cloth's point = sum_k weights[k] * x[particles[k]] = contact.closest + contact.distance * contact.normal
/// and the solver moved particle k by levers[k] * moved. All is as it was when this contact was resolved, after those
/// kept before it: of a sweep, `contact` is at the time of impact; of edges and faces with the true body, whose
/// contacts with one triangle are found together, `closest` is where that was, and the equation holds along the normal.
struct ClothContact {
  std::array<int, 3> particles = {-1, -1, -1};
  std::array<double, 3> weights = {}, levers = {}; ///< levers are 0 of pinned particles
  int collider = 0;                                ///< as in proxies::SweptColliders
  proxies::Contact contact;                        ///< with the surface itself: the cloth keeps its offset from that
  double push = 0.0;                               ///< along the normal, > 0
  ContactCause cause = ContactCause::depth;
  double time = 1.0; ///< of the substep, in [0, 1]: of impact
  ColliderFeature on = ColliderFeature::sphere;
  int body_triangle = -1; ///< of the true body; -1 of other colliders
  /// Shares of the collider's points that the contact is nearest to: of a proxy the ends of its axis (a, b), of the
  /// true body the corners of the triangle; 0 of the ground.
  std::array<double, 3> on_collider = {};

  // Known to a ContactSet alone.
  Vec3 moved = Vec3::Zero();    ///< the point was to move by: push * normal, less what rubbed
  Vec3 velocity = Vec3::Zero(); ///< m/s, that this changed the point's velocity by
  int step = 0;                 ///< of those that were kept; rising by one a frame, and where a frame is done again
  int substep = 0;              ///< of the step

  Vec3 point(std::span<const Vec3> x) const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 3 && particles[k] >= 0; ++k) sum += weights[k] * x[particles[k]];
    return sum;
  }
  /// Moves the particles so that the point moves by `way` (or less, where levers are bounded).
  void move(std::span<Vec3> x, const Vec3& way) const {
    for (int k = 0; k < 3 && particles[k] >= 0; ++k) x[particles[k]] += levers[k] * way;
  }
  Vec3 rubbed() const { return moved - push * contact.normal; } ///< what friction moved the point back by
  proxies::ClothFeature feature() const {
    if (particles[2] >= 0) return proxies::ClothFeature::face;
    return particles[1] >= 0 ? proxies::ClothFeature::edge : proxies::ClothFeature::vertex;
  }
};

/// What a solver did at a contact: of the point of the cloth, m and m/s.
struct Response {
  Vec3 moved = Vec3::Zero();    ///< ClothContact::moved
  Vec3 velocity = Vec3::Zero(); ///< ClothContact::velocity
};

/// Sets `on` and `on_collider` of a contact with this proxy.
void set_on_proxy(ClothContact& contact, const proxies::Capsule& proxy);
/// And of one with the true body.
void set_on_body(ClothContact& contact, const proxies::MeshContact& on_body);
void set_on_body(ClothContact& contact, const proxies::BodyContact& on_body);

/// The latest contacts of one garment, in the order in which they were resolved: a ring of as many as the caller asked
/// for, which takes no more memory later. Handed to a solver in FrameInput::contacts; it changes nothing of what the
/// solver does. Which garment it is the caller knows.
class ContactSet {
public:
  explicit ContactSet(std::size_t capacity) : ring_(capacity) {}

  // For solvers, in this order:
  void begin_step() {
    ++step_;
    substep_ = -1;
  }
  void begin_substep() { ++substep_; }
  /// With `step` and `substep` as of now. Corners without a share are left out, and the others moved up.
  void add(const ClothContact& contact);

  /// Kept, of them the oldest first.
  std::size_t size() const { return kept_ < ring_.size() ? static_cast<std::size_t>(kept_) : ring_.size(); }
  const ClothContact& operator[](std::size_t k) const { return ring_[(kept_ - size() + k) % ring_.size()]; }
  int step() const { return step_; }                    ///< the latest; 0 before the first
  std::uint64_t lost() const { return kept_ - size(); } ///< contacts that made room for later ones

private:
  std::vector<ClothContact> ring_;
  std::uint64_t kept_ = 0; ///< ever
  int step_ = 0, substep_ = -1;
};

} // namespace tutu::cloth
