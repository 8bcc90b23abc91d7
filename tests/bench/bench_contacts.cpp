// What contact costs a frame, a question and a contact: a tube of 64 x 64 particles, woven and of irregular triangles,
// in which a body swings; by features, and kept for who watches. A question is one tile of threads, or one particle
// or triangle of a mesh, and one proxy.
//   taskset -c 0 bench_contacts --benchmark_min_time=1
#include "cloth/contact/contact_set.h"
#include "cloth/solver.h"
#include "tests/bench/worn.h"
#include "tests/support/irregular_tube.h"
#include "tests/support/woven_cases.h"

#include <benchmark/benchmark.h>

namespace {

using namespace tutu;
using namespace tutu::cloth;

Garment woven_tube() {
  Garment garment = test::detail::tube(64, 64, {}, 0.8, std::nullopt);
  test::pin_first_row(garment);
  return garment;
}

void tube(benchmark::State& state, bool woven, ContactFeatures features, bool watched) {
  const Garment garment = woven ? woven_tube() : test::irregular_tube(64);
  SolverOptions options;
  options.features = features;
  const auto solver = make_solver(garment, options);
  const auto query = proxies::make_query(proxies::Backend::hybrid);
  bench::Worn worn(garment, true);
  ContactSet kept(20000);
  double ms = 0.0;
  const auto advance = [&] {
    FrameInput input = worn.advance();
    if (watched) input.contacts = &kept;
    if (solver->step(input, *query)) state.SkipWithError("diverged");
    ms += solver->times().contact;
  };
  for (int frame = 0; frame < 120; ++frame) advance();
  const ContactCounts before = solver->contact_counts();
  ms = 0.0;
  for (auto _ : state) advance();
  const ContactCounts after = solver->contact_counts();
  const auto frames = static_cast<double>(state.iterations());
  const auto queries = static_cast<double>(after.queries - before.queries);
  const auto contacts = static_cast<double>(after.contacts - before.contacts);
  state.counters["contact_us"] = 1e3 * ms / frames;
  state.counters["questions"] = queries / frames;
  state.counters["contacts"] = contacts / frames;
  state.counters["ns_question"] = 1e6 * ms / queries;
  state.counters["ns_contact"] = 1e6 * ms / contacts;
}

BENCHMARK_CAPTURE(tube, woven_particles, true, ContactFeatures::particles, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tube, woven_auto, true, ContactFeatures::automatic, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tube, woven_triangles, true, ContactFeatures::triangles, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tube, woven_triangles_watched, true, ContactFeatures::triangles, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tube, mesh_particles, false, ContactFeatures::particles, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tube, mesh_auto, false, ContactFeatures::automatic, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tube, mesh_triangles, false, ContactFeatures::triangles, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tube, mesh_triangles_watched, false, ContactFeatures::triangles, true)->Unit(benchmark::kMicrosecond);

} // namespace
