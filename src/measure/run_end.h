// What a run ended in that no exit status tells: threads far too long, cloth deep in the body. Everything that runs
// cloth says it last of all.
#pragma once

#include "proxies/collider.h"
#include "src/measure/cloth_depths.h"
#include "src/run/session.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tutu::app {

/// Strain. No cloth is twice as long as it was cut: such a thread is torn in all but name.
inline constexpr double k_most_longer = 1.0;
/// m. Cloth that is deeper in the body has gone through it, whatever the rest of its figures.
inline constexpr double k_most_depth = 0.020;

/// The deepest point of a garment's surface.
struct DeepestPoint {
  double depth = 0.0; ///< m; 0: nothing is inside
  int particle = -1;  ///< by it, free
};
DeepestPoint deepest_of(const ClothDepths& depths);

/// Which proxies a place lies by, in words: "between A and B" where the two nearest face each other across it, else "by
/// A"; "" farther than k_by from all. `proxies`: in the order of the colliders.
std::string place_among(const Vec3& place, std::span<const proxies::Capsule> colliders,
                        const std::vector<proxies::Proxy>& proxies);
inline constexpr double k_by = 0.05; ///< m

/// A garment as a run left it.
struct GarmentEnd {
  std::string garment;
  cloth::LongestThread longest;
  std::optional<DeepestPoint> in_proxies, in_body; ///< where that was measured
  std::string longest_at = {};                     ///< place_among(), of its middle; "" where that was not asked
};

struct RunEnd {
  std::vector<GarmentEnd> garments;

  /// One sentence on what is beyond k_most_longer or k_most_depth; "" where nothing is.
  std::string warning() const;
  /// A row a garment, and the warning (null without one).
  nlohmann::json json() const;
};

/// The garments of a session as they are now, in what they collide with and, where `body` is there, in it, which is
/// posed as the session's joints are. `probes`: one a garment. Of a run that failed or was stopped threads alone:
/// colliders are a frame ahead of the cloth.
RunEnd end_of(const Session& session, std::span<const ClothProbe> probes, const proxies::BodyMesh* body);

} // namespace tutu::app
