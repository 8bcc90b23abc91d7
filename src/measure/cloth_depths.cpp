#include "src/measure/cloth_depths.h"

#include "cloth/garment/elements.h"
#include "proxies/distance/signed_distance.h"

#include <algorithm>
#include <limits>

namespace tutu::app {
namespace {

/// A point whose signed distance, or what it is not below, is known: around it none is lower than that less the way
/// there.
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

/// What is asked for signed distances, m. around() asks at the middle of a ball; near() may then be asked at points of
/// that ball, and only tells the distance where it is below 0.
struct BodySurface {
  const proxies::BodyMesh& body;

  double at(const Vec3& p) const { return body.signed_distance(p).distance; }
  double around(const Vec3& centre, double) const { return at(centre); }
  double near(const Vec3& p) const { return at(p); }
};

class ProxySurface {
public:
  ProxySurface(std::span<const proxies::Capsule> proxies, const std::optional<proxies::Plane>& ground)
      : proxies_(proxies), ground_(ground) {
    near_.reserve(proxies.size());
  }

  double at(const Vec3& p) const {
    double nearest = to_ground(p);
    for (const proxies::Capsule& proxy : proxies_)
      nearest = std::min(nearest, proxies::signed_distance(p, proxy).distance);
    return nearest;
  }
  double around(const Vec3& centre, double radius) {
    double nearest = to_ground(centre);
    near_.clear();
    for (const proxies::Capsule& proxy : proxies_) {
      const double distance = proxies::signed_distance(centre, proxy).distance;
      nearest = std::min(nearest, distance);
      if (distance < radius) near_.push_back(&proxy);
    }
    return nearest;
  }
  double near(const Vec3& p) const {
    double nearest = to_ground(p);
    for (const proxies::Capsule* proxy : near_)
      nearest = std::min(nearest, proxies::signed_distance(p, *proxy).distance);
    return nearest;
  }

private:
  double to_ground(const Vec3& p) const {
    return ground_ ? proxies::signed_distance(p, *ground_).distance : std::numeric_limits<double>::infinity();
  }

  std::span<const proxies::Capsule> proxies_;
  std::optional<proxies::Plane> ground_;
  std::vector<const proxies::Capsule*> near_;
};

} // namespace

void DepthCount::add(double depth) {
  ++asked;
  inside += depth > k_inside_depth;
  deepest = std::max(deepest, depth);
  sum += depth;
}

void DepthCount::add(const DepthCount& other) {
  asked += other.asked;
  inside += other.inside;
  deepest = std::max(deepest, other.deepest);
  sum += other.sum;
}

void ClothDepths::clear() {
  particles = edges = triangles = {};
  surface = 0.0;
  surface_particle = -1;
  particle_depths.clear();
}

ClothProbe::ClothProbe(const cloth::Garment& garment) : parts_(garment) {
  for (const cloth::Edge& edge : cloth::edges_of(garment.triangles))
    if (!parts_.pinned[edge.a] || !parts_.pinned[edge.b]) {
      edges_.push_back({edge.a, edge.b});
      clear_ = std::max(clear_, (garment.rest_positions[edge.a] - garment.rest_positions[edge.b]).norm());
    }
}

void ClothProbe::measure(const proxies::BodyMesh& body, std::span<const Vec3> positions, ClothDepths& result) const {
  BodySurface surface{body};
  const std::vector<double> distances = measure_particles(surface, positions, result);
  for (const auto& [a, b] : edges_) {
    const Vec3 middle = 0.5 * (positions[a] + positions[b]);
    const std::array knowns = {Known{positions[a], distances[a]}, Known{positions[b], distances[b]}};
    const bool outside = least_at(middle, knowns) >= 0.0; // then nobody needs to ask
    result.edges.add(outside ? 0.0 : std::max(0.0, -surface.at(middle)));
  }
  measure_triangles(surface, positions, distances, result);
}

void ClothProbe::measure(std::span<const proxies::Capsule> proxies, const std::optional<proxies::Plane>& ground,
                         std::span<const Vec3> positions, ClothDepths& result) const {
  ProxySurface surface(proxies, ground);
  measure_triangles(surface, positions, measure_particles(surface, positions, result), result);
}

void ClothProbe::measure(const proxies::SweptColliders& colliders, std::span<const Vec3> positions,
                         ClothDepths& result) const {
  std::vector<proxies::Capsule> met;
  for (int c = 0; c < colliders.size(); ++c)
    if (colliders.meets(c)) met.push_back(colliders.end[c]);
  measure(met, colliders.ground, positions, result);
}

/// Signed distances; where nobody needs to ask a bound that none is below.
template <class Surface>
std::vector<double> ClothProbe::measure_particles(const Surface& surface, std::span<const Vec3> positions,
                                                  ClothDepths& result) const {
  std::vector<double> distances;
  distances.reserve(positions.size());
  std::optional<Known> asked; // the last; neighbours follow each other
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double bound = asked ? asked->least_at(positions[i]) : 0.0;
    if (bound > clear_) {
      distances.push_back(bound);
    } else {
      distances.push_back(surface.at(positions[i]));
      asked = {positions[i], distances.back()};
    }
    if (parts_.pinned[i]) continue;
    const double depth = std::max(0.0, -distances.back());
    result.particles.add(depth);
    result.particle_depths.push_back(depth);
  }
  return distances;
}

template <class Surface>
void ClothProbe::measure_triangles(Surface& surface, std::span<const Vec3> positions, std::span<const double> distances,
                                   ClothDepths& result) const {
  for (const auto& corner : parts_.free_triangles) {
    const auto known = [&](int k) { return Known{positions[corner[k]], distances[corner[k]]}; };
    const auto pinned = [&](int k) { return parts_.pinned[corner[k]] != 0; };
    const auto note = [&](double depth, const Vec3& p) {
      if (!(depth > result.surface)) return;
      result.surface = depth;
      double nearest = std::numeric_limits<double>::infinity();
      for (int k = 0; k < 3; ++k)
        if (const double way = (known(k).point - p).norm(); !pinned(k) && way < nearest) {
          nearest = way;
          result.surface_particle = static_cast<int>(corner[k]);
        }
    };
    const Vec3 centroid = (known(0).point + known(1).point + known(2).point) / 3.0;
    double reach = 0.0; // no sample is farther from the centroid
    for (int k = 0; k < 3; ++k) reach = std::max(reach, (known(k).point - centroid).norm());
    const double bound = least_at(centroid, std::array{known(0), known(1), known(2)});
    if (bound >= reach) { // nobody needs to ask
      result.triangles.add(0.0);
      continue;
    }
    const double at_centroid = surface.around(centroid, reach);
    result.triangles.add(std::max(0.0, -at_centroid));
    note(-at_centroid, centroid);
    if (reach - at_centroid <= result.surface) continue; // nothing of it can be deeper

    const std::array knowns = {known(0), known(1), known(2), Known{centroid, at_centroid}};
    constexpr int k_parts = 6;
    static_assert((k_parts + 1) * (k_parts + 2) / 2 == k_surface_samples);
    for (int i = 0; i <= k_parts; ++i)
      for (int j = 0; i + j <= k_parts; ++j) {
        const int k = k_parts - i - j;
        const bool at_corner = i == k_parts || j == k_parts || k == k_parts;
        const bool placed = (i == 0 || pinned(0)) && (j == 0 || pinned(1)) &&
                            (k == 0 || pinned(2)); // on an edge between pinned corners
        if (at_corner || placed) continue;         // a particle, or nothing that is simulated
        const Vec3 p = (i * knowns[0].point + j * knowns[1].point + k * knowns[2].point) / k_parts;
        if (-least_at(p, knowns) > result.surface) note(-surface.near(p), p);
      }
    for (int k = 0; k < 3; ++k)
      if (!pinned(k)) note(-distances[corner[k]], known(k).point);
  }
}

} // namespace tutu::app
