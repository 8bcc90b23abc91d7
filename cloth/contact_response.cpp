#include "cloth/contact_response.h"

#include "cloth/tolerances.h"

#include <algorithm>
#include <cmath>

namespace tutu::cloth {

void ContactResponse::begin_frame(proxies::CollisionQuery& query, const proxies::SweptColliders& colliders,
                                  const Particles& particles, double seconds) {
  colliders_ = colliders;
  double fastest = 0.0; // squared m/s
  for (const Vec3& v : particles.velocities) fastest = std::max(fastest, v.squaredNorm());
  margin_ = k_least_margin + k_margin_growth * std::sqrt(fastest) * seconds;
  placed_.assign(colliders.start.begin(), colliders.start.end());
  find_candidates(query, particles);
}

void ContactResponse::find_candidates(proxies::CollisionQuery& query, const Particles& particles) {
  query.find_candidates(colliders_, particles.positions, offset_ + margin_, candidates_);
  wake_.assign(candidates_.colliders.size(), 0.0);
  particle_travel_.assign(particles.positions.size(), 0.0);
  collider_travel_.assign(static_cast<std::size_t>(colliders_.size()) + 1, 0.0); // the ground, last, stays at 0
  seen_at_ = particles.positions;
  ++counts_.searches;
  counts_.candidates += static_cast<std::int64_t>(candidates_.colliders.size());
}

void ContactResponse::respond(proxies::CollisionQuery& query, double s, std::span<const std::uint8_t> pinned,
                              Particles& particles) {
  placed_before_.swap(placed_);
  placed_.resize(placed_before_.size());
  proxies::colliders_at(colliders_, s, placed_);
  query.place(placed_, colliders_.ground);
  for (std::size_t c = 0; c < placed_.size(); ++c) // no point of the capsule moves farther than its farther end
    collider_travel_[c] +=
        std::max((placed_[c].a - placed_before_[c].a).norm(), (placed_[c].b - placed_before_[c].b).norm());

  double farthest = 0.0;
  for (int i = 0; i < particles.count(); ++i) {
    particle_travel_[i] += (particles.positions[i] - seen_at_[i]).norm();
    seen_at_[i] = particles.positions[i];
    if (!pinned[i]) farthest = std::max(farthest, particle_travel_[i]);
  }
  if (farthest > margin_) {
    margin_ = std::max(margin_, k_margin_growth * farthest);
    find_candidates(query, particles);
  }

  for (int i = 0; i < particles.count(); ++i) {
    if (pinned[i]) continue;
    Vec3& x = particles.positions[i];
    for (int pair = candidates_.begin[i]; pair < candidates_.begin[i + 1]; ++pair) {
      const int collider = candidates_.colliders[pair];
      const double travelled = particle_travel_[i] + collider_travel_[collider];
      if (travelled < wake_[pair]) continue;
      const proxies::Contact contact = query.contact(x, collider);
      ++counts_.queries;
      if (contact.distance >= offset_) {
        wake_[pair] = travelled + (contact.distance - offset_) - k_travel_slack;
        continue;
      }
      const double push = offset_ - contact.distance;
      x += push * contact.normal;
      Vec3& v = particles.velocities[i];
      v -= v.dot(contact.normal) * contact.normal;
      particle_travel_[i] += push;
      seen_at_[i] = x;
      ++counts_.contacts;
    }
  }
}

} // namespace tutu::cloth
