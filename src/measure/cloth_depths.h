// How deep cloth is inside what it should be outside of: the proxies it collides with, or the true body whatever the
// proxies say.
#pragma once

#include "cloth/metrics.h"
#include "proxies/body/body_mesh.h"
#include "proxies/motion/collider_set.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace tutu::app {

/// A particle counts as inside when it is deeper than this, m: above the rounding of a projection (1e-15), below any
/// depth that could be seen.
inline constexpr double k_inside_depth = 1e-6;

/// Points of a triangle that are asked: those whose barycentric coordinates are whole sixths, corners, centroid and
/// middles of edges among them.
inline constexpr int k_surface_samples = 28;

/// Of the particles, edges or triangles of all garments in one frame.
struct DepthCount {
  std::int64_t asked = 0;
  std::int64_t inside = 0;         ///< deeper than k_inside_depth
  double deepest = 0.0, sum = 0.0; ///< m

  void add(double depth);
  void add(const DepthCount& other);
  double mean() const { return asked > 0 ? sum / static_cast<double>(asked) : 0.0; }
};

struct ClothDepths {
  DepthCount particles;                ///< free ones
  DepthCount edges;                    ///< at their middle; in the body only
  DepthCount triangles;                ///< at their centroid
  double surface = 0.0;                ///< m, the deepest of all k_surface_samples points of triangles
  int surface_particle = -1;           ///< the free corner nearest to it, of its triangle; -1: nothing is inside
  std::vector<double> particle_depths; ///< m, >= 0, of each free particle

  void clear();
};

/// One garment against a posed body or proxies. What is pinned is placed, not simulated: pinned particles do not count,
/// and edges and triangles only where a corner is free, of those no point of an edge whose ends are both pinned: how
/// deep that chord cuts into the body is a matter of where it was pinned. The garment must outlive it.
///
/// Signed distance is 1-Lipschitz: points that therefore cannot be inside, or deeper than what was found, are passed
/// over, which changes nothing.
class ClothProbe {
public:
  explicit ClothProbe(const cloth::Garment& garment);

  /// Adds to `result`. `positions`: of all particles, world, m.
  void measure(const proxies::BodyMesh& body, std::span<const Vec3> positions, ClothDepths& result) const;
  /// The same, below the deepest of all proxies, the ground among them where there is one.
  void measure(std::span<const proxies::Capsule> proxies, const std::optional<proxies::Plane>& ground,
               std::span<const Vec3> positions, ClothDepths& result) const;
  /// Of those that are met, as they are at the frame's end.
  void measure(const proxies::SweptColliders& colliders, std::span<const Vec3> positions, ClothDepths& result) const;

  const cloth::MeasuredParts& parts() const { return parts_; }

private:
  template <class Surface>
  std::vector<double> measure_particles(const Surface& surface, std::span<const Vec3> positions,
                                        ClothDepths& result) const;
  template <class Surface>
  void measure_triangles(Surface& surface, std::span<const Vec3> positions, std::span<const double> distances,
                         ClothDepths& result) const;

  cloth::MeasuredParts parts_;
  std::vector<std::array<int, 2>> edges_; ///< with a free end
  double clear_ = 0.0; ///< m, the longest of them at rest: of a particle farther out no edge reaches the body
};

} // namespace tutu::app
