// Distance of a point from posed capsules, asked of FCL in the one way that is sound, behind a face that shows no FCL.
#pragma once

#include "proxies/contact.h"
#include "proxies/shapes.h"

#include <memory>
#include <span>

namespace tutu::proxies {

class NarrowPhase {
public:
  NarrowPhase();
  ~NarrowPhase();
  NarrowPhase(const NarrowPhase&) = delete;
  NarrowPhase& operator=(const NarrowPhase&) = delete;

  /// Puts the colliders where they are now. They must be finite. Allocates only when the count grows.
  void place(std::span<const Capsule> colliders);

  /// A finite point against the placed collider. Safe from several threads at once.
  Contact contact(const Vec3& point, int collider) const;

private:
  struct Placed;
  std::unique_ptr<Placed> placed_;
};

} // namespace tutu::proxies
