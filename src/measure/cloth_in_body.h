// How deep cloth is inside the true body, whatever the proxies say.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/body/body_mesh.h"

#include <array>
#include <span>
#include <vector>

namespace tutu::app {

/// Of the particles, edges or triangles of all garments in one frame.
struct DepthCount {
  std::int64_t asked = 0;
  std::int64_t inside = 0; ///< deeper than k_inside_depth (run_stats.h)
  double deepest = 0.0;    ///< m

  void add(double depth);
  void add(const DepthCount& other);
};

struct ClothInBody {
  DepthCount particles;                ///< free ones
  DepthCount edges;                    ///< at their middle
  DepthCount triangles;                ///< at their centroid
  double deepest_of_triangles = 0.0;   ///< m, at any of the k_surface_samples points of a triangle (frame_metrics.h)
  std::vector<double> particle_depths; ///< m, >= 0, of each free particle

  void clear();
  double deepest() const;
};

/// One garment against a posed body. What is pinned is placed, not simulated: pinned particles do not count, and edges
/// and triangles only where a corner is free, of those no point of an edge whose ends are both pinned: how deep that
/// chord cuts into the body is a matter of where it was pinned. The garment must outlive it.
class ClothProbe {
public:
  explicit ClothProbe(const cloth::Garment& garment);

  /// Adds to `result`. `positions`: of all particles, world, m.
  void measure(const proxies::BodyMesh& body, std::span<const Vec3> positions, ClothInBody& result) const;

private:
  const cloth::Garment* garment_;
  std::vector<std::uint8_t> pinned_;
  std::vector<std::array<int, 2>> edges_; ///< with a free end
  double clear_ = 0.0; ///< m, the longest of them at rest: of a particle farther out no edge reaches the body
};

} // namespace tutu::app
