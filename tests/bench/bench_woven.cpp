// What a tube of N x N particles costs, a particle and substep, whatever N: hanging, its upper edge swung; the same in
// the air; and with a capsule that swings in it. All of N = 17 .. 130, in nanoseconds (`ns`):
//   taskset -c 0 bench_woven --benchmark_min_time=0.05 --benchmark_repetitions=5
//   --benchmark_report_aggregates_only=true
#include "cloth/solver.h"
#include "tests/bench/worn.h"
#include "tests/support/woven_cases.h"

#include <benchmark/benchmark.h>

namespace {

using namespace tutu;
using namespace tutu::cloth;

void tube(benchmark::State& state, bool is_worn, bool has_air) {
  const int n = static_cast<int>(state.range(0));
  Garment garment = test::detail::tube(n, n, {}, 0.8, std::nullopt);
  test::pin_first_row(garment);
  if (has_air) garment.fabric.air = Air{};
  const auto solver = make_solver(garment, {});
  const auto query = proxies::make_query(proxies::Backend::hybrid);
  bench::Worn worn(garment, is_worn);
  const auto advance = [&] {
    if (solver->step(worn.advance(), *query)) state.SkipWithError("diverged");
  };
  for (int f = 0; f < 60; ++f) advance();
  for (auto _ : state) advance();
  const double particles = static_cast<double>(n) * n;
  state.counters["ns"] =
      benchmark::Counter(particles * bench::Worn::k_substeps * static_cast<double>(state.iterations()) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void sizes(benchmark::internal::Benchmark* b) { b->DenseRange(17, 130)->Unit(benchmark::kMicrosecond); }
BENCHMARK_CAPTURE(tube, hanging, false, false)->Apply(sizes);
BENCHMARK_CAPTURE(tube, airy, false, true)->Apply(sizes);
BENCHMARK_CAPTURE(tube, worn, true, false)->Apply(sizes);

} // namespace
