#include "cloth/woven/pinched.h"

#include "cloth/contact/coulomb.h"
#include "cloth/state/tolerances.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_motion.h"

#include <algorithm>

namespace tutu::cloth {
namespace {

proxies::Contact contact_with(const PlacedColliders& placed, int collider, const Vec3& point) {
  return collider < placed.colliders.size() ? proxies::signed_distance(point, placed.now[collider])
                                            : proxies::signed_distance(point, *placed.colliders.ground);
}

/// How a collider moves where it is met, and how it rubs.
void set_surface(NearCollider& near, const PlacedColliders& placed) {
  if (!placed.friction.empty()) near.friction = placed.friction[near.collider];
  if (near.collider >= placed.colliders.size()) return;
  const proxies::Capsule &before = placed.before[near.collider], &now = placed.now[near.collider];
  const std::span<const Vec3> spins = placed.colliders.spin;
  const Vec3 spin = spins.empty() ? Vec3(Vec3::Zero()) : Vec3(placed.share * spins[near.collider]);
  near.surface = proxies::surface_motion(before, now, spin, near.contact.closest);
  near.moved = proxies::farthest_way(before, now);
}

} // namespace

template <class T>
NearCollider PinchedCloth<T>::at(int particle, const AskedCollider& asked, const PlacedColliders& placed) const {
  NearCollider near;
  near.collider = asked.collider;
  near.contact = contact_with(placed, asked.collider, x_[particle]);
  near.need = asked.within;
  if (const int held = between_.held_by(particle); held >= 0)
    near.need = between_.need(particle, asked.within, contact_with(placed, asked.collider, x_[held]).distance);
  near.is_limited = near.need < asked.within;
  return near;
}

template <class T>
void PinchedCloth<T>::find_near(int particle, std::span<AskedCollider> asked, const PlacedColliders& placed) {
  near_.clear();
  double deepest = 0.0;
  for (AskedCollider& other : asked) {
    const NearCollider& near = near_.emplace_back(at(particle, other, placed));
    other.gap = std::min(other.gap, near.contact.distance - other.within);
    deepest = std::max(deepest, near.lacks());
  }
  std::erase_if(near_, [&](const NearCollider& near) { return near.lacks() <= -deepest; });
  for (NearCollider& near : near_) set_surface(near, placed);
}

template <class T> bool PinchedCloth<T>::is_pinched() const {
  return opposed(near_) ||
         std::ranges::any_of(near_, [](const NearCollider& near) { return near.is_limited && near.lacks() > 0.0; });
}

template <class T>
bool PinchedCloth<T>::is_pinched(const WovenSheet<T>& sheet, const WovenRows& rows, const PlacedColliders& placed,
                                 std::span<AskedCollider> asked) {
  bool found = false;
  sheet.for_free(rows, [&](int particle) {
    if (found) return;
    find_near(particle, asked, placed);
    found = is_pinched();
  });
  return found;
}

template <class T>
SettledTile PinchedCloth<T>::settle(WovenSheet<T>& sheet, const WovenRows& rows, const PlacedColliders& placed,
                                    std::span<AskedCollider> asked, std::vector<ClothContact>* kept) {
  SettledTile result;
  const double push_step = k_push_out_speed * placed.h;
  const auto move = [&](int particle, const NearCollider& near, const Vec3& moved, const Vec3& start = Vec3::Zero()) {
    if (moved.isZero(0.0) && start.isZero(0.0)) return; // its threads let nothing move
    sheet.move_to(particle, x_[particle] + moved);
    x_[particle] = sheet.position(particle);
    ++result.contacts;
    if (!kept) return;
    ClothContact& contact = kept->emplace_back();
    contact.particles[0] = particle;
    contact.weights[0] = contact.levers[0] = 1.0;
    contact.collider = near.collider;
    contact.contact = near.contact;
    contact.push = moved.dot(near.contact.normal);
    contact.moved = moved;
    contact.cause = ContactCause::pinch;
    contact.velocity = (moved - start) / placed.h;
  };
  sheet.for_free(rows, [&](int i) {
    x_[i] = sheet.position(i); // the sweeps of tiles before may have moved it
    find_near(i, asked, placed);
    if (near_.empty()) return;
    result.pinched = result.pinched || is_pinched();
    const Vec3 start = sheet.start_position(i);
    if (const auto settled = between_.settle({i, start, push_step}, near_, x_)) {
      result.start_moved = std::max(result.start_moved, settled->start.norm());
      sheet.move_start_to(i, start + settled->start);
      move(i, near_[settled->by], settled->way, settled->start);
    } else {
      for (const AskedCollider& other : asked) {
        NearCollider near = at(i, other, placed); // from where those before it left the particle
        if (near.lacks() <= 0.0) continue;
        set_surface(near, placed);
        const Vec3 way = x_[i] - start, &n = near.contact.normal;
        const double push = std::min(near.lacks(), way.norm() + near.moved + push_step);
        const Vec3 pushed = push * n;
        move(i, near, between_.fitted(i, rubbed(pushed, way + pushed - near.surface, n, near.friction * push), x_));
      }
    }
  });
  return result;
}

template class PinchedCloth<float>;
template class PinchedCloth<double>;

} // namespace tutu::cloth
