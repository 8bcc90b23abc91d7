// Which particles meet which colliders, substep by substep; what they do then is the solver's business.
#pragma once

#include "cloth/contact/contact_set.h"
#include "cloth/contact/swept_contact.h"
#include "cloth/garment/garment.h"
#include "cloth/state/frame.h"
#include "cloth/state/particles.h"
#include "cloth/state/tolerances.h"
#include "proxies/query/collision_query.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tutu::cloth {

/// Collision of one garment's particles with the colliders of a scene. Owns the memory that is reused from frame to
/// frame.
///
/// Pairs that cannot have met since they were last asked are skipped, exactly: signed distance is 1-Lipschitz in the
/// point and in the collider's motion, so a pair at distance d stays apart until particle and collider together have
/// travelled d.
///
/// A particle is pushed in one substep by no more than both have moved, and k_push_out_speed besides; where that is not
/// enough it began inside, and comes out at that speed: it is not thrown.
///
/// Where a particle and a proxy move more than proxies::safe_motion() in a substep, and `swept` says so, those that
/// went through are put back first.
class ContactSearch {
public:
  /// `offset`: what particles keep from every surface, m >= 0 (Fabric::contact_offset).
  explicit ContactSearch(double offset, bool swept = false) : offset_(offset), swept_(swept) {}

  /// Broad phase for a frame of `seconds`. The spans must live until the next call. `kept`, where there is one, gets
  /// every contact.
  void begin_frame(proxies::CollisionQuery& query, const proxies::SweptColliders& colliders, const Particles& particles,
                   double seconds, ContactSet* kept = nullptr);

  /// Puts the colliders to `s` in (0, 1] of the frame and calls on_contact(particle, collider, contact, push) for every
  /// free particle nearer to one than the offset, to be moved by `push`: offset - distance, or what of it is allowed in
  /// one substep; and for those that went through, with the contact where they touched. Particles rise, and colliders
  /// for each of them; each contact is found where the ones before it left the particle. on_contact moves it, and
  /// returns its Response. `pinned` has one entry a particle; pinned ones are left alone. `particles` are those of
  /// begin_frame, moved on.
  template <class OnContact>
  void for_each_contact(proxies::CollisionQuery& query, double s, std::span<const std::uint8_t> pinned,
                        Particles& particles, const OnContact& on_contact);

  /// Takes `x`, which began the substep at `start`, out of a collider by `push` along the contact's normal, and back by
  /// what rubs. `friction`: of each collider; empty where none rubs. Returns the way.
  Vec3 push_out(Vec3& x, const Vec3& start, int collider, const proxies::Contact& contact, double push,
                std::span<const double> friction) const;

  /// How far the collider's surface has moved since the last substep where it is nearest to `point`, m.
  Vec3 surface_motion(int collider, const Vec3& point) const;

  /// For those who go on where particles end (TriangleContacts), in a substep after for_each_contact(): where particles
  /// and proxies were when it began, the ways of particles before any contact, and how far each has gone since
  /// candidates were found, m. `moved`: a particle has been moved since.
  struct Way {
    std::span<const Vec3> starts, ways;
    std::span<const proxies::Capsule> before, now;
    std::span<const double> particles, colliders;
  };
  Way way() const { return {starts_, particle_way_, placed_before_, placed_, particle_travel_, collider_travel_}; }
  void moved(int particle, const Vec3& x) {
    particle_travel_[particle] += (x - seen_at_[particle]).norm();
    seen_at_[particle] = x;
  }
  /// Whether the last push left the particle in the true body, out of which it is worked slowly.
  bool is_in_body(int particle) const { return in_body_[particle] != 0; }
  /// Keeps a contact where somebody watches. It is whole but for its Response, and what a collider's index tells of it.
  void keep(ClothContact contact, const Response& response) const;
  double offset() const { return offset_; }
  double margin() const { return margin_; } ///< m a particle may go before candidates are found anew
  const proxies::SweptColliders& colliders() const { return colliders_; }
  SweptCollider swept_way(int proxy) const; ///< of a proxy in this substep
  /// How far the collider's fastest point has moved since the last substep, and how far a point may besides be pushed.
  double substep_way(int collider) const;
  double push_speed_step() const { return since_before_ * k_push_out_speed * seconds_; }
  double substep_seconds() const { return since_before_ * seconds_; }

  const ContactCounts& counts() const { return counts_; }
  BroadPhaseView broad_phase() const { return {{}, candidates_.begin, candidates_.colliders}; }

private:
  proxies::MeshContact ask(const proxies::CollisionQuery& query, const Vec3& point, int collider) const;
  void keep_particle(int particle, int collider, const proxies::MeshContact& contact, double push,
                     const Response& response, std::optional<double> swept_at) const;
  void find_candidates(proxies::CollisionQuery& query, const Particles& particles);
  void place(proxies::CollisionQuery& query, double s);
  void account_travel(proxies::CollisionQuery& query, const Particles& particles);
  double bounded_push(int particle, int collider, const Vec3& x, const proxies::Contact& contact);
  std::optional<SweptContact> swept(int particle, int collider, const Vec3& x) const;

  double offset_ = 0.0;
  bool swept_ = false;
  double margin_ = 0.0;                         ///< m a particle may go before candidates are found anew
  double placed_at_ = 0.0, since_before_ = 0.0; ///< of the frame: where placed_ is, and how far from placed_before_
  proxies::SweptColliders colliders_;
  std::vector<proxies::Capsule> placed_, placed_before_;
  proxies::Candidates candidates_;
  std::vector<double> wake_;                              ///< per candidate pair: travelled sum at which it may touch
  std::vector<double> particle_travel_, collider_travel_; ///< m since the candidates were found
  std::vector<Vec3> seen_at_;                             ///< where each particle was when it last reported its travel
  std::vector<Vec3> starts_, particle_way_;               ///< of this substep: its start, and the way since, m
  std::vector<std::uint8_t> in_body_;     ///< whether the last push left a particle inside the true body
  double body_way_ = 0.0, seconds_ = 0.0; ///< m that the true body's fastest vertex goes in the frame
  proxies::MovingBody* body_ = nullptr;   ///< the query's, where colliders were last placed with one
  ContactSet* kept_ = nullptr;            ///< of who watches
  ContactCounts counts_;
};

template <class OnContact>
void ContactSearch::for_each_contact(proxies::CollisionQuery& query, double s, std::span<const std::uint8_t> pinned,
                                     Particles& particles, const OnContact& on_contact) {
  place(query, s);
  account_travel(query, particles);
  for (int i = 0; i < particles.count(); ++i) {
    if (pinned[i]) continue;
    const Vec3& x = particles.positions[i];
    const auto meet = [&](int collider, const proxies::MeshContact& contact, double push,
                          std::optional<double> swept_at = std::nullopt) {
      const Response response = on_contact(i, collider, contact, push);
      if (kept_) keep_particle(i, collider, contact, push, response, swept_at);
      ++counts_.contacts;
    };
    for (int pair = candidates_.begin[i]; pair < candidates_.begin[i + 1]; ++pair) {
      const int collider = candidates_.colliders[pair];
      const double travelled = particle_travel_[i] + collider_travel_[collider];
      if (travelled < wake_[pair]) continue;
      if (const auto gone_through = swept(i, collider, x)) {
        meet(collider, {gone_through->touch}, gone_through->passed, gone_through->time);
        moved(i, x);
      }
      const proxies::MeshContact contact = ask(query, x, collider);
      ++counts_.queries;
      if (contact.distance >= offset_) {
        wake_[pair] = travelled + (contact.distance - offset_) - k_travel_slack;
        if (collider == colliders_.body_index()) in_body_[i] = 0;
        continue;
      }
      meet(collider, contact, bounded_push(i, collider, x, contact));
      moved(i, x);
    }
    if (particle_travel_[i] <= margin_) continue;
    // Pushed out of reach of what was looked for: ask the others too, this once. The next substep searches anew.
    const std::span<const int> asked = candidates_.of(i);
    for (int collider = 0; collider <= colliders_.body_index(); ++collider) {
      if (collider == colliders_.ground_index() && !colliders_.ground) continue;
      if (collider == colliders_.body_index() && !colliders_.has_body()) continue;
      if (!colliders_.meets(collider)) continue;
      if (std::binary_search(asked.begin(), asked.end(), collider)) continue;
      const proxies::MeshContact contact = ask(query, x, collider);
      ++counts_.queries;
      if (contact.distance < offset_) meet(collider, contact, bounded_push(i, collider, x, contact));
    }
  }
}

} // namespace tutu::cloth
