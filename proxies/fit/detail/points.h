// Points of the skin over poses, in blocks of neighbours: what a fit looks at.
#pragma once

#include "proxies/fit/detail/kernel.h"
#include "proxies/fit/fit.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tutu::proxies::fit {

/// Joints and weights of one point of the skin, falling; unused ones have weight 0.
struct SkinPoint {
  Vec3 rest = Vec3::Zero(), normal = Vec3::UnitY(); ///< model space at rest
  std::array<int, 4> joints = {};
  std::array<float, 4> weights = {};
  int main_joint = 0; ///< with the largest weight
};

/// Points of several poses as blocks, structure of arrays. A block is 16 points of one pose that lie near each other;
/// where there are fewer the last lanes repeat the first with weight 0.
struct PointBlocks {
  std::vector<float> x, y, z, weight; ///< [block * k_lanes + lane]
  std::vector<int> point;             ///< of each lane: index of its SkinPoint
  std::vector<int> pose;              ///< [block], rising
  std::vector<Vec3f> centre;          ///< [block]
  std::vector<float> radius;          ///< [block]: all its points are within

  int block_count() const { return static_cast<int>(pose.size()); }
  std::size_t lane_count() const { return x.size(); }
  /// Appends a block; sizes the arrays. At most k_lanes entries.
  void add(int pose_index, std::span<const Vec3f> positions, std::span<const float> weights,
           std::span<const int> points);
};

/// The samples of a body.
struct FitPoints {
  std::vector<SkinPoint> skin;
  PointBlocks blocks; ///< weights sum to 1 over all poses
};

/// Area-weighted points of the region's skin: about `count`, stratified along the triangles' order, from the seed.
/// Throws std::invalid_argument on a mesh without area, or with none in the region.
FitPoints sample_skin(const rig::Character& character, const std::vector<std::vector<Transform>>& poses,
                      FitRegion region, int count, std::uint32_t seed);

/// The joint with most weight on a triangle.
int main_joint_of(const rig::Character& character, const rig::Triangle& triangle);

/// Points of the whole skin in each pose, without weights.
struct SkinCloud {
  std::vector<std::vector<Vec3f>> positions, normals; ///< [pose][point]
};
SkinCloud skin_cloud(const rig::Character& character, const std::vector<std::vector<Transform>>& poses, int count);

/// The `count` most different poses, the first among them, in rising order: farthest points, as seen by the joints.
std::vector<int> most_different(const std::vector<std::vector<Transform>>& poses, int count);

} // namespace tutu::proxies::fit
