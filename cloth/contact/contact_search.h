// Which particles meet which colliders, substep by substep; what they do then is the solver's business.
#pragma once

#include "cloth/contact/contact_set.h"
#include "cloth/contact/pinched_particles.h"
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
/// What two colliders pushed against each other in a substep is settled between them from the next on
/// (PinchedParticles).
///
/// Where a particle and a proxy move more than proxies::safe_motion() in a substep, and `swept` says so, those that
/// went through are put back first.
class ContactSearch {
public:
  /// Particles of no garment, which no thread joins: each is pushed out of one collider after the other.
  explicit ContactSearch(double offset) : offset_(offset) {}
  /// The garment must outlive it. Takes no memory before its first frame.
  ContactSearch(const Garment& garment, bool swept)
      : garment_(&garment), offset_(garment.fabric.contact_offset()), swept_(swept) {}

  /// Broad phase for a frame. The spans of `input` must live until the next call. Its contacts, where there is a set,
  /// get every one.
  void begin_frame(proxies::CollisionQuery& query, const FrameInput& input, const Particles& particles);
  /// The cloth was put elsewhere: what was pinched is forgotten.
  void forget() {
    if (pinched_) pinched_->forget();
  }

  /// Puts the colliders to `s` in (0, 1] of the frame and calls on_contact(particle, collider, contact, push) for every
  /// free particle nearer to one than the offset, to be moved by `push`: offset - distance, or what of it is allowed in
  /// one substep; and for those that went through, with the contact where they touched. Particles rise, and colliders
  /// for each of them; each contact is found where the ones before it left the particle. on_contact moves it, but no
  /// farther than fitted(particle, way) lets it, and returns its Response. Of a particle between two colliders
  /// on_settled(particle, settled) is called in place of it (BetweenColliders), and adds both ways. `pinned` has one
  /// entry a particle; pinned ones are left alone. `particles` are those of begin_frame, moved on.
  template <class OnContact, class OnSettled>
  void for_each_contact(proxies::CollisionQuery& query, double s, std::span<const std::uint8_t> pinned,
                        Particles& particles, const OnContact& on_contact, const OnSettled& on_settled);
  Vec3 fitted(int particle, const Vec3& way, std::span<const Vec3> x) const {
    return is_pinched(particle) ? pinched_->between().fitted(particle, way, x) : way;
  }
  bool is_pinched(int particle) const { return pinched_ && pinched_->is_pinched(particle); }

  /// The way that takes `x`, which began the substep at `start`, out of a collider by `push` along the contact's
  /// normal, and back by what rubs.
  Vec3 way_out(const Vec3& x, const Vec3& start, int collider, const proxies::Contact& contact, double push) const;

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
  void keep_settled(int particle, const NearCollider& by, const Response& response) const;
  void keep_particle(int particle, int collider, const proxies::MeshContact& contact, double push,
                     const Response& response, std::optional<double> swept_at) const;
  void find_candidates(proxies::CollisionQuery& query, const Particles& particles);
  void place(proxies::CollisionQuery& query, double s);
  void account_travel(proxies::CollisionQuery& query, const Particles& particles);
  double bounded_push(int particle, int collider, const Vec3& x, const proxies::Contact& contact);
  std::optional<SweptContact> swept(int particle, int collider, const Vec3& x) const;
  /// Fills near_ with what a particle is nearer to than it has to keep, or may come to be; whether it is pinched.
  bool find_near(const proxies::CollisionQuery& query, int particle, std::span<const Vec3> x);
  /// What can be asked of a particle at a collider: less than offset() by what holds it.
  double need(const proxies::CollisionQuery& query, int particle, int collider, std::span<const Vec3> x) const;
  template <class OnContact, class OnSettled>
  void settle(proxies::CollisionQuery& query, int particle, Particles& particles, const OnContact& on_contact,
              const OnSettled& on_settled);

  const Garment* garment_ = nullptr;
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
  std::vector<std::uint8_t> in_body_;       ///< whether the last push left a particle inside the true body
  double body_way_ = 0.0, seconds_ = 0.0;   ///< m that the true body's fastest vertex goes in the frame
  proxies::MovingBody* body_ = nullptr;     ///< the query's, where colliders were last placed with one
  ContactSet* kept_ = nullptr;              ///< of who watches
  std::span<const double> friction_;        ///< of each collider; empty where none rubs
  std::optional<PinchedParticles> pinched_; ///< from the first frame on
  std::vector<NearCollider> near_;          ///< room
  ContactCounts counts_;
};

template <class OnContact, class OnSettled>
void ContactSearch::settle(proxies::CollisionQuery& query, int i, Particles& particles, const OnContact& on_contact,
                           const OnSettled& on_settled) {
  const std::vector<Vec3>& x = particles.positions;
  if (find_near(query, i, x)) pinched_->note(i);
  if (near_.empty()) return;
  if (const auto settled = pinched_->between().settle({i, starts_[i], push_speed_step()}, near_, x)) {
    const NearCollider& by = near_[settled->by];
    const Response response = on_settled(i, *settled);
    ++counts_.contacts;
    if (kept_) keep_settled(i, by, response);
    moved(i, x[i]);
    return;
  }
  for (NearCollider& near : near_) { // one after the other, from where those before it left it
    const proxies::MeshContact contact = ask(query, x[i], near.collider);
    near.contact = contact;
    ++counts_.queries;
    if (near.lacks() <= 0.0) continue;
    const double push = std::min(near.lacks(), bounded_push(i, near.collider, x[i], contact));
    const Response response = on_contact(i, near.collider, contact, push);
    ++counts_.contacts;
    if (kept_) keep_settled(i, near, response);
    moved(i, x[i]);
  }
}

template <class OnContact, class OnSettled>
void ContactSearch::for_each_contact(proxies::CollisionQuery& query, double s, std::span<const std::uint8_t> pinned,
                                     Particles& particles, const OnContact& on_contact, const OnSettled& on_settled) {
  place(query, s);
  account_travel(query, particles);
  if (pinched_) pinched_->begin_substep();
  for (int i = 0; i < particles.count(); ++i) {
    if (pinned[i]) continue;
    if (is_pinched(i)) {
      settle(query, i, particles, on_contact, on_settled);
      continue;
    }
    const Vec3& x = particles.positions[i];
    Vec3 pushed = Vec3::Zero(); // the last normal
    bool is_caught = false;
    const auto meet = [&](int collider, const proxies::MeshContact& contact, double push,
                          std::optional<double> swept_at = std::nullopt) {
      const double deep = offset_ - contact.distance - substep_way(collider) - k_left_deep;
      if (pinched_ &&
          (pushed.dot(contact.normal) < 0.0 || (deep > 0.0 && need(query, i, collider, particles.positions) < offset_)))
        is_caught = true;
      pushed = contact.normal;
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
    if (particle_travel_[i] > margin_) {
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
    if (is_caught) pinched_->note(i); // from the next substep on
  }
}

} // namespace tutu::cloth
