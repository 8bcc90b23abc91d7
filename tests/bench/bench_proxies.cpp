// What a frame of collision queries costs, backend against backend, and what one question costs.
#include "proxies/collision_query.h"
#include "proxies/narrow_phase.h"
#include "proxies/signed_distance.h"
#include "tests/support/collider_scenes.h"

#include <benchmark/benchmark.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/distance.h>

using namespace tutu;
using namespace tutu::proxies;

namespace {

constexpr double k_reach = 0.02; // m: cloth at 1 m/s and 60 frames a second, and its thickness

void count(benchmark::State& state, double pairs) {
  state.counters["pairs"] = pairs;
  state.counters["s_per_pair"] =
      benchmark::Counter(pairs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void find_candidates(benchmark::State& state, Backend backend) {
  const test::ColliderScene scene = test::dancer_scene(static_cast<int>(state.range(0)));
  const auto query = make_query(backend);
  Candidates candidates;
  for (auto _ : state) query->find_candidates(scene.swept(), scene.points, k_reach, candidates);
  state.counters["per_point"] = static_cast<double>(candidates.colliders.size()) / static_cast<double>(state.range(0));
}

void contacts(benchmark::State& state, Backend backend) {
  const test::ColliderScene scene = test::dancer_scene(static_cast<int>(state.range(0)));
  const auto query = make_query(backend);
  Candidates candidates;
  query->find_candidates(scene.swept(), scene.points, k_reach, candidates);
  for (auto _ : state) {
    query->place(scene.end, scene.ground);
    for (int p = 0; p < static_cast<int>(scene.points.size()); ++p)
      for (const int c : candidates.of(p)) benchmark::DoNotOptimize(query->contact(scene.points[p], c));
  }
  count(state, static_cast<double>(candidates.colliders.size()));
}

BENCHMARK_CAPTURE(find_candidates, fcl, Backend::fcl)->Arg(900)->Arg(4096)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(find_candidates, brute, Backend::brute)->Arg(900)->Arg(4096)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(contacts, fcl, Backend::fcl)->Arg(900)->Arg(4096)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(contacts, brute, Backend::brute)->Arg(900)->Arg(4096)->Unit(benchmark::kMicrosecond);

/// A thousand random questions to one capsule each, asked in three ways.
struct Questions {
  std::vector<Capsule> capsules;
  std::vector<Vec3> points;
  Questions() {
    std::mt19937_64 random(1);
    for (int i = 0; i < 1000; ++i) {
      capsules.push_back({test::random_point(random, 0.3), test::random_point(random, 0.3), 0.3});
      points.push_back(test::random_point(random, 0.35));
    }
  }
};

void one_closed_form(benchmark::State& state) {
  const Questions questions;
  for (auto _ : state)
    for (int i = 0; i < 1000; ++i)
      benchmark::DoNotOptimize(signed_distance(questions.points[i], questions.capsules[i]));
  count(state, 1000);
}
BENCHMARK(one_closed_form);

void one_adapter(benchmark::State& state) {
  const Questions questions;
  NarrowPhase narrow_phase;
  narrow_phase.place(questions.capsules);
  for (auto _ : state)
    for (int i = 0; i < 1000; ++i) benchmark::DoNotOptimize(narrow_phase.contact(questions.points[i], i));
  count(state, 1000);
}
BENCHMARK(one_adapter);

/// FCL's public entry with the same shapes: what the adapter saves by calling the pair's closed form itself.
void one_fcl_distance(benchmark::State& state) {
  const Questions questions;
  const fcl::Capsuled ball(1.0, 0.0);
  std::vector<fcl::Capsuled> shapes;
  std::vector<fcl::Transform3d> poses;
  for (const Capsule& capsule : questions.capsules) {
    const Vec3 axis = capsule.b - capsule.a;
    shapes.emplace_back(capsule.radius, axis.norm());
    poses.push_back(fcl::Transform3d::Identity());
    poses.back().linear() = rotation_between(Vec3::UnitZ(), axis).toRotationMatrix();
    poses.back().translation() = 0.5 * (capsule.a + capsule.b);
  }
  const fcl::DistanceRequestd request(true, false);
  fcl::DistanceResultd result;
  for (auto _ : state)
    for (int i = 0; i < 1000; ++i) {
      fcl::Transform3d pose = fcl::Transform3d::Identity();
      pose.translation() = questions.points[i];
      result.clear();
      fcl::distance<double>(&ball, pose, &shapes[i], poses[i], request, result);
      benchmark::DoNotOptimize(result.min_distance);
    }
  count(state, 1000);
}
BENCHMARK(one_fcl_distance);

} // namespace
