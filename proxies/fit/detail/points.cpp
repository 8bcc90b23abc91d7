#include "proxies/fit/detail/points.h"

#include "proxies/body/winding.h"
#include "rig/strong_poses.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <stdexcept>

namespace tutu::proxies::fit {
namespace {

/// A point this far off the skin and still inside the body is where skin folds on itself.
constexpr double k_off_skin = 0.002; // m
constexpr double k_buried = 0.6;     // winding number there: above 1/2, so that an open rim is not taken for it

struct Place {
  std::uint32_t triangle = 0;
  std::array<float, 3> weights = {};
};

Vec3 on_triangle(const Place& place, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<float, 3>& w = place.weights;
  return static_cast<double>(w[0]) * a + static_cast<double>(w[1]) * b + static_cast<double>(w[2]) * c;
}

/// Where skin vertices are in one pose, in double.
std::vector<Vec3> skinned(const rig::Character& character, std::span<const Transform> pose,
                          std::vector<Vec3>& normals) {
  std::vector<Vec3> positions(character.mesh.positions.size());
  normals.resize(positions.size());
  rig::skin_vertices_reference(character.mesh, character.skin, pose, positions, normals);
  return positions;
}

int main_joint_of(const std::map<int, float>& weight_of) {
  const auto lighter = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::max_element(weight_of.begin(), weight_of.end(), lighter)->first;
}

std::map<int, float> joint_weights(const rig::Character& character, const rig::Triangle& triangle,
                                   const std::array<float, 3>& weights) {
  std::map<int, float> weight_of;
  const rig::Skin& skin = character.skin;
  for (int corner = 0; corner < 3; ++corner) {
    const std::size_t first = static_cast<std::size_t>(triangle[corner]) * skin.influences;
    for (int k = 0; k < skin.influences; ++k)
      weight_of[skin.slot_joint[skin.slots[first + k]]] += weights[corner] * skin.weights[first + k];
  }
  return weight_of;
}

SkinPoint skin_point(const rig::Character& character, const Place& place, const std::vector<Vec3>& rest) {
  SkinPoint point;
  const rig::Triangle& t = character.mesh.triangles[place.triangle];
  point.rest = on_triangle(place, rest[t[0]], rest[t[1]], rest[t[2]]);
  point.normal = (rest[t[1]] - rest[t[0]]).cross(rest[t[2]] - rest[t[0]]).normalized();
  const std::map<int, float> weight_of = joint_weights(character, t, place.weights);
  std::vector<std::pair<float, int>> falling;
  for (const auto& [joint, weight] : weight_of) falling.emplace_back(-weight, joint);
  std::sort(falling.begin(), falling.end());
  for (std::size_t k = 0; k < std::min<std::size_t>(4, falling.size()); ++k) {
    point.joints[k] = falling[k].second;
    point.weights[k] = -falling[k].first;
  }
  point.main_joint = main_joint_of(weight_of);
  return point;
}

/// `count` points at even steps of the area, each at a random place of its step and of its triangle.
std::vector<Place> places_by_area(const std::vector<double>& areas, int count, std::uint32_t seed) {
  const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<Place> places;
  double reached = 0.0;
  std::size_t triangle = 0;
  for (int i = 0; i < count; ++i) {
    const double at = total * (i + uniform()) / count;
    while (triangle + 1 < areas.size() && reached + areas[triangle] < at) reached += areas[triangle++];
    const double root = std::sqrt(uniform()), v = uniform();
    places.push_back(
        {static_cast<std::uint32_t>(triangle),
         {static_cast<float>(1.0 - root), static_cast<float>(root * (1.0 - v)), static_cast<float>(root * v)}});
  }
  return places;
}

/// Splits at the middle of the longest extent until k_lanes fit: neighbours come to stand together.
void group(std::vector<int>& order, int first, int last, const std::vector<SkinPoint>& skin,
           std::vector<std::pair<int, int>>& groups) {
  if (last - first <= k_lanes) {
    if (last > first) groups.emplace_back(first, last);
    return;
  }
  Eigen::AlignedBox3d box;
  for (int i = first; i < last; ++i) box.extend(skin[order[i]].rest);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  // Whole blocks on the left, so that few lanes stay empty.
  const int half = first + std::max(1, ((last - first) / 2 + k_lanes / 2) / k_lanes) * k_lanes;
  std::nth_element(order.begin() + first, order.begin() + half, order.begin() + last,
                   [&](int a, int b) { return std::pair(skin[a].rest[axis], a) < std::pair(skin[b].rest[axis], b); });
  group(order, first, half, skin, groups);
  group(order, half, last, skin, groups);
}

} // namespace

int main_joint_of(const rig::Character& character, const rig::Triangle& triangle) {
  return main_joint_of(joint_weights(character, triangle, {1.0f / 3, 1.0f / 3, 1.0f / 3}));
}

void PointBlocks::add(int pose_index, std::span<const Vec3f> positions, std::span<const float> weights,
                      std::span<const int> points) {
  Vec3f low = positions[0], high = positions[0];
  for (const Vec3f& p : positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3f middle = 0.5f * (low + high);
  float reach = 0.0f;
  for (const Vec3f& p : positions) reach = std::max(reach, (p - middle).norm());
  for (int lane = 0; lane < k_lanes; ++lane) {
    const std::size_t from = lane < static_cast<int>(positions.size()) ? lane : 0;
    x.push_back(positions[from].x());
    y.push_back(positions[from].y());
    z.push_back(positions[from].z());
    weight.push_back(lane < static_cast<int>(positions.size()) ? weights[from] : 0.0f);
    point.push_back(points[from]);
  }
  pose.push_back(pose_index);
  centre.push_back(middle);
  radius.push_back(reach);
}

FitPoints sample_skin(const rig::Character& character, const std::vector<std::vector<Transform>>& poses,
                      FitRegion region, int count, std::uint32_t seed) {
  const std::vector<rig::Triangle>& triangles = character.mesh.triangles;
  std::vector<Vec3> normals;
  const std::vector<Vec3> rest = skinned(character, rig::rest_model(character.skeleton), normals);
  const std::vector<rig::BodyPart> parts = rig::body_parts(character.skeleton);
  std::vector<double> areas(triangles.size());
  double whole = 0.0;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    areas[t] = triangle_area(rest[a], rest[b], rest[c]);
    whole += areas[t];
    if (region == FitRegion::garment && parts[main_joint_of(character, triangles[t])] != rig::BodyPart::garment)
      areas[t] = 0.0;
  }
  if (!(whole > 0.0) || !std::isfinite(whole)) throw std::invalid_argument("a mesh without area");
  if (!(std::accumulate(areas.begin(), areas.end(), 0.0) > 0.0))
    throw std::invalid_argument("no skin but that of head, hands and toes");

  FitPoints result;
  const std::vector<Place> places = places_by_area(areas, count, seed);
  for (const Place& place : places) result.skin.push_back(skin_point(character, place, rest));
  std::vector<int> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::pair<int, int>> groups;
  group(order, 0, count, result.skin, groups);

  const std::vector<rig::Triangle> together = neighbours_together(rest, triangles);
  double total = 0.0;
  for (int p = 0; p < static_cast<int>(poses.size()); ++p) {
    const std::vector<Vec3> posed = skinned(character, poses[p], normals);
    const Winding winding(posed, together);
    for (const auto& [first, last] : groups) {
      std::vector<Vec3f> at;
      std::vector<float> weights;
      std::vector<int> points(order.begin() + first, order.begin() + last);
      for (const int i : points) {
        const rig::Triangle& t = triangles[places[i].triangle];
        const Vec3 position = on_triangle(places[i], posed[t[0]], posed[t[1]], posed[t[2]]);
        const Vec3 normal = (posed[t[1]] - posed[t[0]]).cross(posed[t[2]] - posed[t[0]]).normalized();
        at.push_back(position.cast<float>());
        weights.push_back(winding.at(position + k_off_skin * normal) > k_buried ? 0.0f : 1.0f);
        total += static_cast<double>(weights.back());
      }
      result.blocks.add(p, at, weights, points);
    }
  }
  if (total > 0.0)
    for (float& w : result.blocks.weight) w = static_cast<float>(static_cast<double>(w) / total);
  return result;
}

SkinCloud skin_cloud(const rig::Character& character, const std::vector<std::vector<Transform>>& poses, int count) {
  const std::vector<rig::Triangle>& triangles = character.mesh.triangles;
  std::vector<Vec3> normals;
  const std::vector<Vec3> rest = skinned(character, rig::rest_model(character.skeleton), normals);
  std::vector<double> areas;
  for (const auto& [a, b, c] : triangles) areas.push_back(triangle_area(rest[a], rest[b], rest[c]));
  const std::vector<Place> places = places_by_area(areas, count, 3);
  SkinCloud cloud;
  for (const auto& pose : poses) {
    const std::vector<Vec3> posed = skinned(character, pose, normals);
    std::vector<Vec3f>&at = cloud.positions.emplace_back(), &up = cloud.normals.emplace_back();
    for (const Place& place : places) {
      const auto& [a, b, c] = triangles[place.triangle];
      at.push_back(on_triangle(place, posed[a], posed[b], posed[c]).cast<float>());
      up.push_back((posed[b] - posed[a]).cross(posed[c] - posed[a]).normalized().cast<float>());
    }
  }
  return cloud;
}

std::vector<int> most_different(const std::vector<std::vector<Transform>>& poses, int count) {
  const int n = static_cast<int>(poses.size());
  std::vector<int> chosen = {0};
  // Mean squared distance of the joints' origins, with the poses laid on each other at the joints' mean.
  std::vector<Vec3> means;
  for (const auto& pose : poses) {
    Vec3 mean = Vec3::Zero();
    for (const Transform& t : pose) mean += t.translation;
    means.push_back(mean / static_cast<double>(pose.size()));
  }
  std::vector<double> nearest(n, std::numeric_limits<double>::infinity());
  while (static_cast<int>(chosen.size()) < std::min(count, n)) {
    int farthest = 0;
    for (int p = 0; p < n; ++p) {
      double apart = 0.0;
      for (std::size_t j = 0; j < poses[p].size(); ++j) {
        const Vec3 there = poses[chosen.back()][j].translation - means[chosen.back()];
        apart += (poses[p][j].translation - means[p] - there).squaredNorm();
      }
      nearest[p] = std::min(nearest[p], apart);
      if (nearest[p] > nearest[farthest]) farthest = p;
    }
    if (!(nearest[farthest] > 0.0)) break;
    chosen.push_back(farthest);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

} // namespace tutu::proxies::fit
