// Proxies against bodies whose shape is known, and bounds against denser samples.
#include "proxies/distance/capsule_union.h"
#include "proxies/distance/surface_cells.h"
#include "proxies/validate/error_figures.h"
#include "proxies/validate/validate.h"
#include "tests/support/capsule_body.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/nearest_search.h"

#include <gmock/gmock.h>
#include <random>

using namespace tutu;
using namespace tutu::proxies;
using namespace tutu::test;

namespace {

const Capsule k_trunk{{0, 1.0, 0}, {0, 1.4, 0}, 0.12};

CapsuleBody trunk_body() {
  CapsuleBody body;
  body.add(k_trunk, 96, 24, 20);
  return body;
}

/// What chords of the fine trunk lie below its capsule: r (1 - cos(pi / 96)) and as much again across the caps, m.
constexpr double k_chord = 2e-4;

FrameErrors measure(const CapsuleBody& shape, const std::vector<Capsule>& colliders, int samples = 6000,
                    const ValidationEffort& effort = {}) {
  const BodyMesh body(shape.positions, shape.triangles);
  FrameErrors errors;
  measure_frame(body, sample_skin(shape.positions, shape.triangles, samples), colliders, {}, true, effort, errors);
  return errors;
}

double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

double most_over(const FrameErrors& errors) {
  double result = -1.0;
  for (const SurfaceError& e : errors.surface) result = std::max(result, e.distance);
  return result;
}

TEST(Validate, ABodyMadeFromItsProxyHasNoErrorWithinTheBound) {
  const FrameErrors errors = measure(trunk_body(), {k_trunk});
  EXPECT_LE(most(errors.skin), 1e-7); // float vertices
  EXPECT_LE(errors.under.value, 1e-7);
  EXPECT_LE(errors.under.bound, 2e-4);
  EXPECT_LE(most_over(errors), k_chord);
  EXPECT_LE(errors.over.value, k_chord);
  // The same error everywhere is the hardest case: no cell can be left out, so cells of their first size bound it.
  EXPECT_GE(errors.over.bound, errors.over.value);
  EXPECT_LE(errors.over.bound, 0.009);
  EXPECT_THAT(errors.collisions, ::testing::ElementsAre(0));
  EXPECT_THAT(errors.inside, ::testing::IsEmpty());
}

TEST(Validate, ABodyMadeFromAConeHasNoErrorWithinTheBound) {
  const Capsule cone{{0, 1.0, 0}, {0, 1.4, 0}, 0.12, -0.07};
  CapsuleBody shape;
  shape.add(cone, 96, 24, 20);
  const FrameErrors errors = measure(shape, {cone});
  EXPECT_LE(errors.under.value, 1e-7);
  EXPECT_LE(errors.under.bound, 2e-4);
  EXPECT_LE(errors.over.value, k_chord);
  EXPECT_THAT(errors.collisions, ::testing::ElementsAre(0));
  // As a capsule of one radius it would stick out by the taper at the thin end.
  const FrameErrors plain = measure(shape, {Capsule{cone.a, cone.b, cone.radius}});
  EXPECT_NEAR(plain.over.value, 0.07, 2e-3);
}

TEST(Validate, AProxyMovedByTenMillimetresShowsOnBothSides) {
  const Vec3 move(0.010, 0, 0);
  const CapsuleBody shape = trunk_body();
  ValidationEffort effort;
  effort.surface_refinements = 20'000;
  const FrameErrors errors = measure(shape, {{k_trunk.a + move, k_trunk.b + move, k_trunk.radius}}, 6000, effort);
  EXPECT_NEAR(errors.under.value, 0.010, 1e-4);
  EXPECT_NEAR(errors.over.value, 0.010, k_chord + 1e-4);
  EXPECT_GE(errors.under.bound, 0.010 - 1e-6);
  EXPECT_LE(errors.under.bound, 0.010 + 2e-4);
  EXPECT_LE(errors.over.bound, 0.010 + 2.5e-3);

  const SkinSamples samples = sample_skin(shape.positions, shape.triangles, 6000);
  for (std::size_t s = 0; s < samples.size(); ++s) { // under at -x, over at +x
    const rig::Triangle& t = shape.triangles[samples.samples[s].triangle];
    const Vec3& w = samples.samples[s].weights;
    const float x = static_cast<float>(w[0]) * shape.positions[t[0]].x() +
                    static_cast<float>(w[1]) * shape.positions[t[1]].x() +
                    static_cast<float>(w[2]) * shape.positions[t[2]].x();
    if (x < -0.02f) {
      EXPECT_GT(errors.skin[s], 0.0);
    }
    if (x > 0.02f) {
      EXPECT_LT(errors.skin[s], 0.0);
    }
  }
}

TEST(Validate, AMissingArmIsUncovered) {
  const Capsule arm{{0.5, 1.0, 0}, {0.5, 1.4, 0}, 0.04};
  CapsuleBody shape = trunk_body();
  shape.add(arm, 32, 8, 12);
  const auto share_out = [&](const FrameErrors& errors) {
    return static_cast<double>(
               std::count_if(errors.skin.begin(), errors.skin.end(), [](double d) { return d > 0.005; })) /
           static_cast<double>(errors.skin.size());
  };
  EXPECT_EQ(share_out(measure(shape, {k_trunk, arm})), 0.0);
  const FrameErrors missing = measure(shape, {k_trunk});
  EXPECT_GT(share_out(missing), 0.1);
  EXPECT_NEAR(missing.under.value, 0.54 - 0.12, 1e-3); // the arm's far side
}

TEST(Validate, NoDenserSampleExceedsTheBoundOfACoarseOne) {
  std::mt19937_64 random(4);
  ValidationEffort coarse, dense;
  coarse.surface_samples = 60;
  dense.surface_samples = 20'000;
  dense.skin_refinements = dense.surface_refinements = 0;
  CapsuleBody shape;
  shape.add(k_trunk, 12, 3, 4);
  int loose = 0;
  for (int round = 0; round < 8; ++round) {
    std::vector<Capsule> colliders;
    for (int c = 0; c < 3; ++c) {
      const Vec3 centre = Vec3(0, 1.2, 0) + random_point(random, 0.1);
      colliders.push_back({centre, c == 0 ? centre : Vec3(centre + random_point(random, 0.2)), 0.06 + 0.03 * c});
    }
    coarse.skin_refinements = coarse.surface_refinements = 20 * round; // mostly the cells' size decides
    const FrameErrors few = measure(shape, colliders, 10, coarse), many = measure(shape, colliders, 60'000, dense);
    EXPECT_LE(most(many.skin), few.under.bound);
    EXPECT_LE(most_over(many), few.over.bound);
    EXPECT_LE(few.under.value, many.under.bound);
    EXPECT_LE(few.over.value, many.over.bound);
    loose += few.under.bound > few.under.value + 0.002 || few.over.bound > few.over.value + 0.002;
  }
  EXPECT_GE(loose, 4); // representative: the coarse bound is not the value itself
}

TEST(Validate, TheSearchReachesItsGap) {
  CapsuleBody shape;
  shape.add(k_trunk, 12, 3, 4);
  ValidationEffort effort;
  effort.surface_refinements = 20'000;
  const FrameErrors errors = measure(shape, {{{0.02, 1.05, 0}, {-0.01, 1.3, 0.02}, 0.1}}, 100, effort);
  EXPECT_LE(errors.under.bound - errors.under.value, effort.skin_gap * 1.000001);
  EXPECT_LE(errors.over.bound - errors.over.value, effort.surface_gap * 1.000001);
}

TEST(Validate, ReachLeavesOutWhatIsBeyondIt) {
  const Capsule arm{{0.5, 1.0, 0}, {0.5, 1.4, 0}, 0.04};
  CapsuleBody shape = trunk_body();
  shape.add(arm, 32, 8, 12);
  const BodyMesh body(shape.positions, shape.triangles);
  const SkinSamples samples = sample_skin(shape.positions, shape.triangles, 6000);
  const std::vector<Capsule> reach = {{{0, 1.2, 0}, {0, 1.2, 0}, 0.4}};
  FrameErrors errors;
  measure_frame(body, samples, std::vector<Capsule>{k_trunk}, reach, false, {}, errors);
  EXPECT_GT(errors.under.value, 0.3);
  EXPECT_LE(errors.under_in_reach.value, 1e-6);
  EXPECT_LE(errors.under_in_reach.bound, 2e-4);
  int reached = 0;
  for (std::size_t s = 0; s < samples.size(); ++s) reached += errors.skin_in_reach[s];
  EXPECT_GT(reached, 1000);
  EXPECT_LT(reached, static_cast<int>(samples.size()));
}

TEST(Validate, SamplesCoverTheirTriangleWithinTheCellRadius) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const std::vector<Vec3f> corners = {{0, 0, 0}, {0.3f, 0.05f, 0.1f}, {0.1f, 0.2f, -0.1f}};
  const std::vector<rig::Triangle> triangle = {{0, 1, 2}};
  for (const int count : {1, 4, 50, 300}) {
    const SkinSamples samples = sample_skin(corners, triangle, count);
    EXPECT_GE(static_cast<int>(samples.size()), count);
    EXPECT_EQ(static_cast<int>(samples.size()), samples.parts[0] * samples.parts[0]);
    const Vec3 a = corners[0].cast<double>(), b = corners[1].cast<double>(), c = corners[2].cast<double>();
    EXPECT_NEAR(samples.area, 0.5 * (b - a).cross(c - a).norm(), 1e-12);
    const double radius = cell_radius(a, b, c, samples.parts[0]);
    double farthest = 0.0;
    for (int round = 0; round < 2000; ++round) {
      double u = uniform(random), v = uniform(random);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const Vec3 p = (1.0 - u - v) * a + u * b + v * c;
      double nearest = 1e9;
      for (const auto& s : samples.samples)
        nearest = std::min(nearest, (s.weights[0] * a + s.weights[1] * b + s.weights[2] * c - p).norm());
      farthest = std::max(farthest, nearest);
    }
    EXPECT_LE(farthest, radius);
    EXPECT_GE(farthest, 0.5 * radius);
  }
}

TEST(Validate, CellsCoverACapsulesSurfaceWithinTheirRadius) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  for (const Capsule& capsule :
       {Capsule{{0, 0, 0}, {0.1, 0.3, -0.2}, 0.07}, Capsule{{0.1, 0, 0}, {0.1, 0, 0}, 0.1},
        Capsule{{0, 0, 0}, {0.1, 0.3, -0.2}, 0.07, 0.2}, Capsule{{0, 0, 0}, {0.1, 0.3, -0.2}, 0.12, -0.1},
        Capsule{{0, 0, 0}, {0.1, 0.1, 0}, 0.05, 0.2}}) {
    const std::vector<Capsule> one = {capsule};
    for (const int count : {10, 200}) {
      const CapsuleSurface surface(capsule);
      const std::vector<SurfaceCell> cells = surface_cells(one, count);
      double area = 0.0;
      for (const SurfaceCell& cell : cells) area += surface.area(cell);
      EXPECT_NEAR(area, surface.area(), 1e-12);
      const double length = (capsule.b - capsule.a).norm();
      if (capsule.taper == 0.0) {
        EXPECT_NEAR(area, 2.0 * std::numbers::pi * capsule.radius * (length + 2.0 * capsule.radius), 1e-12);
      }
      CapsuleUnion solid;
      solid.assign(one);
      for (const SurfaceCell& cell : cells) EXPECT_NEAR(solid.distance(surface.middle(cell)), 0.0, 1e-12);
      for (int round = 0; round < 500; ++round) { // a random point of the surface
        const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
        const Vec3 from = capsule.a + 2.0 * length * direction + 0.1 * direction;
        const test::Searched nearest = test::search_point(from, capsule);
        const Vec3 p = from - nearest.distance * nearest.normal;
        EXPECT_NEAR(solid.distance(p), 0.0, 1e-12);
        const bool covered = std::any_of(cells.begin(), cells.end(), [&](const SurfaceCell& cell) {
          return (surface.middle(cell) - p).norm() <= surface.radius(cell) + 1e-12;
        });
        EXPECT_TRUE(covered);
      }
    }
  }
}

TEST(Validate, BuriedProxySurfaceDoesNotCount) {
  // A sphere wholly inside the trunk adds nothing; of two that overlap only the outer parts count.
  const FrameErrors alone = measure(trunk_body(), {k_trunk});
  const FrameErrors with_inner = measure(trunk_body(), {k_trunk, {{0, 1.2, 0}, {0, 1.2, 0}, 0.1}});
  for (const SurfaceError& e : with_inner.surface) EXPECT_EQ(e.collider, 0);
  EXPECT_NEAR(with_inner.over.value, alone.over.value, 1e-4);
  EXPECT_THAT(with_inner.inside, ::testing::ElementsAre(1)); // FCL alone would not see it
}

TEST(Validate, VolumesComeOutOfCountedPoints) {
  const BodyMesh body(trunk_body().positions, trunk_body().triangles);
  const Capsule half{k_trunk.a, k_trunk.a, 0.12};
  const double r = 0.12, ball = 4.0 / 3.0 * std::numbers::pi * r * r * r;
  const double trunk = ball + std::numbers::pi * r * r * 0.4;
  VolumeCount sum;
  for (int frame = 0; frame < 4; ++frame) {
    const VolumeCount count = count_volume(body, std::vector<Capsule>{half}, frame * 4096, 4096);
    sum.points += count.points;
    sum.body += count.body;
    sum.proxies += count.proxies;
    sum.both += count.both;
    sum.box = count.box;
  }
  EXPECT_NEAR(sum.body_volume() / trunk, 1.0, 0.01);
  EXPECT_NEAR(sum.proxies_volume() / ball, 1.0, 0.02);
  EXPECT_LE(sum.proxies - sum.both, 30); // chords
}

TEST(Validate, SkinInsideTheBodyIsTold) {
  CapsuleBody shape;
  shape.add(k_trunk, 24, 6, 6);
  const std::size_t outer = shape.triangles.size();
  shape.add({{0, 1.1, 0}, {0, 1.3, 0}, 0.05}, 12, 3, 3);
  const BodyMesh body(shape.positions, shape.triangles);
  const std::vector<char> seen = outer_triangles(body);
  for (std::size_t t = 0; t < seen.size(); ++t) EXPECT_EQ(seen[t], t < outer ? 1 : 0) << t;
}

TEST(ErrorFigures, AreThoseOfTheSortedSamples) {
  std::mt19937_64 random(7);
  std::exponential_distribution<double> exponential(200.0);
  std::vector<std::pair<double, double>> samples; // error, weight
  ErrorGatherer gatherer;
  double weight = 0.0, sum = 0.0, squares = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const double error = k % 3 == 0 ? 0.0 : exponential(random), w = 0.5 + (k % 7);
    samples.emplace_back(error, w);
    gatherer.add(error, w);
    weight += w;
    sum += w * error;
    squares += w * error * error;
  }
  std::sort(samples.begin(), samples.end());
  const auto percentile = [&](double share) {
    double seen = 0.0;
    for (const auto& [error, w] : samples)
      if ((seen += w) >= share * weight) return error;
    return samples.back().first;
  };
  const ErrorFigures figures = gatherer.figures();
  EXPECT_NEAR(figures.mean, sum / weight, 1e-15);
  EXPECT_NEAR(figures.rms, std::sqrt(squares / weight), 1e-15);
  EXPECT_EQ(figures.max, samples.back().first);
  EXPECT_GE(figures.p95, percentile(0.95));
  EXPECT_LE(figures.p95, percentile(0.95) + ErrorGatherer::k_bin);
  EXPECT_GE(figures.p99, percentile(0.99));
  EXPECT_LE(figures.p99, percentile(0.99) + ErrorGatherer::k_bin);
}

TEST(ErrorFigures, OfNothingAreZeroAndFarOnesAreKept) {
  EXPECT_EQ(ErrorGatherer().figures().max, 0.0);
  ErrorGatherer far;
  far.add(50.0, 1.0);
  EXPECT_EQ(far.figures().max, 50.0);
  EXPECT_LE(far.figures().p95, 50.0);
}

} // namespace
