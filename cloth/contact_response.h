// What cloth does when it meets a collider: it is put on the surface and stops moving along the normal.
#pragma once

#include "cloth/particles.h"
#include "proxies/collision_query.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tutu::cloth {

struct ContactCounts {
  std::int64_t searches = 0;   ///< broad phases
  std::int64_t candidates = 0; ///< pairs the broad phases gave
  std::int64_t queries = 0;    ///< narrow-phase calls
  std::int64_t contacts = 0;   ///< projections
};

/// Collision of one garment's particles with the colliders of a scene. Owns the memory that is reused from frame to
/// frame.
///
/// Pairs that cannot have met since they were last asked are skipped, exactly: signed distance is 1-Lipschitz in the
/// point and in the collider's motion, so a pair at distance d stays apart until particle and collider together have
/// travelled d.
class ContactResponse {
public:
  /// `offset`: what particles keep from every surface, m >= 0 (Fabric::contact_offset).
  explicit ContactResponse(double offset) : offset_(offset) {}

  /// Broad phase for a frame of `seconds`. The spans must live until the next call.
  void begin_frame(proxies::CollisionQuery& query, const proxies::SweptColliders& colliders, const Particles& particles,
                   double seconds);

  /// At `s` in (0, 1] of the frame: every free particle nearer than the offset is put at the offset, and its velocity
  /// loses its normal part: x += (offset - d) n, v -= (v . n) n [INF585 report 2021, collisions]. Colliders in rising
  /// order, one after the other. `pinned` has one entry a particle; pinned ones are left alone. `particles` are those
  /// of begin_frame, moved on.
  void respond(proxies::CollisionQuery& query, double s, std::span<const std::uint8_t> pinned, Particles& particles);

  const ContactCounts& counts() const { return counts_; }

private:
  void find_candidates(proxies::CollisionQuery& query, const Particles& particles);

  double offset_ = 0.0;
  double margin_ = 0.0; ///< m a particle may go before candidates are found anew
  proxies::SweptColliders colliders_;
  std::vector<proxies::Capsule> placed_, placed_before_;
  proxies::Candidates candidates_;
  std::vector<double> wake_;                              ///< per candidate pair: travelled sum at which it may touch
  std::vector<double> particle_travel_, collider_travel_; ///< m since the candidates were found
  std::vector<Vec3> seen_at_;                             ///< where each particle was when it last reported its travel
  ContactCounts counts_;
};

} // namespace tutu::cloth
