// What a frame of collision queries costs, backend against backend, and what one question costs.
#include "proxies/distance/feature_contact.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/motion/sweep.h"
#include "proxies/query/collision_query.h"
#include "proxies/query/detail/box_list.h"
#include "proxies/query/detail/broad_phase.h"
#include "proxies/query/detail/narrow_phase.h"
#include "tests/support/collider_scenes.h"

#include <algorithm>
#include <array>
#include <benchmark/benchmark.h>
#include <cmath>
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

/// Colliders as dense as on a body, in a cube that grows with their number, and boxes of a hand's breadth among them.
struct Crowd {
  test::ColliderScene scene;
  std::vector<Capsule> later; // a frame on: the tree must see boxes that moved
  std::vector<Box> boxes;
  Crowd(int colliders, int count) {
    std::mt19937_64 random(1);
    const double side = 0.4 * std::cbrt(colliders / 25.0);
    scene = test::random_scene(random, colliders, 0, 0.02);
    for (int i = 0; i < colliders; ++i) {
      const Vec3 move = test::random_point(random, side) - scene.start[i].a;
      for (Capsule* capsule : {&scene.start[i], &scene.end[i]}) {
        capsule->a += move;
        capsule->b += move;
      }
      const Vec3 step = test::random_point(random, 0.02);
      later.push_back({scene.end[i].a + step, scene.end[i].b + step, scene.end[i].radius});
    }
    for (int i = 0; i < count; ++i) {
      const Vec3 middle = test::random_point(random, side);
      boxes.emplace_back(middle.array() - 0.05, middle.array() + 0.05);
    }
  }
};

/// A frame of FCL's tree against a frame of the plain list: where HybridQuery changes over.
template <class Search> void boxes(benchmark::State& state) {
  const Crowd crowd(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  Search search;
  std::vector<int> found;
  std::size_t sum = 0;
  bool second = false;
  for (auto _ : state) {
    if (second) search.update(crowd.scene.end, crowd.later);
    else search.update(crowd.scene.start, crowd.scene.end);
    second = !second;
    sum = 0;
    for (const Box& box : crowd.boxes) {
      found.clear();
      search.overlaps(box, found);
      std::sort(found.begin(), found.end());
      sum += found.size();
    }
  }
  state.counters["per_box"] = static_cast<double>(sum) / static_cast<double>(state.range(1));
}
const std::vector<std::vector<std::int64_t>> k_crowds = {{25, 50, 100, 200, 400, 800}, {64, 128, 256, 512}};
BENCHMARK(boxes<BroadPhase>)->ArgsProduct(k_crowds)->Unit(benchmark::kMicrosecond);
BENCHMARK(boxes<BoxList>)->ArgsProduct(k_crowds)->Unit(benchmark::kMicrosecond);

BENCHMARK_CAPTURE(find_candidates, fcl, Backend::fcl)->Arg(900)->Arg(4096)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(find_candidates, hybrid, Backend::hybrid)
    ->Arg(900)
    ->Arg(4096)
    ->Arg(16384)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(find_candidates, brute, Backend::brute)->Arg(900)->Arg(4096)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(contacts, fcl, Backend::fcl)->Arg(900)->Arg(4096)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(contacts, hybrid, Backend::hybrid)->Arg(900)->Arg(4096)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(contacts, brute, Backend::brute)->Arg(900)->Arg(4096)->Unit(benchmark::kMicrosecond);

void pose_colliders(benchmark::State& state) {
  const test::ColliderScene scene = test::dancer_scene(0);
  std::vector<Capsule> now(scene.start.size());
  double s = 0.0;
  for (auto _ : state) {
    s = s < 0.9 ? s + 0.1 : 0.1;
    colliders_at(scene.swept(), s, now);
    benchmark::DoNotOptimize(now.data());
  }
}
BENCHMARK(pose_colliders);

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

/// Cloth of 2 cm cells near the same capsules, the greater half of it in touch.
struct ClothQuestions : Questions {
  std::vector<std::array<Vec3, 3>> triangles;
  ClothQuestions() {
    std::mt19937_64 random(2);
    for (const Vec3& point : points)
      triangles.push_back({point, point + test::random_point(random, 0.02), point + test::random_point(random, 0.02)});
  }
};

void one_edge(benchmark::State& state) {
  const ClothQuestions questions;
  for (auto _ : state)
    for (int i = 0; i < 1000; ++i)
      benchmark::DoNotOptimize(
          edge_contact(questions.triangles[i][0], questions.triangles[i][1], questions.capsules[i], Vec3::UnitY()));
  count(state, 1000);
}
BENCHMARK(one_edge);

void one_triangle(benchmark::State& state) {
  const ClothQuestions questions;
  for (auto _ : state)
    for (int i = 0; i < 1000; ++i) {
      const std::array<Vec3, 3>& p = questions.triangles[i];
      benchmark::DoNotOptimize(triangle_contact(p[0], p[1], p[2], questions.capsules[i], Vec3::UnitY()));
    }
  count(state, 1000);
}
BENCHMARK(one_triangle);

/// Ways of 2 cm towards the same capsules, which turn as they come 2 cm nearer.
struct MovingQuestions : ClothQuestions {
  std::vector<Capsule> later;
  std::vector<Vec3> moves;
  MovingQuestions() {
    std::mt19937_64 random(3);
    for (std::size_t i = 0; i < capsules.size(); ++i) {
      const Vec3 out = signed_distance(points[i], capsules[i]).normal;
      capsules[i].radius = std::max(0.01, signed_distance(points[i], capsules[i]).distance + 0.28);
      later.push_back({capsules[i].a + 0.01 * out + test::random_point(random, 0.01),
                       capsules[i].b + 0.01 * out + test::random_point(random, 0.01), capsules[i].radius});
      moves.push_back(test::random_point(random, 0.02) - 0.01 * out);
    }
  }
};

void one_point_sweep(benchmark::State& state) {
  const MovingQuestions questions;
  double touches = 0.0;
  for (auto _ : state) {
    touches = 0.0;
    for (int i = 0; i < 1000; ++i)
      touches += time_of_impact(questions.points[i], questions.points[i] + questions.moves[i], questions.capsules[i],
                                questions.later[i], 0.001)
                     .has_value();
  }
  count(state, 1000);
  state.counters["share_touching"] = touches / 1000;
}
BENCHMARK(one_point_sweep);

void one_triangle_sweep(benchmark::State& state) {
  const MovingQuestions questions;
  double touches = 0.0;
  for (auto _ : state) {
    touches = 0.0;
    for (int i = 0; i < 1000; ++i) {
      std::array<Vec3, 3> to = questions.triangles[i];
      for (Vec3& corner : to) corner += questions.moves[i];
      touches +=
          time_of_impact(questions.triangles[i], to, questions.capsules[i], questions.later[i], 0.001).has_value();
    }
  }
  count(state, 1000);
  state.counters["share_touching"] = touches / 1000;
}
BENCHMARK(one_triangle_sweep);

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
