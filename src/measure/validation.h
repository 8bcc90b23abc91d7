// A scene's proxies, and its cloth, against the true body over the motion.
#pragma once

#include "proxies/validate/error_figures.h"
#include "proxies/validate/validate.h"
#include "src/measure/crossings.h"
#include "src/measure/run_end.h"
#include "src/run/scene.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

struct ValidationOptions {
  int every = 1;           ///< frames from one that is measured to the next
  int samples = 20'000;    ///< on the skin, about; the proxies get a fifth of them
  int threads = 1;         ///< frames are independent
  double tolerance = 0.01; ///< m, for the coverage
};

/// Skin out of proxies, proxies out of the skin: of all samples of all frames, area-weighted; negative errors (under
/// the other's surface) count as 0. m.
struct ErrorPair {
  proxies::ErrorFigures under, over;
};

/// The whole body, or the part of it that garments can reach.
struct WholeErrors {
  ErrorPair figures;
  proxies::BoundedMax under, over; ///< the greatest of all points of all frames, not only of samples
  double coverage = 0.0;           ///< share of the skin that sticks out by no more than the tolerance
  double skin_share = 0.0;         ///< of the skin's area that this is about, mean over the frames
};

struct GroupErrors {
  std::string name, joint; ///< joint: of a proxy, the one that carries most of it
  ErrorPair figures;
  double skin_share = 0.0; ///< of the skin's area; of a proxy, of the skin that is nearest to it
};

/// Where cloth goes through what, in one frame or over all of them.
template <class Count> struct ClothCrossings {
  struct OfGarment {
    Count body, proxies, itself;
  };
  std::vector<OfGarment> garments; ///< in their order
  Count each_other;                ///< between two garments, each pair once
};

struct FrameReport {
  int frame = 0;
  double time = 0.0; ///< s
  ErrorPair figures;
  proxies::BoundedMax under, over;
  double coverage = 0.0;
  std::vector<int> collisions, inside; ///< proxies that meet the mesh; those of them wholly inside the body
  std::optional<ClothDepths> cloth;    ///< with particle_depths empty
  ClothCrossings<proxies::SurfaceCrossings> crossings; ///< with `cloth`
};

struct ClothReport {
  DepthCount particles, edges, triangles;
  double surface = 0.0;          ///< m, as ClothDepths::surface
  double particles_p99 = 0.0;    ///< m
  std::vector<int> worst_frames; ///< indices into Validation::frames, the deepest first
  RunEnd end;                    ///< after the last frame that was measured
  ClothCrossings<CrossingTally> crossings;
};

struct Validation {
  ValidationOptions options;
  proxies::MeshCensus census;
  std::string skinning = "linear blend skinning";
  int skin_samples = 0;
  double buried_share = 0.0; ///< of the mesh's area: inside the body in the bind pose, left out
  WholeErrors whole;
  std::optional<WholeErrors> in_reach; ///< with garments
  GroupErrors core;                    ///< all but head, hands and feet: what few proxies can be asked to follow
  std::vector<GroupErrors> proxies, joints, regions; ///< proxies in their order, joints that have skin, regions
  double body_volume = 0.0, proxies_volume = 0.0;    ///< m3, mean over the frames
  double only_body_volume = 0.0, only_proxies_volume = 0.0;
  std::vector<FrameReport> frames;
  std::vector<int> worst_frames; ///< indices into `frames`, the worst first, each some way from those before
  std::optional<ClothReport> cloth;
  std::optional<std::string> cloth_failure; ///< why the garments could not be carried to the end
  double seconds = 0.0;                     ///< of wall time
  bool stopped = false;                     ///< by `progress`: what is here is of fewer frames

  double volume_ratio() const { return body_volume > 0.0 ? proxies_volume / body_volume : 0.0; }
  double hausdorff() const { return std::max(whole.under.value, whole.over.value); }
  double hausdorff_bound() const { return std::max(whole.under.bound, whole.over.bound); }
};

/// How many frames validate() measures.
int frames_to_measure(const Scene& scene, int every);

/// How bad a frame is, m: the larger of the two p95.
double badness(const FrameReport& frame);

/// Measures every `every`th frame of the motion from its start. `cloth_start`: the garments' draped positions, to
/// simulate them too; none leaves them out. `progress(done, total)` is called now and then; returning false stops. The
/// figures are the same for any number of threads. Throws InputError on a scene without proxies or with a mesh that has
/// no sides.
Validation validate(const Scene& scene, const ValidationOptions& options,
                    const std::optional<GarmentPositions>& cloth_start, const std::function<bool(int, int)>& progress);

} // namespace tutu::app
