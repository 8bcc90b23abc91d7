// How far the skin is from the proxies at one pose, in figures: fast enough for every state of a drag.
#pragma once

#include "proxies/shapes.h"
#include "proxies/validate/error_figures.h"
#include "proxies/validate/skin_samples.h"
#include "rig/mesh.h"

#include <span>
#include <vector>

namespace tutu::app {

/// Over skin samples, weighted by their area at rest, m. `under`: how far the skin sticks out of the proxies. `over`:
/// how deep it is in them. What the colours of the proxy error show, as figures.
struct ProxyFigures {
  proxies::ErrorFigures under, over;
  double rms = 0.0; ///< of both together
  int samples = 0;
};

/// A sample of the posed skin: world, m; its area at rest, m2.
struct SkinSpot {
  Vec3 place;
  double area;
};

class ProxyMeasure {
public:
  static constexpr int k_samples = 4000;

  /// The mesh must outlive it. Skin that nobody sees, inside the body as it is bound, gets no samples; where the mesh
  /// has no sides (BodyMesh) all of it counts.
  explicit ProxyMeasure(const rig::Mesh& mesh, int samples = k_samples);

  void pose(std::span<const Vec3f> positions); ///< of all vertices, world, m
  std::span<const SkinSpot> spots() const { return spots_; }

  /// Of all skin from the union of `shapes`, and of the part of it that `one` is nearest to. Nothing without shapes.
  struct Result {
    ProxyFigures whole, one;
  };
  Result measure(std::span<const proxies::Capsule> shapes, int one) const;

private:
  const rig::Mesh* mesh_;
  proxies::SkinSamples samples_;
  std::vector<SkinSpot> spots_;
};

} // namespace tutu::app
