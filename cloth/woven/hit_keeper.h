// What the kernels pushed, for who watches. Private to the folder.
#pragma once

#include "cloth/contact/contact_set.h"
#include "cloth/woven/sheet.h"

#include <vector>

namespace tutu::cloth {

/// Makes ClothContacts of a kernel's hits, in an order that does not depend on how many lanes a vector has: those of
/// one call by cell, those of one cell as they came.
template <class T> class HitKeeper {
public:
  void begin_step(const WovenSheet<T>& sheet, ContactSet* set);
  void begin_substep(const Vec3& origin, double h) {
    origin_ = origin;
    h_ = h;
    if (set_) set_->begin_substep();
  }
  bool keeps() const { return set_ != nullptr; }

  /// For kernels' calls: its count goes on and on.
  WovenHits<T>& hits() { return hits_; }
  /// After a call: with which collider it was, and what of its surface is `within`, m: the offset, and the rise.
  void take(int collider, const proxies::Capsule& proxy, double within);
  void take(int ground, double within);

  /// For contacts that plain code finds. Of a sweep they lack their collider; `from` to `to`: the proxy's way in the
  /// substep.
  std::vector<ClothContact>* listed() { return keeps() ? &listed_ : nullptr; }
  void take_swept(int collider, const proxies::Capsule& from, const proxies::Capsule& to);
  void take_settled(std::span<const proxies::Capsule> placed); ///< contacts of depth; the ground is behind the last

private:
  template <class Finish> void take_all(int collider, double within, const Finish& finish);
  void add(ClothContact& contact);

  ContactSet* set_ = nullptr;
  std::vector<int> particles_; ///< of each element; made when somebody first watches
  Vec3 origin_ = Vec3::Zero();
  double h_ = 0.0;
  WovenHits<T> hits_;
  std::vector<WovenHit<T>> called_;  ///< of the call
  std::vector<ClothContact> listed_; ///< of the call
};

} // namespace tutu::cloth
