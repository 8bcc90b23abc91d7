#include "proxies/validate/validate.h"

#include "proxies/distance/capsule_union.h"
#include "proxies/distance/surface_cells.h"
#include "proxies/motion/collider_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tutu::proxies {
namespace {

/// What is known of a cell from its middle: the error there, whether the middle counts (`outside` <= 0: a 1-Lipschitz
/// distance from the region that does), how far the cell reaches, and what else bounds the error in it.
struct Probe {
  double error = 0.0, outside = 0.0, radius = 0.0;
  bool in_reach = true; ///< the middle is: told, not asked about
  double ceiling = std::numeric_limits<double>::infinity();

  bool counts() const { return outside <= 0.0; }
  /// No point of the cell that counts has a greater error.
  double upper() const { return outside > radius ? 0.0 : std::max(0.0, std::min(error + radius, ceiling)); }
};

/// Narrows the greatest error over cells by best-first branch and bound.
template <class Cell> class BoundSearch {
public:
  explicit BoundSearch(double gap) : gap_(gap) {}

  void add(const Cell& cell, const Probe& probe) {
    take(probe);
    open_.push_back({cell, probe.upper()});
  }

  /// `split(cell, visit)` calls visit(part, probe) for each part of the cell.
  template <class Split> BoundedMax run(int most_probes, const Split& split) {
    const auto lower = [](const Node& x, const Node& y) { return x.upper < y.upper; };
    double settled = best_; // of cells that need not be looked into
    std::erase_if(open_, [&](const Node& node) {
      const bool done = node.upper <= best_ + gap_;
      if (done) settled = std::max(settled, node.upper);
      return done;
    });
    std::make_heap(open_.begin(), open_.end(), lower);
    int probes = 0;
    while (!open_.empty() && open_.front().upper > best_ + gap_ && probes < most_probes) {
      std::pop_heap(open_.begin(), open_.end(), lower);
      const Node node = open_.back();
      open_.pop_back();
      split(node.cell, [&](const Cell& part, const Probe& probe) {
        ++probes;
        take(probe);
        // The whole bounds its parts too.
        open_.push_back({part, std::min(node.upper, probe.upper())});
        std::push_heap(open_.begin(), open_.end(), lower);
      });
    }
    if (!open_.empty()) settled = std::max(settled, open_.front().upper);
    return {best_, std::max(best_, settled)};
  }

  /// Whether the greatest error that was found is in reach: then it is the greatest in reach too.
  bool best_in_reach() const { return best_in_reach_; }

private:
  struct Node {
    Cell cell;
    double upper;
  };
  void take(const Probe& probe) {
    if (!probe.counts() || probe.error < best_) return;
    best_ = probe.error;
    best_in_reach_ = probe.in_reach;
  }

  double gap_, best_ = 0.0;
  bool best_in_reach_ = false;
  std::vector<Node> open_;
};

/// A posed piece of skin.
struct SkinCell {
  Vec3 a, b, c;

  Vec3 middle() const { return (a + b + c) / 3.0; }
  double radius() const { return cell_radius(a, b, c, 1); }
  std::array<SkinCell, 4> quarters() const {
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    return {{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}}};
  }
};

/// Distance from one capsule is convex, so over a triangle it is greatest at a corner; that from the union is no
/// greater. Where one proxy stands for the whole cell this is far below error + radius.
Probe probe_of(const SkinCell& cell, const CapsuleUnion& proxies, const CapsuleUnion::Nearest& at_middle) {
  Probe probe{at_middle.distance, 0.0, cell.radius()};
  if (at_middle.capsule == CapsuleUnion::k_none) return probe;
  const auto nearest = static_cast<std::size_t>(at_middle.capsule);
  probe.ceiling = std::max({proxies.distance(cell.a, nearest), proxies.distance(cell.b, nearest),
                            proxies.distance(cell.c, nearest), at_middle.distance});
  return probe;
}

/// Signed distance from what the garments can reach.
struct Reach {
  CapsuleUnion balls;
  bool everything = false;

  double outside(const Vec3& point) const {
    return everything ? -std::numeric_limits<double>::infinity() : balls.distance(point);
  }
};

void measure_skin(const BodyMesh& body, const SkinSamples& samples, const CapsuleUnion& proxies, const Reach& reach,
                  const ValidationEffort& effort, FrameErrors& errors) {
  const auto positions = body.positions();
  const auto triangles = body.triangles();
  errors.skin.resize(samples.size());
  errors.nearest.resize(samples.size());
  errors.skin_in_reach.resize(samples.size());
  BoundSearch<SkinCell> all(effort.skin_gap), reached(effort.skin_gap);
  for (std::size_t s = 0; s < samples.size();) {
    const int triangle = samples.samples[s].triangle;
    const rig::Triangle& t = triangles[triangle];
    const Vec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
    const int parts = samples.parts[triangle];
    const Vec3 middle = (a + b + c) / 3.0;
    for (; s < samples.size() && samples.samples[s].triangle == triangle; ++s) {
      const Vec3& w = samples.samples[s].weights;
      const Vec3 p = w[0] * a + w[1] * b + w[2] * c;
      const CapsuleUnion::Nearest nearest = proxies.nearest(p);
      const double outside = reach.outside(p);
      errors.skin[s] = nearest.distance;
      errors.nearest[s] = nearest.capsule;
      errors.skin_in_reach[s] = outside <= 0.0;
      // The part of the triangle about this sample: as the triangle, or turned round.
      const bool turned = std::lround(w[1] * 3.0 * parts) % 3 == 2;
      const double scale = (turned ? -1.0 : 1.0) / parts;
      const SkinCell cell{p + scale * (a - middle), p + scale * (b - middle), p + scale * (c - middle)};
      Probe probe = probe_of(cell, proxies, nearest);
      probe.in_reach = outside <= 0.0;
      all.add(cell, probe);
      if (reach.everything) continue;
      probe.outside = outside;
      reached.add(cell, probe);
    }
  }
  const auto split = [&](bool within_reach) {
    return [&, within_reach](const SkinCell& cell, const auto& visit) {
      for (const SkinCell& part : cell.quarters()) {
        const Vec3 p = part.middle();
        Probe probe = probe_of(part, proxies, proxies.nearest(p));
        const double outside = reach.outside(p);
        probe.in_reach = outside <= 0.0;
        if (within_reach) probe.outside = outside;
        visit(part, probe);
      }
    };
  };
  errors.under = all.run(effort.skin_refinements, split(false));
  errors.under_in_reach =
      reach.everything || all.best_in_reach() ? errors.under : reached.run(effort.skin_refinements, split(true));
}

void measure_surface(const BodyMesh& body, std::span<const Capsule> colliders, const CapsuleUnion& proxies,
                     const Reach& reach, const ValidationEffort& effort, FrameErrors& errors) {
  std::vector<CapsuleSurface> surfaces(colliders.begin(), colliders.end());
  errors.surface.clear();
  BoundSearch<SurfaceCell> all(effort.surface_gap), reached(effort.surface_gap);
  /// How deep the point is buried in other proxies: <= 0 on the outer surface.
  const auto buried = [&](const SurfaceCell& cell, const Vec3& p) {
    return -proxies.distance_without(p, static_cast<std::size_t>(cell.capsule));
  };
  for (const SurfaceCell& cell : surface_cells(colliders, effort.surface_samples)) {
    const CapsuleSurface& surface = surfaces[cell.capsule];
    const Vec3 p = surface.middle(cell);
    Probe probe{0.0, buried(cell, p), surface.radius(cell)};
    if (probe.outside > probe.radius) continue; // all of it is
    probe.error = body.signed_distance(p).distance;
    const double outside = reach.outside(p);
    probe.in_reach = outside <= 0.0;
    if (probe.counts()) errors.surface.push_back({cell.capsule, surface.area(cell), probe.error, outside <= 0.0});
    all.add(cell, probe);
    if (reach.everything) continue;
    probe.outside = std::max(probe.outside, outside);
    reached.add(cell, probe);
  }
  const auto split = [&](bool within_reach) {
    return [&, within_reach](const SurfaceCell& cell, const auto& visit) {
      const CapsuleSurface& surface = surfaces[cell.capsule];
      for (const SurfaceCell& part : surface.halves(cell)) {
        const Vec3 p = surface.middle(part);
        Probe probe{0.0, buried(part, p), surface.radius(part)};
        const double outside = reach.outside(p);
        probe.in_reach = outside <= 0.0;
        if (within_reach) probe.outside = std::max(probe.outside, outside);
        if (probe.outside <= probe.radius) probe.error = body.signed_distance(p).distance;
        visit(part, probe);
      }
    };
  };
  errors.over = all.run(effort.surface_refinements, split(false));
  errors.over_in_reach =
      reach.everything || all.best_in_reach() ? errors.over : reached.run(effort.surface_refinements, split(true));
}

} // namespace

void measure_frame(const BodyMesh& body, const SkinSamples& samples, std::span<const Capsule> colliders,
                   std::span<const Capsule> reach, bool everything_in_reach, const ValidationEffort& effort,
                   FrameErrors& errors) {
  CapsuleUnion proxies;
  proxies.assign(colliders);
  Reach reachable;
  reachable.balls.assign(reach);
  reachable.everything = everything_in_reach;
  measure_skin(body, samples, proxies, reachable, effort, errors);
  measure_surface(body, colliders, proxies, reachable, effort, errors);
  errors.collisions.clear();
  errors.inside.clear();
  for (std::size_t c = 0; c < colliders.size(); ++c) {
    const MeshHits hits = body.hits(colliders[c]);
    if (hits.hit()) errors.collisions.push_back(static_cast<int>(c));
    if (hits.inside) errors.inside.push_back(static_cast<int>(c));
  }
}

VolumeCount count_volume(const BodyMesh& body, std::span<const Capsule> colliders, std::int64_t first, int points) {
  Box box;
  for (const Vec3& p : body.positions()) box.extend(p);
  for (const Capsule& c : colliders) box.extend(swept_box(c, c));
  CapsuleUnion proxies;
  proxies.assign(colliders);
  VolumeCount count;
  count.points = points;
  count.box = box.volume();
  // Powers of 1 / g, g the root of g^4 = g + 1.
  const Vec3 step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  for (std::int64_t k = first; k < first + points; ++k) {
    Vec3 share = Vec3::Constant(0.5) + static_cast<double>(k) * step;
    share -= Vec3(share.array().floor());
    const Vec3 p = box.min() + share.cwiseProduct(box.sizes());
    const bool in_body = body.is_inside(p), in_proxies = proxies.distance(p) <= 0.0;
    count.body += in_body;
    count.proxies += in_proxies;
    count.both += in_body && in_proxies;
  }
  return count;
}

std::vector<char> outer_triangles(const BodyMesh& body) {
  constexpr double k_step = 1e-4; // m off the skin: above the rounding of float vertices (1e-7), below any thickness
  const auto positions = body.positions();
  std::vector<char> outer;
  outer.reserve(body.triangles().size());
  for (const rig::Triangle& t : body.triangles()) {
    const Vec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
    const Vec3 normal = (b - a).cross(c - a);
    const double length = normal.norm();
    const Vec3 middle = (a + b + c) / 3.0;
    outer.push_back(!(length > 0.0) || !body.is_inside(middle + k_step / length * normal));
  }
  return outer;
}

} // namespace tutu::proxies
