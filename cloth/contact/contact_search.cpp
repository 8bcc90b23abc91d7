#include "cloth/contact/contact_search.h"

#include "cloth/contact/coulomb.h"
#include "proxies/motion/collider_motion.h"

#include <algorithm>
#include <cmath>

namespace tutu::cloth {

void ContactSearch::begin_frame(proxies::CollisionQuery& query, const FrameInput& input, const Particles& particles) {
  const proxies::SweptColliders& colliders = input.colliders;
  const double seconds = input.seconds;
  if (garment_ && !pinched_) pinched_.emplace(*garment_);
  colliders_ = colliders;
  friction_ = input.friction;
  kept_ = input.contacts;
  if (kept_) kept_->begin_step();
  double fastest = 0.0; // squared m/s
  for (const Vec3& v : particles.velocities) fastest = std::max(fastest, v.squaredNorm());
  margin_ = k_least_margin + k_margin_growth * std::sqrt(fastest) * seconds;
  placed_.assign(colliders.start.begin(), colliders.start.end());
  placed_at_ = 0.0;
  seconds_ = seconds;
  body_way_ = 0.0;
  for (std::size_t v = 0; v < colliders.body_start.size(); ++v)
    body_way_ = std::max(body_way_, static_cast<double>((colliders.body_end[v] - colliders.body_start[v]).norm()));
  find_candidates(query, particles);
}

void ContactSearch::find_candidates(proxies::CollisionQuery& query, const Particles& particles) {
  query.find_candidates(colliders_, particles.positions, offset_ + margin_, candidates_);
  wake_.assign(candidates_.colliders.size(), 0.0);
  particle_travel_.assign(particles.positions.size(), 0.0);
  // Of proxies, the ground, which stays at 0, and the true body.
  collider_travel_.assign(static_cast<std::size_t>(colliders_.body_index()) + 1, 0.0);
  particle_way_.resize(particles.positions.size(), Vec3::Zero());
  in_body_.resize(particles.positions.size(), 0);
  seen_at_ = particles.positions;
  ++counts_.searches;
  counts_.candidates += static_cast<std::int64_t>(candidates_.colliders.size());
}

void ContactSearch::place(proxies::CollisionQuery& query, double s) {
  if (kept_) kept_->begin_substep();
  placed_before_.swap(placed_);
  since_before_ = s - placed_at_;
  placed_at_ = s;
  placed_.resize(placed_before_.size());
  proxies::colliders_at(colliders_, s, placed_);
  query.place(placed_, colliders_.ground);
  for (std::size_t c = 0; c < placed_.size(); ++c) collider_travel_[c] += substep_way(static_cast<int>(c));
  if (!colliders_.has_body()) return;
  body_ = query.body();
  body_->place(s);
  collider_travel_[colliders_.body_index()] += substep_way(colliders_.body_index());
}

proxies::MeshContact ContactSearch::ask(const proxies::CollisionQuery& query, const Vec3& point, int collider) const {
  if (collider == colliders_.body_index()) return body_->contact(point);
  return {query.contact(point, collider), -1};
}

void ContactSearch::keep_particle(int particle, int collider, const proxies::MeshContact& contact, double push,
                                  const Response& response, std::optional<double> swept_at) const {
  ClothContact kept;
  kept.particles[0] = particle;
  kept.weights[0] = kept.levers[0] = 1.0;
  kept.collider = collider;
  kept.contact = contact;
  kept.push = push;
  if (swept_at) {
    kept.cause = ContactCause::sweep;
    kept.time = *swept_at;
  }
  if (collider == colliders_.body_index()) set_on_body(kept, contact);
  keep(kept, response);
}

void ContactSearch::keep(ClothContact contact, const Response& response) const {
  if (!kept_) return;
  contact.moved = response.moved;
  contact.velocity = response.velocity;
  if (contact.collider == colliders_.ground_index()) contact.on = ColliderFeature::ground;
  else if (contact.collider < colliders_.ground_index()) // placed where it was met
    set_on_proxy(contact,
                 proxies::capsule_at(placed_before_[contact.collider], placed_[contact.collider], contact.time));
  kept_->add(contact);
}

double ContactSearch::substep_way(int collider) const {
  if (collider == colliders_.body_index()) return since_before_ * body_way_;
  if (collider == colliders_.ground_index()) return 0.0;
  return proxies::farthest_way(placed_before_[collider], placed_[collider]);
}

SweptCollider ContactSearch::swept_way(int proxy) const {
  const Vec3 spin = colliders_.spin.empty() ? Vec3(Vec3::Zero()) : Vec3(since_before_ * colliders_.spin[proxy]);
  return {placed_before_[proxy], placed_[proxy], spin, offset_};
}

std::optional<SweptContact> ContactSearch::swept(int particle, int collider, const Vec3& x) const {
  if (!swept_ || collider >= static_cast<int>(placed_.size())) return std::nullopt;
  const double safe = proxies::safe_motion(placed_[collider].narrowest(), offset_);
  if (particle_way_[particle].norm() + substep_way(collider) < safe) return std::nullopt;
  return swept_contact(starts_[particle], x, swept_way(collider));
}

double ContactSearch::bounded_push(int particle, int collider, const Vec3& x, const proxies::Contact& contact) {
  const double needed = offset_ - contact.distance;
  const double speed_step = substep_way(collider) + push_speed_step();
  if (collider != colliders_.body_index()) return std::min(needed, (x - starts_[particle]).norm() + speed_step);
  const double most = in_body_[particle] ? std::max(0.0, speed_step - particle_way_[particle].dot(contact.normal))
                                         : particle_way_[particle].norm() + speed_step;
  in_body_[particle] = most < needed;
  return std::min(needed, most);
}

void ContactSearch::account_travel(proxies::CollisionQuery& query, const Particles& particles) {
  double farthest = 0.0;
  starts_ = seen_at_;
  for (int i = 0; i < particles.count(); ++i) {
    particle_way_[i] = particles.positions[i] - seen_at_[i];
    particle_travel_[i] += particle_way_[i].norm();
    seen_at_[i] = particles.positions[i];
    farthest = std::max(farthest, particle_travel_[i]);
  }
  if (farthest > margin_) {
    margin_ = std::max(margin_, k_margin_growth * farthest);
    find_candidates(query, particles);
  }
}

Vec3 ContactSearch::way_out(const Vec3& x, const Vec3& start, int collider, const proxies::Contact& contact,
                            double push) const {
  const Vec3 out = x + push * contact.normal;
  if (friction_.empty()) return out - x;
  return rubbed(out, out - start - surface_motion(collider, out), contact.normal, friction_[collider] * push) - x;
}

double ContactSearch::need(const proxies::CollisionQuery& query, int particle, int collider,
                           std::span<const Vec3> x) const {
  const int held = pinched_->between().held_by(particle);
  return held < 0 || collider == colliders_.body_index()
             ? offset_
             : pinched_->between().need(particle, offset_, ask(query, x[held], collider).distance);
}

bool ContactSearch::find_near(const proxies::CollisionQuery& query, int i, std::span<const Vec3> x) {
  near_.clear();
  double deepest = 0.0;
  bool is_limited = false;
  for (int pair = candidates_.begin[i]; pair < candidates_.begin[i + 1]; ++pair) {
    const int collider = candidates_.colliders[pair];
    const double travelled = particle_travel_[i] + collider_travel_[collider];
    if (travelled < wake_[pair]) continue;
    NearCollider near;
    near.collider = collider;
    near.contact = ask(query, x[i], collider);
    near.need = need(query, i, collider, x);
    near.moved = substep_way(collider);
    near.surface = surface_motion(collider, near.contact.closest);
    if (!friction_.empty()) near.friction = friction_[collider];
    ++counts_.queries;
    if (near.contact.distance >= offset_) wake_[pair] = travelled + (near.contact.distance - offset_) - k_travel_slack;
    deepest = std::max(deepest, near.lacks());
    is_limited = is_limited || (near.need < offset_ && near.lacks() > 0.0);
    near_.push_back(near);
  }
  std::erase_if(near_, [&](const NearCollider& near) { return near.lacks() <= -deepest; });
  return is_limited || opposed(near_);
}

void ContactSearch::keep_settled(int particle, const NearCollider& by, const Response& response) const {
  ClothContact kept;
  kept.particles[0] = particle;
  kept.weights[0] = kept.levers[0] = 1.0;
  kept.collider = by.collider;
  kept.contact = by.contact;
  kept.push = response.moved.dot(by.contact.normal);
  kept.cause = ContactCause::pinch;
  keep(kept, response);
}

Vec3 ContactSearch::surface_motion(int collider, const Vec3& point) const {
  if (collider == colliders_.body_index()) return since_before_ * body_->way(point);
  if (collider == colliders_.ground_index()) return Vec3::Zero();
  return proxies::surface_motion(placed_before_[collider], placed_[collider], swept_way(collider).spin, point);
}

} // namespace tutu::cloth
