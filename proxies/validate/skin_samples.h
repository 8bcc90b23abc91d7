// Fixed points on the skin: the same material points in every pose, each the middle of a cell that is known.
#pragma once

#include "rig/mesh.h"

#include <span>
#include <vector>

namespace tutu::proxies {

/// Triangles cut into equal parts, a sample in the middle of each: area-weighted, stratified, nothing random. A
/// triangle of k^2 parts has its sides cut in k; all its parts are congruent, half of them turned round. They stay so
/// when the triangle is posed, for skinning moves corners and the surface between them is flat.
struct SkinSamples {
  struct Sample {
    int triangle = 0;
    Vec3 weights = Vec3::Zero(); ///< barycentric, of the middle of its part
    double area = 0.0;           ///< of the part in the bind pose, m2: the sample's weight in every statistic
  };
  std::vector<Sample> samples; ///< by triangle
  std::vector<int> parts;      ///< [triangle] k: its sides are cut in so many; 0 where it is left out
  double area = 0.0;           ///< of all parts, m2

  std::size_t size() const { return samples.size(); }
};

/// About `count` samples, and at least one in each triangle, also in one without area (it weighs nothing, but a pose
/// may open it); triangles where `keep` is 0 get none (an empty span keeps all). Finer where the mesh is coarse: all
/// parts get about the same size. No sample at all where nothing has an area.
SkinSamples sample_skin(std::span<const Vec3f> bind_positions, std::span<const rig::Triangle> triangles, int count,
                        std::span<const char> keep = {});

/// The greatest distance of a point of the posed triangle's part from its sample, m: from the centroid to the farthest
/// corner.
double cell_radius(const Vec3& a, const Vec3& b, const Vec3& c, int parts);

} // namespace tutu::proxies
