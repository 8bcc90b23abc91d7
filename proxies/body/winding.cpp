#include "proxies/body/winding.h"

#include "proxies/body/detail/solid_angle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tutu::proxies {
namespace {

constexpr int k_group = 16;   // triangles
constexpr int k_large = 16;   // groups
constexpr float k_far = 1.8f; // a group is far from this many of its radii on

} // namespace

std::vector<rig::Triangle> neighbours_together(std::span<const Vec3> positions,
                                               std::span<const rig::Triangle> triangles) {
  std::vector<rig::Triangle> order(triangles.begin(), triangles.end());
  const auto middle = [&](const rig::Triangle& t) { return Vec3(positions[t[0]] + positions[t[1]] + positions[t[2]]); };
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, order.size()}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    if (last - first <= k_group) continue;
    Eigen::AlignedBox3d box;
    for (std::size_t t = first; t < last; ++t) box.extend(middle(order[t]));
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::size_t half = first + ((last - first) / 2 + k_group - 1) / k_group * k_group;
    std::nth_element(
        order.begin() + static_cast<std::ptrdiff_t>(first), order.begin() + static_cast<std::ptrdiff_t>(half),
        order.begin() + static_cast<std::ptrdiff_t>(last), [&](const rig::Triangle& s, const rig::Triangle& t) {
          return std::pair(middle(s)[axis], s) < std::pair(middle(t)[axis], t);
        });
    open.emplace_back(first, half);
    open.emplace_back(half, last);
  }
  return order;
}

void Winding::Groups::add(std::span<const Vec3> positions, std::span<const rig::Triangle> run) {
  Vec3 normal = Vec3::Zero(), weighted = Vec3::Zero();
  double area = 0.0;
  for (const auto& [i, j, k] : run) {
    const Vec3 &a = positions[i], &b = positions[j], &c = positions[k];
    const Vec3 n = 0.5 * (b - a).cross(c - a);
    normal += n;
    area += n.norm();
    weighted += n.norm() * (a + b + c) / 3.0;
  }
  const Vec3 centre = area > 0.0 ? Vec3(weighted / area) : positions[run[0][0]];
  double reach2 = 0.0;
  for (const rig::Triangle& t : run)
    for (const std::uint32_t corner : t) reach2 = std::max(reach2, (positions[corner] - centre).squaredNorm());
  x.push_back(static_cast<float>(centre.x()));
  y.push_back(static_cast<float>(centre.y()));
  z.push_back(static_cast<float>(centre.z()));
  nx.push_back(static_cast<float>(normal.x()));
  ny.push_back(static_cast<float>(normal.y()));
  nz.push_back(static_cast<float>(normal.z()));
  near2.push_back(static_cast<float>(reach2) * k_far * k_far);
}

template <typename Near>
double Winding::Groups::solid_angle(const Vec3& point, int first, int last, const Near& near) const {
  const float px = static_cast<float>(point.x()), py = static_cast<float>(point.y()),
              pz = static_cast<float>(point.z());
  double sum = 0.0;
  for (; first < last; first += k_large) { // in chunks whose loop becomes vectors
    const int n = std::min(k_large, last - first);
    float dipole[k_large], closer[k_large];
    for (int k = 0; k < n; ++k) {
      const int g = first + k;
      const float dx = x[g] - px, dy = y[g] - py, dz = z[g] - pz;
      const float d2 = dx * dx + dy * dy + dz * dz;
      dipole[k] = (dx * nx[g] + dy * ny[g] + dz * nz[g]) / (d2 * std::sqrt(d2));
      closer[k] = near2[g] - d2;
    }
    for (int k = 0; k < n; ++k) {
      if (closer[k] < 0.0f) sum += static_cast<double>(dipole[k]);
      else sum += near(first + k);
    }
  }
  return sum;
}

Winding::Winding(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles)
    : positions_(positions), triangles_(triangles) {
  const auto cut = [&](Groups& groups, std::size_t length) {
    for (std::size_t first = 0; first < triangles.size(); first += length)
      groups.add(positions, triangles.subspan(first, std::min(length, triangles.size() - first)));
  };
  cut(small_, k_group);
  cut(large_, static_cast<std::size_t>(k_group) * k_large);
}

double Winding::at(const Vec3& point) const {
  const auto exact = [&](int group) {
    double sum = 0.0;
    const std::size_t from = static_cast<std::size_t>(group) * k_group;
    for (std::size_t t = from; t < std::min(triangles_.size(), from + k_group); ++t) {
      const HalfSolidAngle half = half_solid_angle(point, positions_[triangles_[t][0]], positions_[triangles_[t][1]],
                                                   positions_[triangles_[t][2]]);
      sum += 2.0 * std::atan2(half.y, half.x);
    }
    return sum;
  };
  const int small = static_cast<int>(small_.x.size());
  const auto open = [&](int group) {
    return small_.solid_angle(point, group * k_large, std::min(small, (group + 1) * k_large), exact);
  };
  return large_.solid_angle(point, 0, static_cast<int>(large_.x.size()), open) / (4.0 * std::numbers::pi);
}

} // namespace tutu::proxies
