// How far the posed proxies are from the posed body: one frame.
//
//   under: the skin sticks out of the proxies. Skin samples against the union of the proxies, closed form.
//   over:  the proxies stick out of the skin. Samples of the proxies' outer surface against the body mesh.
//
// Both distances are 1-Lipschitz, so a sample whose cell reaches r around it speaks for its cell up to r: the greatest
// error of all points, not only of samples, is known between a value that was found and a bound. (Distance from a
// single proxy is convex besides: skin that one proxy stands for is bounded by its corners.)
#pragma once

#include "proxies/body/body_mesh.h"
#include "proxies/shapes.h"
#include "proxies/validate/skin_samples.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tutu::proxies {

/// The greatest error over a surface, m: no point has more than `bound`, and one has `value`. Both >= 0.
struct BoundedMax {
  double value = 0.0, bound = 0.0;
};

/// How much work a frame is worth.
struct ValidationEffort {
  int surface_samples = 4000; ///< on the proxies, buried ones included
  /// The bound is narrowed by halving the cells that could hold the greatest error, until it is this close (m) to the
  /// value found, or that many distances were asked for.
  double skin_gap = 1e-4, surface_gap = 5e-4; ///< asking the mesh costs far more than asking capsules
  int skin_refinements = 20'000, surface_refinements = 4'000;
};

/// A sample of the proxies' outer surface.
struct SurfaceError {
  int collider = 0;
  double area = 0.0;     ///< of its cell, m2
  double distance = 0.0; ///< m, signed, from the body: > 0 sticks out
  bool in_reach = true;
};

struct FrameErrors {
  std::vector<double> skin;                ///< [sample] m, signed, from the union of the colliders: > 0 sticks out
  std::vector<int> nearest;                ///< [sample] the collider it is from
  std::vector<std::uint8_t> skin_in_reach; ///< [sample]
  std::vector<SurfaceError> surface;
  BoundedMax under, over;                   ///< over everything,
  BoundedMax under_in_reach, over_in_reach; ///< and over what `reach` covers
  std::vector<int> collisions;              ///< colliders that meet the mesh, exactly (FCL), rising
  std::vector<int> inside;                  ///< those of them that are wholly inside the body
};

/// Measures `colliders` against `body`, both posed, world space. `reach`: balls; nothing in reach is without them only
/// where `everything_in_reach` says so. `errors` is written over; its memory is used again.
void measure_frame(const BodyMesh& body, const SkinSamples& samples, std::span<const Capsule> colliders,
                   std::span<const Capsule> reach, bool everything_in_reach, const ValidationEffort& effort,
                   FrameErrors& errors);

/// How many of the points of a low-discrepancy sequence [Roberts 2018, R3] in the box around both fell where. The
/// `points` from number `first` on: further frames go on where the last one stopped.
struct VolumeCount {
  std::int64_t points = 0, body = 0, proxies = 0, both = 0;
  double box = 0.0; ///< m3

  double body_volume() const { return box * static_cast<double>(body) / static_cast<double>(points); }
  double proxies_volume() const { return box * static_cast<double>(proxies) / static_cast<double>(points); }
};
VolumeCount count_volume(const BodyMesh& body, std::span<const Capsule> colliders, std::int64_t first, int points);

/// [triangle] 1 for skin that can be seen, 0 for what is inside the body as it is posed: inner shells, and parts of
/// overlapping ones.
std::vector<char> outer_triangles(const BodyMesh& body);

} // namespace tutu::proxies
