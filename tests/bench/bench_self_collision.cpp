// What self-collision costs, a particle and substep: cloth that meets nothing (hanging, its upper edge swung to and
// fro), and a sheet folded in two that lies on itself.
#include "cloth/solver.h"
#include "tests/cloth/contact/two_layers.h"

#include <benchmark/benchmark.h>

namespace {

using namespace tutu;
using namespace tutu::cloth;

enum class Scene { swung, folded };

void frames(benchmark::State& state, Scene scene, bool self_collision) {
  const int n = static_cast<int>(state.range(0));
  std::vector<Vec3> start;
  Fabric fabric;
  Garment garment = test::folded_sheet(n, 0.6, scene == Scene::folded ? 165.0 : 0.0, fabric, start);
  if (scene == Scene::swung)
    for (int i = 0; i < n; ++i) garment.pins.push_back({i, 0});
  SolverOptions options;
  options.self_collision = self_collision;
  const auto solver = make_solver(garment, options);
  const auto query = proxies::make_query(proxies::Backend::hybrid);
  solver->reset(start);
  FrameInput input;
  input.substeps = n > 100 ? 20 : 10; // as many as such cloth is run with
  const std::vector<double> friction = {0.3};
  if (scene == Scene::folded) {
    input.colliders.ground = proxies::Plane{};
    input.friction = friction;
  }
  std::vector<Vec3> pins_start(garment.pins.size()), pins_end(garment.pins.size());
  int frame = 0;
  const auto advance = [&] {
    const auto place = [&](int f, std::vector<Vec3>& pins) { // 0.2 m to and fro, once a second
      for (std::size_t k = 0; k < pins.size(); ++k)
        pins[k] = garment.rest_positions[garment.pins[k].particle] +
                  Vec3(0, 0, 0.2 * std::sin(f * 2.0 * std::numbers::pi / 60.0));
    };
    place(frame, pins_start);
    place(++frame, pins_end);
    input.pins_start = pins_start;
    input.pins_end = pins_end;
    if (solver->step(input, *query)) state.SkipWithError("diverged");
  };
  for (int f = 0; f < 60; ++f) advance();
  const SelfCollisionCounts before = solver->self_collision_counts();
  for (auto _ : state) advance();
  const SelfCollisionCounts after = solver->self_collision_counts();
  const double particles = static_cast<double>(n) * n,
               substeps = static_cast<double>(state.iterations()) * input.substeps;
  state.counters["ns"] = benchmark::Counter(
      particles * substeps * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert); // a particle and substep
  state.counters["contacts"] = static_cast<double>(after.contacts - before.contacts) / (particles * substeps);
  state.counters["tests"] = static_cast<double>(after.tests - before.tests) / (particles * substeps);
  state.counters["searches"] = static_cast<double>(after.searches - before.searches) / substeps;
}

void sizes(benchmark::internal::Benchmark* b) { b->Arg(30)->Arg(64)->Arg(128)->Unit(benchmark::kMillisecond); }
BENCHMARK_CAPTURE(frames, swung_off, Scene::swung, false)->Apply(sizes);
BENCHMARK_CAPTURE(frames, swung_on, Scene::swung, true)->Apply(sizes);
BENCHMARK_CAPTURE(frames, folded_off, Scene::folded, false)->Apply(sizes);
BENCHMARK_CAPTURE(frames, folded_on, Scene::folded, true)->Apply(sizes);

} // namespace
