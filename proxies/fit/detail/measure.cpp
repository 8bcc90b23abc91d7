#include "proxies/fit/detail/measure.h"

#include "proxies/body/body_mesh.h"
#include "proxies/body/winding.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/distance/surface_cells.h"
#include "rig/strong_poses.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace tutu::proxies {
namespace {

using namespace fit;

constexpr double k_fine = 5e-4; // m: cells of this radius end the search for a bound
/// Cells looked at over all poses, at most, each way: the largest of those left is a bound too, if a wider one.
constexpr int k_most_cells = 20000;
constexpr double k_off_skin = 0.002, k_buried = 0.6; // as sample_skin has them
constexpr double k_measured_cells = 60e3;            // over all poses
constexpr std::uint32_t k_seed = 20011;              // not that of a fit

/// Values with weights, and what they come to.
class Weighted {
public:
  void add(double value, double weight) { values_.emplace_back(std::max(0.0, value), weight); }
  void add_bound(double bound) { bound_ = std::max(bound_, bound); }
  long count() const { return static_cast<long>(values_.size()); }

  FitSpread spread() {
    FitSpread s;
    double total = 0.0;
    for (const auto& [value, weight] : values_) {
      s.mean += weight * value;
      s.rms += weight * value * value;
      total += weight;
    }
    s.bound = bound_;
    if (!(total > 0.0)) return s;
    s.mean /= total;
    s.rms = std::sqrt(s.rms / total);
    std::sort(values_.begin(), values_.end());
    double reached = 0.0;
    for (const auto& [value, weight] : values_) {
      reached += weight;
      if (reached <= 0.95 * total) s.p95 = value;
      if (reached <= 0.99 * total) s.p99 = value;
    }
    s.max = values_.back().first;
    s.bound = std::max(s.bound, s.max);
    return s;
  }

private:
  std::vector<std::pair<double, double>> values_;
  double bound_ = 0.0;
};

/// The body in one pose, with the proxies around it.
struct Scene {
  const PosedShapes& shapes;
  int pose;
  const BodyMesh& mesh;
  const Winding& winding;
  const std::vector<bool>& in_region; ///< [triangle]
};

/// Signed distance from the union of the shapes, one left out.
double from_shapes(const Scene& scene, const Vec3& point, int without = -1) {
  double least = std::numeric_limits<double>::infinity();
  for (int s = 0; s < scene.shapes.count; ++s)
    if (s != without)
      least = std::min(least, signed_distance(point, scene.shapes.capsules[scene.shapes.at(scene.pose, s)]).distance);
  return least;
}

// --- skin that sticks out of the proxies ----------------------------------------------------------------------------

struct Corner {
  double bound, value;
  std::array<Vec3, 3> at;
  bool operator<(const Corner& other) const { return bound < other.bound; }
};

Corner triangle_cell(const Scene& scene, const std::array<Vec3, 3>& at) {
  const Vec3 middle = (at[0] + at[1] + at[2]) / 3.0;
  double radius = 0.0;
  for (const Vec3& corner : at) radius = std::max(radius, (corner - middle).norm());
  const double value = from_shapes(scene, middle);
  return {value + radius, value, at};
}

/// No skin of the region that is not buried is farther from the proxies in this pose, if it is farther than `known`:
/// the largest cells first, cut in four until they are fine.
double under_bound(const Scene& scene, double known) {
  std::priority_queue<Corner> cells;
  const std::span<const Vec3> p = scene.mesh.positions();
  for (std::size_t t = 0; t < scene.mesh.triangles().size(); ++t) {
    if (!scene.in_region[t]) continue;
    const auto& [a, b, c] = scene.mesh.triangles()[t];
    Corner cell = triangle_cell(scene, {p[a], p[b], p[c]});
    if (cell.bound > known) cells.push(cell);
  }
  for (int looked = 0; !cells.empty(); ++looked) {
    const Corner cell = cells.top();
    cells.pop();
    if (cell.bound <= known) break;
    const Vec3 normal = (cell.at[1] - cell.at[0]).cross(cell.at[2] - cell.at[0]).normalized();
    const auto buried = [&](const Vec3& point) { return scene.winding.at(point + k_off_skin * normal) > k_buried; };
    if (std::all_of(cell.at.begin(), cell.at.end(), buried) && buried((cell.at[0] + cell.at[1] + cell.at[2]) / 3.0))
      continue;
    if (cell.bound - cell.value <= k_fine || looked >= k_most_cells / scene.shapes.poses) return cell.bound;
    const Vec3 ab = 0.5 * (cell.at[0] + cell.at[1]), bc = 0.5 * (cell.at[1] + cell.at[2]),
               ca = 0.5 * (cell.at[2] + cell.at[0]);
    const std::array<std::array<Vec3, 3>, 4> parts = {
        {{cell.at[0], ab, ca}, {ab, cell.at[1], bc}, {ca, bc, cell.at[2]}, {ab, bc, ca}}};
    for (const auto& part : parts) cells.push(triangle_cell(scene, part));
  }
  return known;
}

double surface_of(const PosedShapes& shapes, int pose) {
  double area = 0.0;
  for (int s = 0; s < shapes.count; ++s) area += CapsuleSurface(shapes.capsules[shapes.at(pose, s)]).area();
  return area;
}

// --- proxies that stick out of the skin -----------------------------------------------------------------------------

/// A cell with the most that a point of it can be out of the body.
struct OverCell {
  double bound;
  SurfaceCell cell;
  bool operator<(const OverCell& other) const { return bound < other.bound; }
};

/// How far a cell's middle is out of the body, and of the other proxies; nothing where all of the cell is inside
/// another proxy, or where its nearest skin is not of the region.
struct Out {
  double of_body, of_others;
};
std::optional<Out> look_out(const Scene& scene, const CapsuleSurface& surface, const SurfaceCell& cell) {
  const Vec3 middle = surface.middle(cell);
  const double others = from_shapes(scene, middle, cell.capsule);
  if (others < -surface.radius(cell)) return std::nullopt;
  const auto near = scene.mesh.nearest(middle, std::numeric_limits<double>::infinity());
  if (!near || !scene.in_region[near->triangle]) return std::nullopt;
  return Out{scene.winding.at(middle) > 0.5 ? -near->distance : near->distance, others};
}

void measure_over(const Scene& scene, double size, Weighted& over, double& bound) {
  const auto capsules = std::span(scene.shapes.capsules).subspan(scene.shapes.at(scene.pose, 0), scene.shapes.count);
  const std::vector<CapsuleSurface> surfaces(capsules.begin(), capsules.end());
  std::priority_queue<OverCell> cells;
  const auto whole = static_cast<int>(surface_of(scene.shapes, scene.pose) / (size * size));
  for (const SurfaceCell& cell : surface_cells(capsules, whole)) {
    const CapsuleSurface& surface = surfaces[cell.capsule];
    const auto out = look_out(scene, surface, cell);
    if (!out) continue;
    cells.push({out->of_body + surface.radius(cell), cell});
    if (out->of_others < 0.0) continue;
    over.add(out->of_body, surface.area(cell));
    bound = std::max(bound, out->of_body);
  }
  for (int looked = 0; !cells.empty() && cells.top().bound > bound; ++looked) {
    const OverCell top = cells.top();
    cells.pop();
    const CapsuleSurface& surface = surfaces[top.cell.capsule];
    if (surface.radius(top.cell) <= k_fine || looked >= k_most_cells / scene.shapes.poses) {
      bound = top.bound;
      break;
    }
    for (const SurfaceCell& part : surface.halves(top.cell))
      if (const auto out = look_out(scene, surface, part)) cells.push({out->of_body + surface.radius(part), part});
  }
}

std::vector<bool> triangles_in(FitRegion region, const rig::Character& character) {
  const std::vector<rig::BodyPart> parts = rig::body_parts(character.skeleton);
  std::vector<bool> in;
  for (const rig::Triangle& t : character.mesh.triangles)
    in.push_back(region == FitRegion::body || parts[main_joint_of(character, t)] == rig::BodyPart::garment);
  return in;
}

} // namespace

namespace fit {

PosedShapes place(std::span<const Proxy> proxies, const std::vector<std::vector<Transform>>& poses) {
  PosedShapes shapes;
  for (const Proxy& proxy : proxies)
    if (proxy.enabled) shapes.unit.push_back(shapes.count++);
  shapes.image.assign(shapes.count, 0);
  shapes.poses = static_cast<int>(poses.size());
  shapes.resize();
  std::size_t i = 0;
  for (const auto& pose : poses)
    for (const Proxy& proxy : proxies)
      if (proxy.enabled) shapes.set(i++, {proxy.a.place(pose), proxy.b.place(pose), proxy.radius, proxy.taper});
  return shapes;
}

} // namespace fit

FitError measure_fit(const rig::Character& character, const std::vector<std::vector<Transform>>& poses,
                     const std::vector<Proxy>& proxies, FitRegion region, int skin_points,
                     const FitProgress& progress) {
  const PosedShapes shapes = place(proxies, poses);
  if (shapes.count == 0) throw std::invalid_argument("no proxy to measure");
  FitError error;
  error.poses = static_cast<int>(poses.size());
  Weighted under, over;

  const FitPoints points = sample_skin(character, poses, region, skin_points, k_seed);
  Nearest nearest;
  find_nearest(points.blocks, shapes, false, nearest);
  double known = 0.0;
  for (std::size_t i = 0; i < nearest.distance.size(); ++i) {
    if (!(points.blocks.weight[i] > 0.0f)) continue;
    under.add(static_cast<double>(nearest.distance[i]), static_cast<double>(points.blocks.weight[i]));
    known = std::max(known, static_cast<double>(nearest.distance[i]));
  }

  BodyMesh mesh(character.mesh.positions, character.mesh.triangles);
  const std::vector<bool> in_region = triangles_in(region, character);
  const double size = std::max(0.008, std::sqrt(surface_of(shapes, 0) * error.poses / k_measured_cells));
  std::vector<Vec3> positions(character.mesh.positions.size()), normals(positions.size());
  double over_bound = 0.0;
  std::vector<rig::Triangle> together;
  for (int p = 0; p < error.poses; ++p) {
    rig::skin_vertices_reference(character.mesh, character.skin, poses[p], positions, normals);
    mesh.pose(positions);
    if (together.empty()) together = neighbours_together(positions, mesh.triangles());
    const Winding winding(positions, together);
    const Scene scene{shapes, p, mesh, winding, in_region};
    known = under_bound(scene, known);
    measure_over(scene, size, over, over_bound);
    if (progress && !progress((p + 1.0) / error.poses)) {
      error.poses = p + 1;
      break;
    }
  }
  under.add_bound(known);
  over.add_bound(over_bound);
  error.skin_points = under.count();
  error.proxy_points = over.count();
  error.under = under.spread();
  error.over = over.spread();
  return error;
}

} // namespace tutu::proxies
