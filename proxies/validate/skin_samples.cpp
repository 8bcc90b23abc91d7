#include "proxies/validate/skin_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tutu::proxies {
namespace {

constexpr int k_most_parts = 1000; // a side: what a count of 1e6 asks of a single triangle

std::array<Vec3, 3> corners_of(const rig::Triangle& t, std::span<const Vec3f> positions) {
  return {positions[t[0]].cast<double>(), positions[t[1]].cast<double>(), positions[t[2]].cast<double>()};
}

/// How many parts a side needs so that no part has a side longer than `spacing`.
int parts_for(double longest_side, double spacing) {
  return static_cast<int>(std::clamp(std::ceil(longest_side / spacing), 1.0, double{k_most_parts}));
}

} // namespace

SkinSamples sample_skin(std::span<const Vec3f> bind_positions, std::span<const rig::Triangle> triangles, int count,
                        std::span<const char> keep) {
  const auto kept = [&](std::size_t t) { return keep.empty() || keep[t]; };
  std::vector<double> areas(triangles.size(), 0.0), sides(triangles.size(), 0.0);
  double longest = 0.0, whole = 0.0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!kept(t)) continue;
    const auto [a, b, c] = corners_of(triangles[t], bind_positions);
    areas[t] = triangle_area(a, b, c);
    sides[t] = std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    whole += areas[t];
    longest = std::max(longest, sides[t]);
  }
  SkinSamples result;
  result.parts.assign(triangles.size(), 0);
  if (!(whole > 0.0)) return result;

  const auto samples_at = [&](double spacing) {
    std::int64_t sum = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (kept(t)) sum += std::int64_t{parts_for(sides[t], spacing)} * parts_for(sides[t], spacing);
    return sum;
  };
  double fine = longest / k_most_parts, coarse = longest; // spacing: as coarse as still gives `count`
  constexpr int k_halvings = 40;
  if (samples_at(coarse) < count)
    for (int k = 0; k < k_halvings; ++k) {
      const double middle = 0.5 * (fine + coarse);
      (samples_at(middle) >= count ? fine : coarse) = middle;
    }
  else fine = coarse;

  result.samples.reserve(static_cast<std::size_t>(samples_at(fine)));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!kept(t)) continue;
    const int k = parts_for(sides[t], fine);
    result.parts[t] = k;
    const double area = areas[t] / (double(k) * k), third = 1.0 / (3.0 * k);
    const auto add = [&](int i, int j) { // in thirds of a part's side
      const double u = i * third, v = j * third;
      result.samples.push_back({static_cast<int>(t), Vec3(1.0 - u - v, u, v), area});
      result.area += area;
    };
    for (int i = 0; i < k; ++i)
      for (int j = 0; i + j < k; ++j) {
        add(3 * i + 1, 3 * j + 1);
        if (i + j + 1 < k) add(3 * i + 2, 3 * j + 2);
      }
  }
  return result;
}

double cell_radius(const Vec3& a, const Vec3& b, const Vec3& c, int parts) {
  const Vec3 middle = (a + b + c) / 3.0;
  return std::sqrt(std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()})) /
         parts;
}

} // namespace tutu::proxies
