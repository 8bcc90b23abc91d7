// Where cloth goes through proxies, the true body, itself and other cloth: counted exactly, frame by frame, for cloth
// of any topology.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/body/body_mesh.h"
#include "proxies/crossing/surface_crossings.h"

#include <span>
#include <vector>

namespace tutu::app {

/// One garment in motion, as a surface. Pinned particles are placed, and so are proxies and body: curves where cloth
/// between pinned particles meets those are counted apart, as SurfaceCrossings::placed.
class GarmentSurface {
public:
  /// At rest.
  explicit GarmentSurface(const cloth::Garment& garment);

  void move(std::span<const Vec3> positions); ///< of all particles, m

  const proxies::CrossingSurface& surface() const { return surface_; }

  /// With the surfaces of capsules and spheres, as polyhedra up to 0.4 % of their radius thinner than they are. Those
  /// that no triangle reaches into are not looked at any closer.
  proxies::SurfaceCrossings with(std::span<const proxies::Capsule> capsules) const;

  /// With itself. Layers that lie exactly on each other are told apart by the rest shape; the lips of a slit that is
  /// shut to the last bit are not, and may count.
  proxies::SurfaceCrossings with_itself() const;

private:
  bool reaches_into(const proxies::Capsule& capsule) const;

  std::vector<Vec3> rest_, positions_;
  std::vector<rig::Triangle> triangles_;
  proxies::CrossingSurface surface_, parted_;
};

/// The body's skin. Vertices that stand at one place in the pose it has now, the bind pose, are one.
proxies::CrossingSurface skin_surface(const proxies::BodyMesh& body);

/// One kind of crossing over the frames of a run.
struct CrossingTally {
  int frames = 0;          ///< with any
  int worst = 0;           ///< in one frame
  int worst_frame = -1;    ///< the first with as many; -1 without any
  std::int64_t total = 0;  ///< summed over frames: what lasts counts in each
  std::int64_t placed = 0; ///< SurfaceCrossings::placed, summed over frames, in none of the others

  void add(int frame, const proxies::SurfaceCrossings& found);
};

} // namespace tutu::app
