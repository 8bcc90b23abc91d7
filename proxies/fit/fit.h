// Proxies that fit themselves: few capsules that follow a skinned body through many poses.
//
//   character + poses --fit_proxies--> proxies on joints, their error, and the curve count : error
//
// The skin is sampled by area, the same material points in every pose; points buried in another part of the body are
// left out where they are. Shapes are then grown one split at a time, where the error falls most, and refined by
// Levenberg-Marquardt on the signed distances of the points from the union of the posed shapes. An end of a capsule is
// a virtual skinned vertex (Anchor) with up to four joints. What lies left and right is one unit with one set of
// parameters, so that the result is as symmetric as the body.
//
// Lengths in m, distances negative inside. Same input gives the same bytes. One thread.
#pragma once

#include "proxies/collider.h"
#include "rig/character.h"

#include <functional>
#include <optional>
#include <vector>

namespace tutu::proxies {

enum class FitRegion {
  garment, ///< the body without head, hands and toes (rig::body_parts)
  body     ///< all of it
};

struct FitOptions {
  int count = 28;                  ///< shapes: a pair counts two. 1 to k_most_fit_shapes
  std::optional<double> max_error; ///< m: grow until p95 of both under and over is not above it; `count` is the limit
  std::optional<double> cover;     ///< m: no sample sticks out further than this
  double under_weight = 1.0;       ///< of skin that sticks out, squared, against proxies that do; > 0
  FitRegion region = FitRegion::garment;
  bool tapered = false;  ///< capsules may have two radii
  bool symmetric = true; ///< where the body is; false: never
  int samples = 3000;    ///< of the skin, in each pose
  int poses = 32;        ///< the most different ones of those given are fitted; all are measured
};
inline constexpr int k_most_fit_shapes = 256;

/// Spread of one-sided distances, m, >= 0: where the other surface is not overshot a sample counts 0.
struct FitSpread {
  double mean = 0.0, rms = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;
  double bound = 0.0; ///< no point of the surface is above this: the sampled value plus the radius of its cell
};

/// How far proxies are from the skin over poses. `under`: skin that sticks out of all proxies. `over`: surface of the
/// proxies that sticks out of the body. Only the region counts: skin of it that is not buried in the body in that pose,
/// and surface of proxies that is not inside another and whose nearest skin is of the region.
struct FitError {
  FitSpread under, over;
  int poses = 0;
  long skin_points = 0, proxy_points = 0;
};

/// One point of the curve count : error. Errors as the fit sees them, at its own samples, m.
struct FitCurvePoint {
  int count = 0;
  double under_p95 = 0.0, under_max = 0.0, over_p95 = 0.0, over_max = 0.0;
};

struct FitResult {
  std::vector<Proxy> proxies;
  std::vector<FitCurvePoint> curve; ///< rising counts, from the first layout to the result
  bool interrupted = false;         ///< the progress said stop; proxies are the best so far
  bool symmetric = false;           ///< left and right were fitted as one, at least in part
  bool met = true;                  ///< what was asked for (max_error, cover) is met at the fit's own samples
};

/// Called now and then with a share in [0, 1]; returning false ends the fit with the best so far.
using FitProgress = std::function<bool(double)>;

/// `poses`: model_from_joint of every joint, one vector a pose, at least one. Throws std::invalid_argument, in words
/// for the user, on options out of range, on a mesh without area, and on a region that no skin is in.
FitResult fit_proxies(const rig::Character& character, const std::vector<std::vector<Transform>>& poses,
                      const FitOptions& options, const FitProgress& progress = {});

/// Measures any proxies against the skin, at points of its own (`skin_points` a pose, other ones than a fit takes).
/// Throws std::invalid_argument as BodyMesh does on a mesh without sides, and as fit_proxies.
FitError measure_fit(const rig::Character& character, const std::vector<std::vector<Transform>>& poses,
                     const std::vector<Proxy>& proxies, FitRegion region, int skin_points = 6000,
                     const FitProgress& progress = {});

} // namespace tutu::proxies
