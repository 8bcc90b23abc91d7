#include "cloth/woven/hit_keeper.h"

#include "proxies/motion/collider_motion.h"

#include <algorithm>

namespace tutu::cloth {
namespace {

template <class T> Vec3 vector(const T (&v)[3]) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

} // namespace

template <class T> void HitKeeper<T>::begin_step(const WovenSheet<T>& sheet, ContactSet* set) {
  set_ = set;
  hits_.keep = nullptr;
  if (!set_) return;
  set_->begin_step();
  hits_.keep = [](void* keeper, const WovenHit<T>& hit) { static_cast<HitKeeper*>(keeper)->called_.push_back(hit); };
  hits_.keeper = this;
  if (particles_.empty()) particles_ = sheet.particles_of_elements();
}

template <class T> void HitKeeper<T>::add(ClothContact& contact) {
  contact.velocity = contact.moved / h_;
  set_->add(contact);
}

template <class T>
template <class Finish>
void HitKeeper<T>::take_all(int collider, double within, const Finish& finish) {
  if (!std::ranges::is_sorted(called_, {}, &WovenHit<T>::cell))
    std::ranges::stable_sort(called_, {}, &WovenHit<T>::cell);
  for (const WovenHit<T>& hit : called_) {
    ClothContact contact;
    for (int k = 0; k < 3; ++k) {
      contact.particles[k] = hit.corners[k] < 0 ? -1 : particles_[hit.corners[k]];
      contact.weights[k] = static_cast<double>(hit.weights[k]);
      contact.levers[k] = static_cast<double>(hit.levers[k]);
    }
    contact.collider = collider;
    contact.contact.distance = within - static_cast<double>(hit.depth);
    contact.contact.normal = vector(hit.normal);
    contact.contact.closest = vector(hit.point) + origin_ - contact.contact.distance * contact.contact.normal;
    contact.push = static_cast<double>(hit.push);
    contact.moved = vector(hit.moved);
    finish(contact);
    add(contact);
  }
  called_.clear();
}

template <class T> void HitKeeper<T>::take(int collider, const proxies::Capsule& proxy, double within) {
  take_all(collider, within, [&](ClothContact& contact) { set_on_proxy(contact, proxy); });
}

template <class T> void HitKeeper<T>::take(int ground, double within) {
  take_all(ground, within, [](ClothContact& contact) { contact.on = ColliderFeature::ground; });
}

template <class T>
void HitKeeper<T>::take_swept(int collider, const proxies::Capsule& from, const proxies::Capsule& to) {
  for (ClothContact& contact : listed_) {
    contact.collider = collider;
    set_on_proxy(contact, proxies::capsule_at(from, to, contact.time));
    add(contact);
  }
  listed_.clear();
}

template <class T> void HitKeeper<T>::take_settled(std::span<const proxies::Capsule> placed) {
  for (ClothContact& contact : listed_) {
    if (contact.collider < std::ssize(placed)) set_on_proxy(contact, placed[contact.collider]);
    else contact.on = ColliderFeature::ground;
    set_->add(contact);
  }
  listed_.clear();
}

template class HitKeeper<float>;
template class HitKeeper<double>;

} // namespace tutu::cloth
