// The standard scene is what its formulas say, and its figures are what brute force finds.
#include "proxies/distance/signed_distance.h"
#include "src/measure/frame_metrics.h"
#include "src/study/bench/dancer_skirt.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"

#include "rig/io/file_io.h"

#include <cmath>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

using namespace tutu;
using namespace tutu::app;
using proxies::Capsule;

namespace {

using Proxies = std::array<Capsule, k_dancer_proxies>;

Proxies proxies_at(double t, DancerMotion motion = DancerMotion::dance) {
  Proxies posed;
  pose_dancer(t, motion, posed);
  return posed;
}

double depth(const Vec3& point, std::span<const Capsule> proxies) {
  double deepest = 0.0;
  for (const Capsule& proxy : proxies) {
    const Vec3 axis = proxy.b - proxy.a;
    const double length2 = axis.squaredNorm();
    const double along = length2 > 0.0 ? std::clamp((point - proxy.a).dot(axis) / length2, 0.0, 1.0) : 0.0;
    deepest = std::max(deepest, proxy.radius - (point - proxy.a - along * axis).norm());
  }
  return deepest;
}

/// R = Ry(yaw) Rz(roll), written out.
Vec3 by_matrices(double yaw, double roll, const Vec3& p) {
  Eigen::Matrix3d about_y, about_z;
  about_y << std::cos(yaw), 0, std::sin(yaw), 0, 1, 0, -std::sin(yaw), 0, std::cos(yaw);
  about_z << std::cos(roll), -std::sin(roll), 0, std::sin(roll), std::cos(roll), 0, 0, 0, 1;
  return about_y * (about_z * p);
}

TEST(DancerSkirtScene, HasTwentyCapsulesAndEightSpheres) {
  const Proxies posed = proxies_at(2.3);
  int spheres = 0;
  for (const Capsule& proxy : posed) {
    EXPECT_GT(proxy.radius, 0.0);
    spheres += proxy.a == proxy.b;
  }
  EXPECT_EQ(posed.size(), 28u);
  EXPECT_EQ(spheres, 8);
  for (int k = 20; k < 28; ++k) EXPECT_EQ(posed[k].a, posed[k].b) << k;
}

TEST(DancerSkirtScene, BeginsAtRestAndTheStillDancerStays) {
  EXPECT_EQ(motion_weight(0.0, DancerMotion::dance), 0.0);
  EXPECT_EQ(motion_weight(0.5, DancerMotion::dance), 0.5);
  EXPECT_EQ(motion_weight(1.0, DancerMotion::dance), 1.0);
  EXPECT_EQ(motion_weight(4.0, DancerMotion::dance), 1.0);
  EXPECT_EQ(motion_weight(4.0, DancerMotion::still), 0.0);
  EXPECT_EQ(dancer_pelvis(0.0, DancerMotion::dance).translation, Vec3(0.0, 1.0, 0.0));
  EXPECT_EQ(dancer_pelvis(0.0, DancerMotion::dance).rotation.angularDistance(Quat::Identity()), 0.0);
  const Proxies first = proxies_at(0.0);
  for (const double t : {0.3, 1.7, 5.9}) {
    const Proxies later = proxies_at(t, DancerMotion::still);
    for (int k = 0; k < k_dancer_proxies; ++k) {
      EXPECT_EQ(first[k].a, later[k].a);
      EXPECT_EQ(first[k].b, later[k].b);
    }
  }
}

TEST(DancerSkirtScene, TheBodyIsWhereTheLawSaysAtOneMoment) {
  // t = 7/3 s: S(0.5, 0) = sin(7 pi/3), S(1, 0) = sin(14 pi/3), S(0.25, 0) = sin(7 pi/6) and a thigh swing of
  // sin(3.5 pi) = -1, all written from the law by hand.
  const double t = 7.0 / 3.0, root = std::sqrt(3.0) / 2.0;
  const Vec3 pelvis(0.10 * root, 1.0 + 0.02 * root, 0.05 * -0.5);
  const double yaw = 0.8 * root, roll = 0.12 * root;
  const double thigh = 0.15 - 0.75, bend = 0.5; // cos(3.5 pi) = 0
  const Vec3 hip(0.10, -0.05, 0.0);
  const Vec3 knee = hip + 0.42 * Vec3(std::sin(0.1), -std::cos(0.1) * std::cos(thigh), std::cos(0.1) * std::sin(thigh));
  const Vec3 ankle = knee + 0.40 * Vec3(0.0, -std::cos(thigh - bend), std::sin(thigh - bend));
  const Vec3 right_wrist(-0.60, 0.45 - 0.12 * root, 0.05); // half a period later
  const Proxies posed = proxies_at(t);
  const auto expect_near = [&](const Vec3& found, const Vec3& local) {
    EXPECT_LT((found - (pelvis + by_matrices(yaw, roll, local))).norm(), 1e-12);
  };
  expect_near(posed[0].a, Vec3(0.08, 0.0, 0.0));
  expect_near(posed[6].a, hip);
  expect_near(posed[6].b, knee);
  expect_near(posed[7].b, ankle);
  expect_near(posed[8].b, ankle + Vec3(0.0, -0.04, 0.14));
  expect_near(posed[16].b, right_wrist);
  expect_near(posed[19].b, Vec3(0.0, 0.70, 0.01));
  expect_near(posed[26].a, knee);
}

TEST(DancerSkirtScene, TheFastestProxyPointMovesAt3_59MetresASecond) {
  const double step = 1e-4;
  double fastest = 0.0;
  Proxies before = proxies_at(0.0);
  for (int k = 1; k <= 60000; ++k) {
    const Proxies now = proxies_at(k * step);
    for (int p = 0; p < k_dancer_proxies; ++p) // straight segments: an end is the fastest point
      fastest = std::max({fastest, (now[p].a - before[p].a).norm(), (now[p].b - before[p].b).norm()});
    before = now;
  }
  EXPECT_NEAR(fastest / step, 3.59, 0.02);
}

TEST(DancerSkirtScene, TheSkirtStartsSevenMillimetresClear) {
  const Proxies posed = proxies_at(0.0);
  for (const int n : {30, 64, 128}) {
    const cloth::Garment skirt = dancer_skirt(n);
    double clearance = 1.0;
    for (const Vec3& p : skirt.rest_positions)
      for (const Capsule& proxy : posed) clearance = std::min(clearance, proxies::signed_distance(p, proxy).distance);
    EXPECT_GE(clearance, 0.007) << n;
  }
}

TEST(DancerSkirtScene, TheSkirtIsTheStatedGrid) {
  const int n = 30;
  const cloth::Garment skirt = dancer_skirt(n);
  ASSERT_EQ(skirt.particle_count(), n * n);
  double mass = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double s = static_cast<double>(i) / (n - 1), r = 0.20 + 0.22 * s;
      const double angle = 2.0 * std::numbers::pi * j / n;
      const Vec3 place(r * std::sin(angle), 1.0 + 0.10 - 0.60 * s, r * std::cos(angle));
      EXPECT_LT((skirt.rest_positions[i * n + j] - place).norm(), 1e-14);
      EXPECT_EQ(skirt.masses[i * n + j], 0.3 / (n * n));
      mass += skirt.masses[i * n + j];
    }
  EXPECT_NEAR(mass, 0.3, 1e-12);

  EXPECT_EQ(skirt.structural_count, n * n + (n - 1) * n);
  for (int k = 0; k < skirt.structural_count; ++k) {
    const cloth::Spring& edge = skirt.springs[k];
    EXPECT_EQ(edge.rest_length, (skirt.rest_positions[edge.i] - skirt.rest_positions[edge.j]).norm());
  }
  ASSERT_EQ(skirt.pins.size(), static_cast<std::size_t>(n));
  for (int j = 0; j < n; ++j) EXPECT_EQ(skirt.pins[j].particle, j);

  std::vector<std::array<std::uint32_t, 3>> split;
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto at = [n](int row, int column) { return static_cast<std::uint32_t>(row * n + column % n); };
      split.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      split.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  EXPECT_EQ(skirt.triangles, split);
}

TEST(DancerSkirtScene, TheWaistFollowsThePelvis) {
  DancerSkirtSetup setup;
  setup.n = 12;
  setup.substeps = 16;
  setup.backend = proxies::Backend::brute;
  DancerSkirt scene(setup);
  for (int frame = 0; frame < 40; ++frame) ASSERT_FALSE(scene.advance());
  const double t = 40.0 / 60.0, u = t * t * (3.0 - 2.0 * t), turn = 2.0 * std::numbers::pi * t;
  const double yaw = 0.8 * u * std::sin(0.5 * turn), roll = 0.12 * u * std::sin(turn);
  const Vec3 pelvis(0.10 * u * std::sin(0.5 * turn), 1.0 + 0.02 * u * std::sin(turn), 0.05 * u * std::sin(0.25 * turn));
  for (int j = 0; j < 12; ++j) {
    const double angle = 2.0 * std::numbers::pi * j / 12;
    const Vec3 local(0.20 * std::sin(angle), 0.10, 0.20 * std::cos(angle));
    EXPECT_LT((scene.particles().positions[j] - (pelvis + by_matrices(yaw, roll, local))).norm(), 1e-12);
  }
  const Proxies posed = proxies_at(t);
  for (int k = 0; k < k_dancer_proxies; ++k) EXPECT_EQ(scene.proxies()[k].a, posed[k].a);
}

TEST(DancerSkirtScene, TheSameRunTwiceIsTheSameToTheBit) {
  std::uint64_t hashes[2];
  for (std::uint64_t& hash : hashes) {
    DancerSkirt scene({});
    for (int frame = 0; frame < 5; ++frame) ASSERT_FALSE(scene.advance());
    hash = cloth::state_hash(scene.particles());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(DancerSkirtScene, StartsUnevenUnlessAskedNotTo) {
  DancerSkirtSetup setup;
  EXPECT_EQ(setup.uneven_mm, 0.1);
  const DancerSkirt uneven(setup), again(setup);
  EXPECT_EQ(cloth::state_hash(uneven.particles()), cloth::state_hash(again.particles()));
  const std::vector<Vec3>& rest = uneven.skirt().rest_positions;
  double most = 0.0;
  for (int i = 0; i < 30 * 30; ++i) {
    const Vec3 off = uneven.particles().positions[i] - rest[i];
    if (i < 30) {
      EXPECT_EQ(off, Vec3::Zero()) << "pinned";
    }
    most = std::max(most, off.cwiseAbs().maxCoeff());
  }
  EXPECT_LE(most, 1e-4 + 1e-6) << "kernels keep floats";
  EXPECT_GT(most, 0.99e-4);
  setup.seed = 2;
  EXPECT_NE(cloth::state_hash(DancerSkirt(setup).particles()), cloth::state_hash(uneven.particles()));
  setup.uneven_mm = 0.0;
  EXPECT_EQ(DancerSkirt(setup).particles().positions, rest);
}

TEST(DancerSkirtScene, StepsThatAreTooLongAreADivergence) {
  DancerSkirtSetup setup;
  setup.solver = cloth::SolverKind::mass_spring;
  setup.substeps = 1;
  setup.backend = proxies::Backend::fcl;
  DancerSkirt scene(setup);
  bool diverged = false;
  for (int frame = 0; frame < 120 && !diverged; ++frame) diverged = scene.advance().has_value();
  EXPECT_TRUE(diverged);
}

TEST(BenchMetrics, AgreeWithBruteForce) {
  const int n = 16;
  const cloth::Garment skirt = dancer_skirt(n);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.03);
  const auto shaken = [&] {
    std::vector<Vec3> positions = skirt.rest_positions;
    for (Vec3& p : positions)
      p = Vec3(0.8 * p.x(), p.y(), 0.8 * p.z()) + Vec3(noise(random), noise(random), noise(random));
    return positions;
  };
  cloth::Particles now;
  now.positions = shaken();
  now.velocities.assign(now.positions.size(), Vec3::Zero());
  const std::vector<Vec3> last = shaken(), before_last = shaken();
  const Proxies posed = proxies_at(1.9);
  const FrameMetrics m = measure_frame(ClothProbe(skirt), now.positions, last, before_last, posed, 1.0 / 60.0);

  const auto at = [&](int row, int column) { return now.positions[row * n + column % n]; };
  const auto rest = [&](int row, int column) { return skirt.rest_positions[row * n + column % n]; };
  double pen_max = 0.0, pen_sum = 0.0, jitter = 0.0, hem = 0.0;
  int deep = 0;
  std::vector<double> strains;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (i + 1 < n) strains.push_back((at(i + 1, j) - at(i, j)).norm() / (rest(i + 1, j) - rest(i, j)).norm() - 1.0);
      if (i == 0) continue;
      strains.push_back((at(i, j + 1) - at(i, j)).norm() / (rest(i, j + 1) - rest(i, j)).norm() - 1.0);
      const double d = depth(at(i, j), posed);
      pen_max = std::max(pen_max, d);
      pen_sum += d;
      deep += d > 0.001;
      jitter += (at(i, j) - 2.0 * last[i * n + j] + before_last[i * n + j]).norm() * 3600.0;
      if (i == n - 1) hem += at(i, j).y();
    }
  const int free = n * (n - 1);
  EXPECT_GT(deep, free / 10);
  EXPECT_LT(deep, free - free / 10);
  EXPECT_NEAR(m.pen_max, pen_max, 1e-12);
  EXPECT_NEAR(m.pen_mean, pen_sum / free, 1e-12);
  EXPECT_NEAR(m.pen_share, static_cast<double>(deep) / free, 1e-12);
  EXPECT_NEAR(m.jitter, jitter / free, 1e-9);
  EXPECT_NEAR(m.hem_y, hem / n, 1e-12);

  std::sort(strains.begin(), strains.end());
  const std::size_t count = strains.size(), rank = (99 * count + 99) / 100;
  double longer = 0.0, shorter = 0.0;
  for (const double strain : strains) (strain > 0.0 ? longer : shorter) += std::abs(strain);
  EXPECT_NEAR(m.strains.longer.max, strains.back(), 1e-12);
  EXPECT_NEAR(m.strains.longer.p99, strains[rank - 1], 1e-12);
  EXPECT_NEAR(m.strains.longer.mean, longer / static_cast<double>(count), 1e-12);
  EXPECT_NEAR(m.strains.shorter.max, -strains.front(), 1e-12);
  EXPECT_NEAR(m.strains.shorter.p99, -strains[count - rank], 1e-12);
  EXPECT_NEAR(m.strains.shorter.mean, shorter / static_cast<double>(count), 1e-12);
  EXPECT_GT(m.strains.held_longer.max, 0.0) << "the first row is shaken, too";

  double cen_max = 0.0, cen_sum = 0.0, surf = 0.0;
  for (const auto& t : skirt.triangles) {
    const Vec3 &a = now.positions[t[0]], &b = now.positions[t[1]], &c = now.positions[t[2]];
    const double d = depth((a + b + c) / 3.0, posed);
    cen_max = std::max(cen_max, d);
    cen_sum += d;
    int samples = 0;
    for (int i = 0; i <= 6; ++i)
      for (int j = 0; j <= 6 - i; ++j, ++samples) {
        double solved = 0.0; // share of corners below the first row
        for (const auto& [corner, part] : {std::pair(t[0], 6 - i - j), std::pair(t[1], i), std::pair(t[2], j)})
          if (corner >= static_cast<std::uint32_t>(n)) solved += part;
        if (solved > 0.0) surf = std::max(surf, depth(a + i / 6.0 * (b - a) + j / 6.0 * (c - a), posed));
      }
    ASSERT_EQ(samples, k_surface_samples);
  }
  EXPECT_NEAR(m.cen_max, cen_max, 1e-12);
  EXPECT_NEAR(m.cen_mean, cen_sum / static_cast<double>(skirt.triangles.size()), 1e-12);
  EXPECT_NEAR(m.surface, surf, 1e-12);
  EXPECT_GE(m.surface, m.cen_max);
}

TEST(BenchMetrics, OneTriangleInOneSphere) {
  // A sphere just above the middle of a cell's first triangle: only its inside touches, no particle does.
  const cloth::Garment skirt = dancer_skirt(8);
  const auto& t = skirt.triangles[60];
  const Vec3 &a = skirt.rest_positions[t[0]], &b = skirt.rest_positions[t[1]], &c = skirt.rest_positions[t[2]];
  const Vec3 centroid = (a + b + c) / 3.0, normal = (b - a).cross(c - a).normalized();
  const Vec3 centre = centroid + 0.006 * normal;
  const std::array<Capsule, 1> sphere = {Capsule{centre, centre, 0.01}};
  const std::vector<Vec3>& rest = skirt.rest_positions;
  const FrameMetrics m = measure_frame(ClothProbe(skirt), rest, rest, rest, sphere, 1.0 / 60.0);
  EXPECT_EQ(m.pen_max, 0.0);
  EXPECT_NEAR(m.cen_max, 0.004, 1e-12);
  EXPECT_NEAR(m.surface, 0.004, 1e-12);
  EXPECT_EQ(m.strains.longer.max, 0.0);
  EXPECT_EQ(m.strains.shorter.max, 0.0);
  EXPECT_EQ(m.jitter, 0.0);
  EXPECT_NEAR(m.hem_y, 0.5, 1e-12);
}

TEST(BenchMetrics, ARunIsSummarisedOverItsFrames) {
  std::vector<FrameMetrics> frames(3);
  frames[0].pen_max = 0.002, frames[1].pen_max = 0.005, frames[2].pen_max = 0.001;
  frames[0].pen_mean = 0.3, frames[1].pen_mean = 0.6, frames[2].pen_mean = 0.0;
  frames[2].strains.longer = {0.25, 0.12, 0.03};
  frames[1].jitter = 6.0;
  const std::vector<double> ms = {3.0, 1.0, 2.0};
  const RunMetrics run = summarise(frames, ms);
  EXPECT_EQ(run.frames, 3);
  EXPECT_EQ(run.pen.max, 0.005);
  EXPECT_EQ(run.pen.median, 0.002);
  EXPECT_NEAR(run.pen_mean, 0.3, 1e-15);
  EXPECT_EQ(run.longer.worst.max, 0.25);
  EXPECT_EQ(run.longer.worst.median, 0.0);
  EXPECT_NEAR(run.longer.p99, 0.04, 1e-15);
  EXPECT_NEAR(run.longer.mean, 0.01, 1e-15);
  EXPECT_EQ(run.jitter, 2.0);
  EXPECT_EQ(run.ms_median, 2.0);
  EXPECT_EQ(run.ms_p99, 3.0);
  EXPECT_EQ(summarise({}, {}).frames, 0);
}

TEST(BenchProgram, WritesItsFigures) {
  const auto folder = test::scratch_folder();
  const std::string file = (folder / "figures.json").string();
  const test::Outcome outcome =
      test::run_program({"bench", "dancer-skirt", "--n", "30", "--frames", "70", "--json", file});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, ::testing::HasSubstr("30 x 30 particles"));
  const nlohmann::json figures = nlohmann::json::parse(read_file(file));
  EXPECT_EQ(figures.at("name"), "dancer-skirt");
  EXPECT_EQ(figures.at("n"), 30);
  EXPECT_EQ(figures.at("solver"), "xpbd");
  EXPECT_EQ(figures.at("substeps"), 3);
  EXPECT_EQ(figures.at("backend"), "hybrid");
  EXPECT_EQ(figures.at("frames"), 70);
  EXPECT_EQ(figures.at("measured_frames"), 10);
  EXPECT_EQ(figures.at("diverged"), false);
  EXPECT_EQ(figures.at("state_hash").get<std::string>().size(), 16u);
  for (const char* pointer : {"/pen_mm/max",
                              "/pen_mm/median",
                              "/pen_mm/mean",
                              "/pen_mm/share_over_1mm",
                              "/cen_mm/max",
                              "/cen_mm/median",
                              "/cen_mm/mean",
                              "/surface_mm/max",
                              "/surface_mm/median",
                              "/longer_pct/max",
                              "/longer_pct/median",
                              "/longer_pct/p99",
                              "/longer_pct/mean",
                              "/shorter_pct/max",
                              "/held_longer_pct/max",
                              "/end/garments/0/longer_pct",
                              "/end/garments/0/surface_mm/proxies",
                              "/uneven_mm",
                              "/seed",
                              "/jitter",
                              "/hem_y",
                              "/ms/median",
                              "/ms/p99",
                              "/ns_per_particle_substep"})
    EXPECT_TRUE(figures.at(nlohmann::json::json_pointer(pointer)).is_number()) << pointer;
  std::filesystem::remove_all(folder);
}

TEST(BenchProgram, DivergenceIsStatus1AndStillWritten) {
  const auto folder = test::scratch_folder();
  const std::string file = (folder / "figures.json").string();
  const test::Outcome outcome = test::run_program(
      {"bench", "dancer-skirt", "--n", "30", "--solver", "mass_spring", "--substeps", "1", "--json", file});
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_THAT(outcome.output, ::testing::HasSubstr("skirt diverged in frame"));
  EXPECT_EQ(nlohmann::json::parse(read_file(file)).at("diverged"), true);
  std::filesystem::remove_all(folder);
}

TEST(BenchProgram, RefusesWhatIsNotThere) {
  const test::Outcome unknown = test::run_program({"bench", "dancer-trousers"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.output, ::testing::HasSubstr("dancer-skirt"));
  EXPECT_EQ(test::run_program({"bench"}).status, 2);
  EXPECT_EQ(test::run_program({"bench", "dancer-skirt", "--n", "3"}).status, 2);
  EXPECT_EQ(test::run_program({"bench", "dancer-skirt", "--solver", "magic"}).status, 2);
  EXPECT_EQ(test::run_program({"bench", "dancer-skirt", "--frames", "60"}).status, 2);
}

} // namespace
