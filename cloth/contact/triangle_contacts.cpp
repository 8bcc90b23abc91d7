#include "cloth/contact/triangle_contacts.h"

#include "cloth/state/tolerances.h"
#include "proxies/distance/feature_contact.h"

#include <algorithm>
#include <cmath>

namespace tutu::cloth {

Vec3 push_out(const ClothContact& contact, const ContactSearch& search, std::span<const Vec3> starts,
              std::vector<Vec3>& x) {
  const Vec3 way =
      search.way_out(contact.point(x), contact.point(starts), contact.collider, contact.contact, contact.push);
  contact.move(x, way);
  return way;
}

void TriangleContacts::list_triangles() {
  const std::vector<std::uint8_t> pinned = pinned_flags(*garment_);
  inverse_masses_.reserve(pinned.size());
  for (int i = 0; i < garment_->particle_count(); ++i)
    inverse_masses_.push_back(pinned[i] ? 0.0 : 1.0 / garment_->masses[i]);
  triangles_.reserve(garment_->triangles.size());
  for (const auto& [a, b, c] : garment_->triangles)
    if (!(pinned[a] && pinned[b] && pinned[c]))
      triangles_.push_back({static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
  boxes_.resize(triangles_.size());
}

void TriangleContacts::begin_frame(proxies::CollisionQuery& query, const ContactSearch& search,
                                   const Particles& particles) {
  if (features_ == ContactFeatures::particles) return;
  if (inverse_masses_.empty()) list_triangles();
  find_pairs(query, search, particles);
}

void TriangleContacts::find_pairs(proxies::CollisionQuery& query, const ContactSearch& search,
                                  const Particles& particles) {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    boxes_[t].setEmpty();
    for (const int i : triangles_[t]) boxes_[t].extend(particles.positions[i]);
    const Vec3 grown = Vec3::Constant(search.offset() + search.margin());
    boxes_[t].min() -= grown;
    boxes_[t].max() += grown;
  }
  query.find_for_boxes(search.colliders(), boxes_, candidates_);
  const auto proxies = static_cast<int>(search.way().now.size());
  pairs_.clear();
  begin_.assign(1, 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const int collider : candidates_.of(static_cast<int>(t)))
      if (collider < proxies) // a plane meets the corners first
        pairs_.push_back({collider, squared_edge_for(search.way().now[collider], search.offset())});
    begin_.push_back(static_cast<int>(pairs_.size()));
  }
  body_wakes_.assign(triangles_.size(), 0.0);
  searches_ = search.counts().searches;
  ++counts_.searches;
  counts_.candidates += static_cast<std::int64_t>(pairs_.size());
}

double TriangleContacts::squared_edge_for(const proxies::Capsule& proxy, double offset) const {
  if (features_ == ContactFeatures::triangles) return -1.0;
  // The middle of a triangle bent around the collider with legs of length l lies (2/9) l^2 within the square of its
  // corners' distance from the axis.
  const double radius = proxy.narrowest(), kept = radius + offset;
  return 4.5 * (kept * kept - radius * radius);
}

double TriangleContacts::squared_longest_edge(const Triangle& triangle, const std::vector<Vec3>& x) {
  const auto& [a, b, c] = triangle;
  return std::max({(x[b] - x[a]).squaredNorm(), (x[c] - x[b]).squaredNorm(), (x[a] - x[c]).squaredNorm()});
}

bool TriangleContacts::is_kept_by_particles(const Triangle& triangle, double longest, const ContactSearch& search,
                                            const Pair& pair) const {
  if (longest > pair.squared_edge) return false;
  const ContactSearch::Way way = search.way();
  const double radius = way.now[pair.collider].narrowest(), widest_kept = 2.0 * (radius + search.offset());
  if (k_torn_cell * k_torn_cell * longest <= widest_kept * widest_kept) return true;
  const auto& [a, b, c] = triangle;
  const double motion =
      std::sqrt(std::max({way.ways[a].squaredNorm(), way.ways[b].squaredNorm(), way.ways[c].squaredNorm()})) +
      search.substep_way(pair.collider);
  return motion <
         std::min(0.5 * proxies::safe_motion(radius, search.offset()), k_hasty_speed * search.substep_seconds());
}

std::optional<ClothContact> TriangleContacts::with_levers(ClothContact contact) const {
  double lightness = 0.0; // sum of inverse mass times squared weight
  double most = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double w = inverse_masses_[contact.particles[k]] * contact.weights[k];
    contact.levers[k] = w;
    lightness += w * contact.weights[k];
    most = std::max(most, w);
  }
  if (!(lightness > 0.0)) return std::nullopt;
  lightness = std::max(lightness, most / k_longest_lever);
  for (double& lever : contact.levers) lever /= lightness;
  return contact;
}

std::optional<ClothContact> TriangleContacts::swept(const Triangle& triangle, const ContactSearch& search, int proxy,
                                                    const Particles& particles) const {
  if (!swept_) return std::nullopt;
  const ContactSearch::Way way = search.way();
  std::array<Vec3, 3> from, to;
  double motion = 0.0;
  for (int k = 0; k < 3; ++k) {
    from[k] = way.starts[triangle[k]];
    to[k] = particles.positions[triangle[k]];
    motion = std::max(motion, (to[k] - from[k]).norm());
  }
  if (motion + search.substep_way(proxy) < proxies::safe_motion(way.now[proxy].narrowest(), search.offset()))
    return std::nullopt;
  const auto contact = swept_contact(from, to, search.swept_way(proxy));
  if (!contact) return std::nullopt;
  return with_levers(
      {triangle, contact->weights, {}, proxy, contact->touch, contact->passed, ContactCause::sweep, contact->time});
}

std::optional<ClothContact> TriangleContacts::found(const Triangle& triangle, const ContactSearch& search, Pair& pair,
                                                    double travelled, const Particles& particles) {
  const ContactSearch::Way way = search.way();
  const auto& [a, b, c] = triangle;
  const std::vector<Vec3>& x = particles.positions;
  const proxies::Capsule& proxy = way.now[pair.collider];
  const auto ask = [&](const Vec3& side) { return proxies::triangle_contact(x[a], x[b], x[c], proxy, side); };
  proxies::FeatureContact contact = ask(Vec3::Zero());
  ++counts_.queries;
  if (contact.distance >= search.offset()) {
    pair.wake = travelled + (contact.distance - search.offset()) - k_travel_slack;
    return std::nullopt;
  }
  if (contact.feature == proxies::ClothFeature::crossing) { // back to where it was when the substep began
    const proxies::Capsule& before = way.before[pair.collider];
    const ClothContact crossed{triangle, contact.weights, {}, pair.collider, contact};
    contact = ask(crossed.point(way.starts) - (before.a + contact.on_axis * (before.b - before.a)));
  }
  auto met = with_levers({triangle, contact.weights, {}, pair.collider, contact});
  if (met) met->push = bounded_push(*met, search, x);
  return met && met->push > 0.0 ? met : std::nullopt;
}

double TriangleContacts::bounded_push(const ClothContact& contact, const ContactSearch& search,
                                      const std::vector<Vec3>& x) const {
  const double needed = search.offset() - contact.contact.distance;
  const double allowed = search.substep_way(contact.collider) + search.push_speed_step();
  const Vec3 way = contact.point(search.way().ways);
  if (needed <= way.norm() + allowed) return needed;
  // It began inside: all contacts together take it out at that speed, and it keeps to it from substep to substep.
  const Vec3 gone = contact.point(x) - contact.point(search.way().starts);
  return std::clamp(allowed - std::max(gone.dot(contact.contact.normal), (gone - way).norm()), 0.0, needed);
}

} // namespace tutu::cloth
