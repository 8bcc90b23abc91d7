#include "src/measure/crossings.h"

#include "proxies/crossing/capsule_surface.h"
#include "proxies/distance/feature_contact.h"
#include "proxies/motion/collider_motion.h"

#include <algorithm>
#include <numeric>

namespace tutu::app {
namespace {

/// Cloth a nanometre a metre towards its rest shape, that turned askew: layers that lie exactly on each other part as
/// they do at rest, and of folds along threads no edge meets another exactly. What is sewn stays together.
std::vector<Vec3> parted_layers(std::span<const Vec3> rest, std::span<const Vec3> positions) {
  constexpr double k_part = 1e-9;
  const Eigen::Matrix3d askew{{1.0, 0.382, -0.236}, {-0.382, 1.0, 0.618}, {0.236, -0.618, 1.0}};
  std::vector<Vec3> parted;
  parted.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) parted.push_back(positions[i] + k_part * (askew * rest[i]));
  return parted;
}

proxies::CrossingSurface surface_of(const cloth::Garment& garment, std::span<const Vec3> positions) {
  std::vector<std::pair<int, int>> sewn;
  for (const cloth::Seam& seam : garment.seams) sewn.emplace_back(seam.i, seam.j);
  return {positions, garment.triangles, sewn, cloth::pinned_flags(garment)};
}

/// As a whole put where it is.
proxies::CrossingSurface solid(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles,
                               std::span<const std::pair<int, int>> sewn = {}) {
  return {positions, triangles, sewn, std::vector<std::uint8_t>(positions.size(), 1)};
}

} // namespace

GarmentSurface::GarmentSurface(const cloth::Garment& garment)
    : rest_(garment.rest_positions), positions_(rest_), triangles_(garment.triangles),
      surface_(surface_of(garment, rest_)), parted_(surface_of(garment, parted_layers(rest_, rest_))) {}

void GarmentSurface::move(std::span<const Vec3> positions) {
  positions_.assign(positions.begin(), positions.end());
  surface_.move(positions_);
  parted_.move(parted_layers(rest_, positions_));
}

/// The solid's polyhedron is within it: cloth that keeps out of the one is not in the other.
bool GarmentSurface::reaches_into(const proxies::Capsule& capsule) const {
  constexpr double k_rounding = 1e-9; // m, far above that of the distance
  std::vector<int> near;
  surface_.touching(proxies::swept_box(capsule, capsule), near);
  return std::any_of(near.begin(), near.end(), [&](int t) {
    const auto& [a, b, c] = triangles_[t];
    return proxies::triangle_contact(positions_[a], positions_[b], positions_[c], capsule, Vec3::Zero()).distance <
           k_rounding;
  });
}

proxies::SurfaceCrossings GarmentSurface::with(std::span<const proxies::Capsule> capsules) const {
  constexpr int k_around = 48; // 0.3 mm within a limb of 60 mm
  proxies::SurfaceCrossings found;
  for (const proxies::Capsule& capsule : capsules) {
    if (!reaches_into(capsule)) continue;
    const proxies::CapsuleTriangles limb = proxies::capsule_surface(capsule, k_around);
    found.add(proxies::crossings_between(surface_, solid(limb.positions, limb.triangles)));
  }
  return found;
}

proxies::SurfaceCrossings GarmentSurface::with_itself() const { return proxies::crossings_within(parted_); }

proxies::CrossingSurface skin_surface(const proxies::BodyMesh& body) {
  const std::span<const Vec3> at = body.positions();
  std::vector<int> order(at.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](int i, int j) {
    return std::lexicographical_compare(at[i].begin(), at[i].end(), at[j].begin(), at[j].end());
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<std::pair<int, int>> one;
  for (std::size_t k = 1; k < order.size(); ++k)
    if (at[order[k - 1]] == at[order[k]]) one.emplace_back(order[k - 1], order[k]);
  return solid(at, body.triangles(), one);
}

void CrossingTally::add(int frame, const proxies::SurfaceCrossings& found) {
  placed += found.placed;
  if (found.crossings == 0) return;
  ++frames;
  total += found.crossings;
  if (found.crossings <= worst) return;
  worst = found.crossings;
  worst_frame = frame;
}

} // namespace tutu::app
