// How good a state is: stretch, penetration, jitter. Plain double measurements, outside every timing.
#pragma once

#include "cloth/garment.h"
#include "cloth/particles.h"
#include "proxies/shapes.h"

#include <optional>
#include <span>
#include <vector>

namespace tutu::cloth {

/// Largest, mean and 99th percentile of some samples; all 0 when there are none.
struct Spread {
  double max = 0.0, p99 = 0.0, mean = 0.0;
};

/// The smallest sample that at least `share` of them do not exceed (nearest rank); 0 for no samples. Reorders
/// `samples`.
double percentile(std::vector<double>& samples, double share);
Spread spread(std::vector<double> samples);

/// |length / rest length - 1| of every structural spring.
std::vector<double> stretch_of(const Garment& garment, const Particles& particles);

/// Depth of every free particle below the nearest collider surface, m, >= 0, over all colliders, closed form.
std::vector<double> penetration_of(const Garment& garment, const Particles& particles,
                                   std::span<const proxies::Capsule> colliders,
                                   const std::optional<proxies::Plane>& ground);

/// Mean |x(f+1) - 2 x(f) + x(f-1)| / frame^2 over free particles, m/s2.
double jitter_of(const Garment& garment, std::span<const Vec3> before_last, std::span<const Vec3> last,
                 std::span<const Vec3> now, double frame_seconds);

} // namespace tutu::cloth
