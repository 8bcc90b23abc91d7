// The true body, 25,000 vertices: what a frame of questions costs, the refit included, and each part alone.
#include "proxies/body/body_features.h"
#include "proxies/body/body_mesh.h"
#include "tests/support/solids.h"

#include <benchmark/benchmark.h>

#include <limits>
#include <random>

using namespace tutu;
using namespace tutu::proxies;

namespace {

/// A limb as thick as a trunk, bent to a ring: 25,000 vertices, 50,000 triangles, one closed shell.
test::Surface one_shell() { return test::torus_surface(0.5, 0.13, 250, 100); }

/// The same with 49 spheres inside, as the dancer has them.
test::Surface many_shells() {
  test::Surface body = one_shell();
  for (int i = 0; i < 49; ++i) {
    const double angle = 2.0 * M_PI * i / 49;
    const Vec3 centre(0.5 * std::cos(angle), 0.0, 0.5 * std::sin(angle));
    test::append(body, test::sphere_surface(0.03, 1, centre.cast<float>()));
  }
  return body;
}

/// Cloth about the body: rows of points 0 to 4 cm off it, a few under the skin.
std::vector<Vec3> cloth_about(int count) {
  std::vector<Vec3> points;
  const int across = 32, around = count / across;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> gap(-0.002, 0.04);
  for (int i = 0; i < around * across; ++i) {
    const double u = 2.0 * M_PI * (i / across) / around, v = 2.0 * M_PI * (i % across) / across;
    const double tube = 0.13 + gap(random), r = 0.5 + tube * std::cos(v);
    points.emplace_back(r * std::cos(u), tube * std::sin(v), r * std::sin(u));
  }
  return points;
}

/// A frame: the body takes its pose, each point asks once.
template <class Ask> void frame(benchmark::State& state, const test::Surface& surface, const Ask& ask) {
  BodyMesh body(surface.positions, surface.triangles);
  const std::vector<Vec3> points = cloth_about(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    body.pose(surface.positions);
    for (const Vec3& point : points) benchmark::DoNotOptimize(ask(body, point));
  }
  state.SetLabel(std::to_string(body.census().vertices) + " vertices, " + std::to_string(points.size()) + " points");
}

void signed_by_pseudonormal(benchmark::State& state) {
  frame(state, one_shell(), [](const BodyMesh& body, const Vec3& p) { return body.signed_distance(p).distance; });
}
void signed_by_winding_number(benchmark::State& state) {
  frame(state, many_shells(), [](const BodyMesh& body, const Vec3& p) { return body.signed_distance(p).distance; });
}
void nearest_within_2_cm(benchmark::State& state) {
  frame(state, one_shell(), [](const BodyMesh& body, const Vec3& p) { return body.nearest(p, 0.02).has_value(); });
}
void nearest_anywhere(benchmark::State& state) {
  frame(state, one_shell(), [](const BodyMesh& body, const Vec3& p) {
    return body.nearest(p, std::numeric_limits<double>::infinity())->distance;
  });
}

void refit(benchmark::State& state) {
  const test::Surface surface = state.range(0) == 1 ? one_shell() : many_shells();
  BodyMesh body(surface.positions, surface.triangles);
  for (auto _ : state) body.pose(surface.positions);
  state.SetLabel(state.range(0) == 1 ? "boxes" : "boxes and dipoles");
}
void build(benchmark::State& state) {
  const test::Surface surface = state.range(0) == 1 ? one_shell() : many_shells();
  for (auto _ : state) benchmark::DoNotOptimize(BodyMesh(surface.positions, surface.triangles).census().shells);
}

/// The sign alone, a point.
void side(benchmark::State& state, const test::Surface& surface) {
  const BodyMesh body(surface.positions, surface.triangles);
  const std::vector<Vec3> points = cloth_about(4096);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(body.is_inside(points[i++ % points.size()]));
}
void side_by_pseudonormal(benchmark::State& state) { side(state, one_shell()); }
void side_by_winding_number(benchmark::State& state) { side(state, many_shells()); }
void side_by_exact_winding_number(benchmark::State& state) {
  const test::Surface surface = many_shells();
  const BodyMesh body(surface.positions, surface.triangles);
  const std::vector<Vec3> points = cloth_about(64);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(body.winding_number(points[i++ % points.size()]));
}

void hits_of_a_capsule(benchmark::State& state) {
  const test::Surface surface = one_shell();
  const BodyMesh body(surface.positions, surface.triangles);
  const Capsule limb{{0.5, 0.0, -0.1}, {0.5, 0.0, 0.1}, 0.126}; // as a fitted proxy: half in, half out
  std::size_t touched = 0;
  for (auto _ : state) benchmark::DoNotOptimize(touched = body.hits(limb).triangles.size());
  state.SetLabel(std::to_string(touched) + " triangles");
}

/// Triangles of cloth, some mm a side, 1 mm off the body, row after row.
void features_of_a_triangle(benchmark::State& state) {
  const test::Surface surface = one_shell();
  const BodyMesh body(surface.positions, surface.triangles);
  const BodyFeatures features(body);
  const double side = 1e-3 * static_cast<double>(state.range(0)), depth = 1e-3 * static_cast<double>(state.range(1));
  std::vector<std::array<Vec3, 3>> cloth;
  for (int i = 0; i < 4096; ++i) {
    const double u = 2.0 * M_PI * (i / 64) / 64, v = 2.0 * M_PI * (i % 64) / 64;
    const Vec3 out(std::cos(v) * std::cos(u), std::sin(v), std::cos(v) * std::sin(u));
    const Vec3 middle = 0.5 * Vec3(std::cos(u), 0.0, std::sin(u)) + 0.131 * out;
    const Vec3 x = out.unitOrthogonal(), y = out.cross(x);
    cloth.push_back({middle + side * x, middle + side * (0.87 * y - 0.5 * x), middle - side * (0.87 * y + 0.5 * x)});
    for (Vec3& corner : cloth.back()) corner = middle + (corner - middle) / std::sqrt(3.0);
  }
  std::vector<BodyContact> contacts;
  std::size_t i = 0, found = 0;
  for (auto _ : state) {
    contacts.clear();
    benchmark::DoNotOptimize(features.contacts(cloth[i++ % cloth.size()], {0.003, depth}, contacts));
    found += contacts.size();
  }
  state.counters["contacts"] = static_cast<double>(found) / static_cast<double>(i);
}
void refresh_of_features(benchmark::State& state) {
  const test::Surface surface = one_shell();
  const BodyMesh body(surface.positions, surface.triangles);
  BodyFeatures features(body);
  for (auto _ : state) features.refresh();
}

BENCHMARK(features_of_a_triangle)->ArgsProduct({{10, 30, 80}, {5, 20}})->Unit(benchmark::kMicrosecond);
BENCHMARK(refresh_of_features)->Unit(benchmark::kMillisecond);
BENCHMARK(signed_by_pseudonormal)->Arg(900)->Arg(4096)->Arg(16384)->Unit(benchmark::kMillisecond);
BENCHMARK(signed_by_winding_number)->Arg(900)->Arg(4096)->Arg(16384)->Unit(benchmark::kMillisecond);
BENCHMARK(nearest_anywhere)->Arg(900)->Arg(4096)->Arg(16384)->Unit(benchmark::kMillisecond);
BENCHMARK(nearest_within_2_cm)->Arg(900)->Arg(4096)->Arg(16384)->Unit(benchmark::kMillisecond);
BENCHMARK(refit)->Arg(1)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(build)->Arg(1)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(side_by_pseudonormal)->Unit(benchmark::kMicrosecond);
BENCHMARK(side_by_winding_number)->Unit(benchmark::kMicrosecond);
BENCHMARK(side_by_exact_winding_number)->Unit(benchmark::kMicrosecond);
BENCHMARK(hits_of_a_capsule)->Unit(benchmark::kMicrosecond);

} // namespace
