#include "proxies/distance/signed_distance.h"
#include "proxies/fit/detail/refine.h"
#include "proxies/fit/fit.h"
#include "proxies/proxy_file.h"
#include "rig/io/file_io.h"
#include "rig/strong_poses.h"
#include "tests/support/nearest_search.h"
#include "tests/support/paths.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>

namespace tutu::proxies {
namespace {

/// Adds a closed capsule of triangles, of one radius or two, all on one joint.
void add_limb(rig::Character& body, const Capsule& limb, int joint) {
  constexpr int k_around = 24, k_cap = 8, k_side = 12;
  rig::Mesh& mesh = body.mesh;
  const Vec3 along = (limb.b - limb.a).normalized();
  const Vec3 across = along.unitOrthogonal(), third = along.cross(across);
  const double rim = std::asin(cone_sine(limb)), ra = limb.radius_at(0), rb = limb.radius_at(1);
  std::vector<std::pair<double, Vec3>> rings; // radius, and middle
  for (int k = 1; k <= k_cap; ++k) {
    const double angle = (0.5 * std::numbers::pi - rim) * k / k_cap; // from the pole
    rings.emplace_back(ra * std::sin(angle), limb.a - ra * std::cos(angle) * along);
  }
  for (int k = 1; k < k_side; ++k) {
    const double t = static_cast<double>(k) / k_side, radius = limb.radius_at(t);
    rings.emplace_back(radius * std::cos(rim), limb.a + t * (limb.b - limb.a) - radius * std::sin(rim) * along);
  }
  for (int k = k_cap; k >= 1; --k) {
    const double angle = (0.5 * std::numbers::pi + rim) * k / k_cap;
    rings.emplace_back(rb * std::sin(angle), limb.b + rb * std::cos(angle) * along);
  }
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back((limb.a - ra * along).cast<float>());
  for (const auto& [radius, middle] : rings)
    for (int k = 0; k < k_around; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / k_around;
      mesh.positions.push_back(
          Vec3(middle + radius * (std::cos(angle) * across + std::sin(angle) * third)).cast<float>());
    }
  mesh.positions.push_back((limb.b + rb * along).cast<float>());
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  const auto at = [&](std::size_t ring, int k) {
    return first + 1 + static_cast<std::uint32_t>(ring) * k_around + static_cast<std::uint32_t>(k % k_around);
  };
  for (int k = 0; k < k_around; ++k) {
    mesh.triangles.push_back({first, at(0, k + 1), at(0, k)});
    for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring) {
      mesh.triangles.push_back({at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)});
      mesh.triangles.push_back({at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)});
    }
    mesh.triangles.push_back({last, at(rings.size() - 1, k), at(rings.size() - 1, k + 1)});
  }
  for (std::size_t v = first; v < mesh.positions.size(); ++v)
    for (int k = 0; k < 4; ++k) {
      body.skin.slots.push_back(static_cast<std::uint16_t>(k == 0 ? joint : 0));
      body.skin.weights.push_back(k == 0 ? 1.0f : 0.0f);
    }
}

struct Joint {
  std::string name;
  int parent;
  Vec3 at; ///< model space
};

rig::Character body_of(const std::vector<Joint>& joints, const std::vector<std::pair<Capsule, int>>& limbs) {
  rig::Character body;
  body.file = "synthetic";
  for (const Joint& joint : joints) {
    body.skeleton.names.push_back(joint.name);
    body.skeleton.parents.push_back(joint.parent);
    const Vec3 above = joint.parent < 0 ? Vec3(Vec3::Zero()) : joints[joint.parent].at;
    body.skeleton.rest_local.push_back({Quat::Identity(), joint.at - above});
    body.skin.slot_joint.push_back(static_cast<int>(body.skin.slot_joint.size()));
    body.skin.inverse_bind.push_back(Eigen::Affine3d(Eigen::Translation3d(-joint.at)));
  }
  for (const auto& [limb, joint] : limbs) add_limb(body, limb, joint);
  body.mesh.normals = rig::angle_weighted_normals(body.mesh.positions, body.mesh.triangles);
  return body;
}

std::vector<std::vector<Transform>> rest_only(const rig::Character& body) { return {rig::rest_model(body.skeleton)}; }

const Capsule k_limb{{0.1, 0.4, 0.0}, {0.1, 0.9, 0.05}, 0.06};

/// A trunk and two arms, and poses in which the arms turn.
rig::Character small_body() {
  return body_of({{"Hips", -1, {0, 1, 0}}, {"LeftArm", 0, {0.2, 1.3, 0}}, {"RightArm", 0, {-0.2, 1.3, 0}}},
                 {{{{0, 0.9, 0}, {0, 1.4, 0}, 0.12}, 0},
                  {{{0.25, 1.3, 0}, {0.6, 1.2, 0.02}, 0.04}, 1},
                  {{{-0.25, 1.3, 0}, {-0.6, 1.2, 0.02}, 0.04}, 2}});
}

std::vector<std::vector<Transform>> small_poses(const rig::Character& body) {
  std::vector<std::vector<Transform>> poses = rest_only(body);
  for (const double angle : {0.5, -0.7, 1.0}) {
    std::vector<Transform> local = body.skeleton.rest_local;
    local[1].rotation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    poses.emplace_back(local.size());
    rig::model_from_local(body.skeleton, local, poses.back());
  }
  return poses;
}

FitOptions quick(int count) {
  FitOptions options;
  options.count = count;
  options.samples = 800;
  return options;
}

void set(fit::Unit& unit, fit::UnitKind kind, const Vec3& a, const Vec3& b, double radius, const fit::EndSkin& skin_a,
         const fit::EndSkin& skin_b) {
  unit.kind = kind;
  unit.a = a;
  unit.b = b;
  unit.radius_a = unit.radius_b = radius;
  unit.skin_a = skin_a;
  unit.skin_b = skin_b;
}

TEST(Fit, RecoversACapsule) {
  const rig::Character body = body_of({{"Limb", -1, {0.1, 0.4, 0}}}, {{k_limb, 0}});
  const FitResult result = fit_proxies(body, rest_only(body), quick(1));
  ASSERT_EQ(result.proxies.size(), 1u);
  const std::vector<Transform> pose = rig::rest_model(body.skeleton);
  Vec3 a = result.proxies[0].a.place(pose), b = result.proxies[0].b.place(pose);
  if (a.y() > b.y()) std::swap(a, b);
  EXPECT_LT((a - k_limb.a).norm(), 5e-4);
  EXPECT_LT((b - k_limb.b).norm(), 5e-4);
  EXPECT_NEAR(result.proxies[0].radius, k_limb.radius, 5e-4);
  EXPECT_EQ(result.proxies[0].taper, 0.0);
  const FitError error = measure_fit(body, rest_only(body), result.proxies, FitRegion::garment, 2000);
  // Where all cells are alike the bound is the radius of those that the budget leaves.
  EXPECT_LT(error.under.bound, 4e-3);
  EXPECT_LT(error.over.bound, 4e-3);
  EXPECT_LE(error.under.max, error.under.bound);
}

TEST(Fit, RecoversACone) {
  const Capsule cone{{0.1, 0.4, 0.0}, {0.1, 0.9, 0.05}, 0.09, -0.05};
  const rig::Character body = body_of({{"Limb", -1, {0.1, 0.4, 0}}}, {{cone, 0}});
  FitOptions options = quick(1);
  options.tapered = true;
  const FitResult result = fit_proxies(body, rest_only(body), options);
  ASSERT_EQ(result.proxies.size(), 1u);
  const std::vector<Transform> pose = rig::rest_model(body.skeleton);
  const Proxy& proxy = result.proxies[0];
  const bool upright = proxy.taper < 0.0; // a below b
  EXPECT_LT(((upright ? proxy.a : proxy.b).place(pose) - cone.a).norm(), 1e-3);
  EXPECT_LT(((upright ? proxy.b : proxy.a).place(pose) - cone.b).norm(), 1e-3);
  EXPECT_NEAR(std::abs(proxy.taper), 0.05, 1e-3);
  EXPECT_NEAR(std::max(proxy.radius, proxy.radius + proxy.taper), 0.09, 1e-3); // chords lie within
  const FitError error = measure_fit(body, rest_only(body), result.proxies, FitRegion::garment, 2000);
  EXPECT_LT(error.under.p95, 5e-4);
  EXPECT_LT(error.over.p95, 1e-3);
}

TEST(Fit, MeasuresAShiftOnBothSides) {
  const rig::Character body = body_of({{"Limb", -1, {0.1, 0.4, 0}}}, {{k_limb, 0}});
  FitResult result = fit_proxies(body, rest_only(body), quick(1));
  for (Anchor* end : {&result.proxies[0].a, &result.proxies[0].b}) end->points[0].x() += 0.01;
  const FitError error = measure_fit(body, rest_only(body), result.proxies, FitRegion::garment, 2000);
  EXPECT_NEAR(error.under.max, 0.01, 1e-3);
  EXPECT_NEAR(error.over.max, 0.01, 1e-3);
  EXPECT_GE(error.under.bound, 0.0095);
  EXPECT_LT(error.under.bound, 0.0125);
  EXPECT_GE(error.over.bound, 0.0095);
  EXPECT_LT(error.over.bound, 0.0125);
}

TEST(Fit, FindsTwoLimbsAndWhatTheyRideOn) {
  const rig::Character body = small_body();
  const FitResult result = fit_proxies(body, small_poses(body), quick(3));
  ASSERT_EQ(result.proxies.size(), 3u);
  const FitError error = measure_fit(body, small_poses(body), result.proxies, FitRegion::garment, 2000);
  EXPECT_LT(error.under.p95, 1e-3);
  EXPECT_LT(error.over.p95, 1e-3);
}

TEST(Fit, IsAsSymmetricAsTheBody) {
  const rig::Character body = small_body();
  const FitResult result = fit_proxies(body, small_poses(body), quick(9));
  EXPECT_TRUE(result.symmetric);
  const std::vector<Transform> rest = rig::rest_model(body.skeleton);
  for (const Proxy& proxy : result.proxies) {
    const auto mirror = [](const Vec3& v) { return Vec3(-v.x(), v.y(), v.z()); };
    const Vec3 a = mirror(proxy.a.place(rest)), b = mirror(proxy.b.place(rest));
    double least = 1.0;
    for (const Proxy& other : result.proxies) {
      const Vec3 c = other.a.place(rest), d = other.b.place(rest);
      least = std::min(least, std::abs(proxy.radius - other.radius) +
                                  std::min((a - c).norm() + (b - d).norm(), (a - d).norm() + (b - c).norm()));
    }
    EXPECT_LT(least, 1e-9) << proxy.name;
  }
}

TEST(Fit, GivesTheSameBytesEachTime) {
  const rig::Character body = small_body();
  const auto folder = test::scratch_folder();
  for (const char* name : {"one.json", "two.json"})
    write_proxies(folder / name, fit_proxies(body, small_poses(body), quick(7)).proxies, body.skeleton);
  EXPECT_EQ(tutu::read_file(folder / "one.json"), read_file(folder / "two.json"));
}

TEST(Fit, KeepsToTheCount) {
  const rig::Character body = small_body();
  for (const int count : {1, 2, 3, 5, 8}) {
    const FitResult result = fit_proxies(body, rest_only(body), quick(count));
    EXPECT_LE(result.proxies.size(), static_cast<std::size_t>(count));
    EXPECT_GE(result.proxies.size() + 1, static_cast<std::size_t>(count)); // a pair may not fit in
  }
}

TEST(Fit, GrowsUntilTheErrorIsMet) {
  const rig::Character body = small_body();
  FitOptions options = quick(40);
  options.max_error = 0.002;
  const FitResult result = fit_proxies(body, small_poses(body), options);
  EXPECT_TRUE(result.met);
  EXPECT_LT(result.proxies.size(), 40u);
  options.max_error = 1e-7;
  options.count = 4;
  EXPECT_FALSE(fit_proxies(body, small_poses(body), options).met);
}

TEST(Fit, CoversTheSkinToATolerance) {
  const rig::Character body = small_body();
  FitOptions options = quick(3);
  options.cover = 1e-4;
  const FitResult result = fit_proxies(body, small_poses(body), options);
  EXPECT_TRUE(result.met);
  // Points of the measuring's own: between the samples that were covered little can stick out.
  EXPECT_LT(measure_fit(body, small_poses(body), result.proxies, FitRegion::garment, 2000).under.max, 5e-4);
}

TEST(Fit, StopsWhenToldWithTheBestSoFar) {
  const rig::Character body = small_body();
  int asked = 0;
  const FitResult result = fit_proxies(body, small_poses(body), quick(30), [&](double) { return ++asked < 5; });
  EXPECT_TRUE(result.interrupted);
  EXPECT_GE(result.proxies.size(), 1u);
}

TEST(Fit, RefusesWhatItCannotFit) {
  rig::Character body = small_body();
  EXPECT_THROW(fit_proxies(body, rest_only(body), quick(0)), std::invalid_argument);
  EXPECT_THROW(fit_proxies(body, {}, quick(3)), std::invalid_argument);
  EXPECT_THROW(fit_proxies(body, {{}}, quick(3)), std::invalid_argument);
  for (Vec3f& p : body.mesh.positions) p = Vec3f::Ones();
  EXPECT_THROW(fit_proxies(body, rest_only(body), quick(3)), std::invalid_argument);
}

TEST(Fit, DerivativesAreThoseOfTheCost) {
  const rig::Character body = small_body();
  const auto poses = small_poses(body);
  const fit::FitPoints points = fit::sample_skin(body, poses, FitRegion::garment, 600, 1);
  const fit::BodyMotion motion = fit::body_motion(body, poses, true, points.skin);
  const fit::Guard guard(body, poses, {0, 1}, motion);
  fit::Cost cost;
  cost.under = 3.0;
  cost.guard.weight = 0.0; // its slope is that of a grid: only nearly the derivative of its value
  const fit::Problem problem{points.blocks, motion, guard, cost};
  std::vector<fit::Unit> units(3);
  const fit::EndSkin on_hips{1, {0}, {1.0}}, on_arm{1, {1}, {1.0}}, on_both{2, {1, 0}, {0.8, 0.2}};
  set(units[0], fit::UnitKind::middle, {0, 0.95, 0.01}, {0, 1.3, -0.02}, 0.11, on_hips, on_hips);
  set(units[1], fit::UnitKind::pair, {0.28, 1.28, 0.01}, {0.55, 1.22, 0.0}, 0.045, on_both, on_arm);
  set(units[2], fit::UnitKind::across, {0.1, 1.1, 0.0}, {-0.1, 1.1, 0.0}, 0.05, on_hips, on_hips);
  units[0].tapered = units[1].tapered = true;
  units[1].radius_b = 0.03;
  for (fit::Unit& unit : units) unit.settle(motion);
  fit::PosedShapes shapes;
  fit::Nearest nearest;
  const double here = fit::cost_of(problem, units, shapes, nearest);
  EXPECT_GT(here, 0.0);
  std::vector<fit::Hessian> hessians;
  std::vector<fit::Row> gradients;
  fit::accumulate(problem, units, shapes, nearest, hessians, gradients);
  const std::vector<int> owners = nearest.shape;
  int checked = 0;
  for (std::size_t u = 0; u < units.size(); ++u)
    for (int k = 0; k < 8; ++k) {
      bool same_owners = true; // where a point changes its shape within the step, the slope has a kink
      constexpr double k_step = 1e-4;
      double there[2];
      for (const int side : {0, 1}) {
        std::vector<fit::Unit> moved = units;
        double& parameter = k < 3    ? moved[u].a[k]
                            : k < 6  ? moved[u].b[k - 3]
                            : k == 6 ? moved[u].radius_a
                                     : moved[u].radius_b;
        parameter += side ? k_step : -k_step;
        if (moved[u].kind == fit::UnitKind::middle) moved[u].a.x() = moved[u].b.x() = 0.0;
        if (moved[u].kind == fit::UnitKind::across) moved[u].b = fit::mirrored(moved[u].a);
        if (!moved[u].tapered || moved[u].kind == fit::UnitKind::across) moved[u].radius_b = moved[u].radius_a;
        there[side] = fit::cost_of(problem, moved, shapes, nearest);
        same_owners = same_owners && nearest.shape == owners;
      }
      if (!same_owners) continue;
      ++checked;
      const double slope = (there[1] - there[0]) / (2.0 * k_step);
      EXPECT_NEAR(2.0 * gradients[u][k], slope, 2e-3 * (1e-3 + std::abs(slope)) + 2e-6)
          << "unit " << u << ", parameter " << k;
    }
  EXPECT_GE(checked, 16);
}

TEST(Fit, TheNearestShapeIsThatOfAllPairs) {
  const rig::Character body = small_body();
  const auto poses = small_poses(body);
  const fit::FitPoints points = fit::sample_skin(body, poses, FitRegion::garment, 500, 4);
  const fit::BodyMotion motion = fit::body_motion(body, poses, true, points.skin);
  std::vector<fit::Unit> units;
  for (int k = 0; k < 12; ++k) {
    const double u = 0.05 * k;
    const fit::EndSkin on_hips{1, {0}, {1.0}};
    units.emplace_back();
    set(units.back(), k % 2 ? fit::UnitKind::pair : fit::UnitKind::one, {0.1 + u, 0.9 + u, 0.0},
        {0.2 + u, 0.8 + u, 0.1}, 0.03, on_hips, on_hips);
    units.back().radius_b = 0.01 + 0.03 * (k % 3) + (k == 6 ? 0.5 : 0.0); // that one swallows its other end
    units.back().settle(motion);
  }
  fit::PosedShapes shapes;
  shapes.place(units, motion);
  fit::Nearest nearest;
  fit::find_nearest(points.blocks, shapes, true, nearest);
  for (std::size_t i = 0; i < points.blocks.lane_count(); ++i) {
    const int pose = points.blocks.pose[i / fit::k_lanes];
    const Vec3 point(static_cast<double>(points.blocks.x[i]), static_cast<double>(points.blocks.y[i]),
                     static_cast<double>(points.blocks.z[i]));
    std::vector<double> of_unit(units.size(), 1e9);
    for (int s = 0; s < shapes.count; ++s) {
      const double d = test::search_point(point, shapes.capsules[shapes.at(pose, s)], 30).distance;
      of_unit[shapes.unit[s]] = std::min(of_unit[shapes.unit[s]], d);
    }
    std::sort(of_unit.begin(), of_unit.end());
    ASSERT_NEAR(static_cast<double>(nearest.distance[i]), of_unit[0], 1e-6);
    ASSERT_NEAR(static_cast<double>(nearest.second_distance[i]), of_unit[1], 1e-6);
  }
}

TEST(Fit, NoteGoesRoundThroughTheFile) {
  const rig::Character body = small_body();
  const auto folder = test::scratch_folder();
  const FitNote note{"dancer.dae", "dance.json", "garment", 40, {8.5, 30.25, 31.0}, {9.0, 40.0, 41.5}};
  write_proxies(folder / "p.json", fit_proxies(body, rest_only(body), quick(3)).proxies, body.skeleton, note);
  EXPECT_EQ(read_proxies(folder / "p.json", body.skeleton).size(), 3u);
  const auto read = read_fit_note(folder / "p.json");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->motion, "dance.json");
  EXPECT_EQ(read->poses, 40);
  EXPECT_EQ(read->under_mm.max, 30.25);
  EXPECT_EQ(read->over_mm.bound, 41.5);
}

} // namespace
} // namespace tutu::proxies
