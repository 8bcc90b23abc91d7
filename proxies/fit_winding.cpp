#include "proxies/fit_winding.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tutu::proxies::fit {
namespace {

constexpr int k_group = 16;      // triangles
constexpr float k_far = 1.8f;    // a group is far from this many of its radii on

/// Signed solid angle of a triangle [van Oosterom and Strackee 1983, eq. 8].
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

} // namespace

std::vector<rig::Triangle> neighbours_together(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles) {
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
    std::nth_element(order.begin() + static_cast<std::ptrdiff_t>(first), order.begin() + static_cast<std::ptrdiff_t>(half),
                     order.begin() + static_cast<std::ptrdiff_t>(last), [&](const rig::Triangle& s, const rig::Triangle& t) {
                       return std::pair(middle(s)[axis], s) < std::pair(middle(t)[axis], t);
                     });
    open.emplace_back(first, half);
    open.emplace_back(half, last);
  }
  return order;
}

Winding::Winding(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles)
    : positions_(positions), triangles_(triangles) {
  for (std::size_t first = 0; first < triangles.size(); first += k_group) {
    const std::size_t last = std::min(triangles.size(), first + k_group);
    Vec3 normal = Vec3::Zero(), weighted = Vec3::Zero();
    double area = 0.0;
    for (std::size_t t = first; t < last; ++t) {
      const Vec3 &a = positions[triangles[t][0]], &b = positions[triangles[t][1]], &c = positions[triangles[t][2]];
      const Vec3 n = 0.5 * (b - a).cross(c - a);
      normal += n;
      area += n.norm();
      weighted += n.norm() * (a + b + c) / 3.0;
    }
    const Vec3 centre = area > 0.0 ? Vec3(weighted / area) : positions[triangles[first][0]];
    double reach2 = 0.0;
    for (std::size_t t = first; t < last; ++t)
      for (const std::uint32_t corner : triangles[t]) reach2 = std::max(reach2, (positions[corner] - centre).squaredNorm());
    x_.push_back(static_cast<float>(centre.x()));
    y_.push_back(static_cast<float>(centre.y()));
    z_.push_back(static_cast<float>(centre.z()));
    nx_.push_back(static_cast<float>(normal.x()));
    ny_.push_back(static_cast<float>(normal.y()));
    nz_.push_back(static_cast<float>(normal.z()));
    reach2_.push_back(static_cast<float>(reach2) * k_far * k_far);
  }
}

double Winding::at(const Vec3& point) const {
  const float px = static_cast<float>(point.x()), py = static_cast<float>(point.y()), pz = static_cast<float>(point.z());
  constexpr int k_chunk = 64;
  double sum = 0.0;
  const int groups = static_cast<int>(x_.size());
  for (int first = 0; first < groups; first += k_chunk) {
    const int n = std::min(k_chunk, groups - first);
    float far[k_chunk], near[k_chunk];
    for (int k = 0; k < n; ++k) {
      const int g = first + k;
      const float dx = x_[g] - px, dy = y_[g] - py, dz = z_[g] - pz;
      const float d2 = dx * dx + dy * dy + dz * dz;
      const float dipole = (dx * nx_[g] + dy * ny_[g] + dz * nz_[g]) / (d2 * std::sqrt(d2));
      near[k] = reach2_[g] - d2;
      far[k] = near[k] > 0.0f ? 0.0f : dipole;
    }
    for (int k = 0; k < n; ++k) {
      sum += static_cast<double>(far[k]);
      if (!(near[k] > 0.0f)) continue;
      const std::size_t from = static_cast<std::size_t>(first + k) * k_group;
      for (std::size_t t = from; t < std::min(triangles_.size(), from + k_group); ++t)
        sum += solid_angle(positions_[triangles_[t][0]] - point, positions_[triangles_[t][1]] - point, positions_[triangles_[t][2]] - point);
    }
  }
  return sum / (4.0 * std::numbers::pi);
}

} // namespace tutu::proxies::fit
