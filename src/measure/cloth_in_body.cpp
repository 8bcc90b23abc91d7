#include "src/measure/cloth_in_body.h"

#include "cloth/garment/elements.h"
#include "src/measure/frame_metrics.h"
#include "src/measure/run_stats.h"

#include <algorithm>
#include <optional>

namespace tutu::app {
namespace {

/// A point whose signed distance is known: around it none is lower than that less the way there.
struct Known {
  Vec3 point;
  double distance;

  double least_at(const Vec3& p) const { return distance - (p - point).norm(); }
};

template <class Knowns> double least_at(const Vec3& p, const Knowns& knowns) {
  double least = -std::numeric_limits<double>::infinity();
  for (const Known& known : knowns) least = std::max(least, known.least_at(p));
  return least;
}

} // namespace

void DepthCount::add(double depth) {
  ++asked;
  inside += depth > k_inside_depth;
  deepest = std::max(deepest, depth);
}

void DepthCount::add(const DepthCount& other) {
  asked += other.asked;
  inside += other.inside;
  deepest = std::max(deepest, other.deepest);
}

void ClothInBody::clear() {
  particles = edges = triangles = {};
  deepest_of_triangles = 0.0;
  particle_depths.clear();
}

double ClothInBody::deepest() const {
  return std::max({particles.deepest, edges.deepest, triangles.deepest, deepest_of_triangles});
}

ClothProbe::ClothProbe(const cloth::Garment& garment) : garment_(&garment), pinned_(cloth::pinned_flags(garment)) {
  for (const cloth::Edge& edge : cloth::edges_of(garment.triangles))
    if (!pinned_[edge.a] || !pinned_[edge.b]) {
      edges_.push_back({edge.a, edge.b});
      clear_ = std::max(clear_, (garment.rest_positions[edge.a] - garment.rest_positions[edge.b]).norm());
    }
}

void ClothProbe::measure(const proxies::BodyMesh& body, std::span<const Vec3> positions, ClothInBody& result) const {
  std::vector<double> distances; // where nobody needs to ask a bound, that none is below
  distances.reserve(positions.size());
  std::optional<Known> asked; // the last; neighbours follow each other
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double bound = asked ? asked->least_at(positions[i]) : 0.0;
    if (bound > clear_) {
      distances.push_back(bound);
    } else {
      distances.push_back(body.signed_distance(positions[i]).distance);
      asked = {positions[i], distances.back()};
    }
    if (pinned_[i]) continue;
    const double depth = std::max(0.0, -distances.back());
    result.particles.add(depth);
    result.particle_depths.push_back(depth);
  }
  const auto known = [&](int i) { return Known{positions[i], distances[i]}; };

  for (const auto& [a, b] : edges_) {
    const Vec3 middle = 0.5 * (positions[a] + positions[b]);
    const bool outside = least_at(middle, std::array{known(a), known(b)}) >= 0.0; // then nobody needs to ask
    result.edges.add(outside ? 0.0 : std::max(0.0, -body.signed_distance(middle).distance));
  }

  for (const auto& triangle : garment_->triangles) {
    const std::array<int, 3> corner = {static_cast<int>(triangle[0]), static_cast<int>(triangle[1]),
                                       static_cast<int>(triangle[2])};
    if (pinned_[corner[0]] && pinned_[corner[1]] && pinned_[corner[2]]) continue;
    const Vec3 centroid = (positions[corner[0]] + positions[corner[1]] + positions[corner[2]]) / 3.0;
    const double bound = least_at(centroid, std::array{known(corner[0]), known(corner[1]), known(corner[2])});
    const double at_centroid = bound >= 0.0 ? bound : body.signed_distance(centroid).distance; // or nobody needs to ask
    result.triangles.add(std::max(0.0, -at_centroid));
    result.deepest_of_triangles = std::max(result.deepest_of_triangles, -at_centroid);

    const std::array knowns = {known(corner[0]), known(corner[1]), known(corner[2]), Known{centroid, at_centroid}};
    constexpr int k_parts = 6;
    static_assert((k_parts + 1) * (k_parts + 2) / 2 == k_surface_samples);
    for (int i = 0; i <= k_parts; ++i)
      for (int j = 0; i + j <= k_parts; ++j) {
        const int k = k_parts - i - j;
        const bool at_corner = i == k_parts || j == k_parts || k == k_parts;
        const bool placed = (i == 0 || pinned_[corner[0]]) && (j == 0 || pinned_[corner[1]]) &&
                            (k == 0 || pinned_[corner[2]]); // on an edge between pinned corners
        if (at_corner || placed) continue;                  // a particle, or nothing that is simulated
        const Vec3 p = (i * positions[corner[0]] + j * positions[corner[1]] + k * positions[corner[2]]) / k_parts;
        if (-least_at(p, knowns) <= result.deepest_of_triangles)
          continue; // it cannot be deeper: asking changes nothing
        result.deepest_of_triangles = std::max(result.deepest_of_triangles, -body.signed_distance(p).distance);
      }
    for (const int c : corner)
      if (!pinned_[c]) result.deepest_of_triangles = std::max(result.deepest_of_triangles, -distances[c]);
  }
}

} // namespace tutu::app
