// The body's distance and side against every triangle, and what the nearest thing is.
#include "proxies/body/body_mesh.h"
#include "proxies/body/point_triangle.h"
#include "rig/character.h"
#include "rig/import/import.h"
#include "tests/support/brute_mesh.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/paths.h"
#include "tests/support/solids.h"

#include <gtest/gtest.h>
#include <limits>
#include <thread>

using namespace tutu;
using namespace tutu::proxies;
using namespace tutu::test;

namespace {

constexpr double k_anywhere = std::numeric_limits<double>::infinity();

Surface surface_of(const std::filesystem::path& file) {
  const rig::Mesh mesh = rig::import_character(file).character.mesh;
  return {mesh.positions, mesh.triangles};
}

BodyMesh body_of(const Surface& surface) { return {surface.positions, surface.triangles}; }

/// A third anywhere in the box about the body, a third some centimetres from a vertex, a third some micrometres to
/// millimetres from a triangle.
std::vector<Vec3> points_about(const BodyMesh& body, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Box box;
  for (const Vec3& p : body.positions()) box.extend(p);
  const double size = box.sizes().maxCoeff();
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const rig::Triangle& t = body.triangles()[random() % body.triangles().size()];
    const Vec3 &a = body.positions()[t[0]], &b = body.positions()[t[1]], &c = body.positions()[t[2]];
    if (i % 3 == 0) {
      points.push_back(box.min() + box.sizes().cwiseProduct(Vec3(uniform(random), uniform(random), uniform(random))));
    } else if (i % 3 == 1) {
      points.push_back(a + 0.015 * size * Vec3(gauss(random), gauss(random), gauss(random)));
    } else {
      const double u = uniform(random), v = (1.0 - u) * uniform(random);
      const double height = (i % 2 ? size : -size) * std::pow(10.0, -6.0 + 3.0 * uniform(random));
      points.push_back(a + u * (b - a) + v * (c - a) + height * (b - a).cross(c - a).normalized());
    }
  }
  return points;
}

/// Distance to 1e-9 of itself, side right, and the contact's convention; on `count` points.
void expect_as_brute_force(const Surface& surface, int count) {
  const BodyMesh body = body_of(surface);
  const BruteMesh brute(body.positions(), body.triangles());
  int inside = 0, on_inner_shells = 0, asked = 0;
  for (const Vec3& point : points_about(body, count, 1)) {
    const double distance = brute.distance(point);
    const std::optional<MeshPoint> found = body.nearest(point, k_anywhere);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, distance, 1e-9 * distance) << point.transpose();
    const rig::Triangle& t = body.triangles()[found->triangle];
    const Vec3 on = found->weights[0] * body.positions()[t[0]] + found->weights[1] * body.positions()[t[1]] +
                    found->weights[2] * body.positions()[t[2]];
    EXPECT_LT((on - found->closest).norm(), 1e-14);
    EXPECT_GE(found->weights.minCoeff(), 0.0);

    const double winding = body.winding_number(point); // exact: every triangle's solid angle
    if (asked++ % 20 == 0) {
      EXPECT_NEAR(winding, brute.winding_number(point), 1e-6) << point.transpose();
    }
    if (body.census().open_edges == 0) {
      EXPECT_NEAR(winding, std::round(winding), 1e-6) << point.transpose();
    }
    const Contact contact = body.signed_distance(point);
    ASSERT_EQ(contact.distance<0.0, winding> 0.5)
        << point.transpose() << ", distance " << contact.distance << ", winding number " << winding;
    EXPECT_EQ(body.is_inside(point), winding > 0.5);
    if (std::abs(std::abs(contact.distance) - distance) > 1e-9 * distance) {
      EXPECT_GT(body.census().inner_shells, 0);
      EXPECT_GT(winding, 0.5);
      EXPECT_GT(-contact.distance, distance);
      ++on_inner_shells;
    }
    EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
    EXPECT_LT((contact.closest + contact.distance * contact.normal - point).norm(), 1e-12);
    inside += contact.distance < 0.0;
  }
  EXPECT_GT(inside, 0.25 * count);
  EXPECT_LT(inside, 0.75 * count);
  EXPECT_EQ(on_inner_shells > 0, body.census().inner_shells > 0);
}

TEST(BodyMesh, ClosedSurfaceIsAsBruteForce) {
  std::mt19937_64 random(2);
  const Surface spiky = spiky_surface(random), torus = torus_surface(0.5, 0.2, 24, 12);
  EXPECT_EQ(body_of(spiky).census().rule, SideRule::pseudonormal);
  EXPECT_EQ(body_of(torus).census().rule, SideRule::pseudonormal);
  expect_as_brute_force(spiky, 1000);
  expect_as_brute_force(torus, 1000);
}

TEST(BodyMesh, ClosedSurfaceIsAsBruteForce_slow) {
  std::mt19937_64 random(2);
  expect_as_brute_force(spiky_surface(random), 10000);
  expect_as_brute_force(torus_surface(0.5, 0.2, 24, 12), 10000);
}

TEST(BodyMesh, DancerIsAsBruteForce) {
  expect_as_brute_force(surface_of(source_file("assets/characters/dancer.dae")), 45);
}

TEST(BodyMesh, DancerIsAsBruteForce_slow) {
  expect_as_brute_force(surface_of(source_file("assets/characters/dancer.dae")), 10000);
}

TEST(BodyMesh, OpenHumanIsAsBruteForce) { expect_as_brute_force(surface_of(assimp_model("X/BCN_Epileptic.X")), 150); }

TEST(BodyMesh, OpenHumanIsAsBruteForce_slow) {
  expect_as_brute_force(surface_of(assimp_model("X/BCN_Epileptic.X")), 10000);
}

TEST(BodyMesh, HumansAreAsBruteForce_slow) {
  for (const char* name : {"human-female.dae", "human-male.dae"}) {
    if (!exists(human(name))) GTEST_SKIP() << "no human test characters beside the checkout";
    expect_as_brute_force(surface_of(human(name)), 10000);
  }
}

TEST(BodyMesh, TheDancersJointSpheresAreInside) {
  const rig::Mesh mesh = rig::import_character(source_file("assets/characters/dancer.dae")).character.mesh;
  const BodyMesh body(mesh.positions, mesh.triangles);
  EXPECT_EQ(body.census().rule, SideRule::winding_number);
  EXPECT_EQ(body.census().open_edges, 0);
  ASSERT_EQ(mesh.parts.size(), 2u);
  const rig::MeshPart& spheres = mesh.parts[1];
  int deep = 0;
  for (std::uint32_t t = spheres.first_triangle; t < spheres.first_triangle + spheres.triangle_count; t += 80) {
    Vec3 middle = Vec3::Zero(); // each has 80 triangles
    for (std::uint32_t k = t; k < t + 80; ++k)
      for (const std::uint32_t v : mesh.triangles[k]) middle += mesh.positions[v].cast<double>() / 240.0;
    EXPECT_TRUE(body.is_inside(middle));
    const double winding = body.winding_number(middle);
    EXPECT_NEAR(winding, std::round(winding), 1e-9);
    deep += winding > 1.5;
    EXPECT_LE(body.signed_distance(middle).distance, -body.nearest(middle, k_anywhere)->distance);
  }
  EXPECT_GE(deep, body.census().inner_shells);
}

TEST(BodyMesh, NearestFeatures) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  const auto expect = [&](const Vec3& point, MeshFeature feature, const Vec3& closest) {
    const MeshPoint found = nearest_on_triangle(point, a, b, c);
    EXPECT_EQ(static_cast<int>(found.feature), static_cast<int>(feature)) << point.transpose();
    EXPECT_LT((found.closest - closest).norm(), 1e-15);
    EXPECT_NEAR(found.distance, (point - closest).norm(), 1e-15);
    EXPECT_LT((found.weights[0] * a + found.weights[1] * b + found.weights[2] * c - closest).norm(), 1e-15);
  };
  expect({1, 1, 2}, MeshFeature::face, {1, 1, 0});
  expect({1, 1, 0}, MeshFeature::face, {1, 1, 0});
  expect({2, -1, 1}, MeshFeature::edge_ab, {2, 0, 0});
  expect({-1, 1, -1}, MeshFeature::edge_ca, {0, 1, 0});
  expect(Vec3(2, 1.5, 0) + Vec3(3, 4, 5), MeshFeature::edge_bc, {2, 1.5, 0});
  expect({-1, -1, 1}, MeshFeature::vertex_a, a);
  expect({6, -1, 0}, MeshFeature::vertex_b, b);
  expect({-1, 5, 1}, MeshFeature::vertex_c, c);
  for (const Vec3& flat : {Vec3(2, 0, 0), Vec3(9, 0, 0), Vec3(0, 0, 0)}) { // a b c on a line, and twice the same corner
    const MeshPoint found = nearest_on_triangle({3, 2, 0}, a, b, flat);
    EXPECT_DOUBLE_EQ(found.distance, 2.0);
    EXPECT_LT((found.closest - Vec3(3, 0, 0)).norm(), 1e-15);
  }
  EXPECT_EQ(nearest_on_triangle({3, 2, 0}, a, a, a).distance, Vec3(3, 2, 0).norm());
}

TEST(BodyMesh, AnyFeatureTellsTheSide) {
  // From every vertex, edge and face of ridges and valleys, a little way along the pseudonormal and against it.
  std::mt19937_64 random(3);
  const Surface spiky = spiky_surface(random);
  const BodyMesh body = body_of(spiky);
  std::array<int, 7> seen = {};
  for (const rig::Triangle& t : spiky.triangles) {
    const Vec3 a = body.positions()[t[0]], b = body.positions()[t[1]], c = body.positions()[t[2]];
    for (const Vec3& on :
         {a, b, c, Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)), Vec3(0.5 * (c + a)), Vec3((a + b + c) / 3.0)})
      for (const double height : {1e-3, -1e-3, 1e-6, -1e-6, 1e-8, -1e-8}) {
        const Vec3 normal = body.signed_distance(on).normal; // on the surface: its pseudonormal
        const Vec3 point = on + height * normal;
        const Contact contact = body.signed_distance(point);
        EXPECT_EQ(contact.distance > 0.0, height > 0.0) << point.transpose();
        ++seen[static_cast<std::size_t>(body.nearest(point, k_anywhere)->feature)];
      }
  }
  for (const int count : seen) EXPECT_GT(count, 100);
}

TEST(BodyMesh, TheWindingNumbersThresholdIsRightCloseToAnOpenSurface) {
  // A sphere with a hole in its bottom: just off the surface the winding number leaps by 1 across 1/2 wherever the hole
  // looks smaller than a half space.
  Surface bowl = sphere_surface(0.2, 4);
  std::erase_if(bowl.triangles, [&](const rig::Triangle& t) { return bowl.positions[t[0]].y() < -0.15f; });
  const BodyMesh body = body_of(bowl);
  ASSERT_EQ(body.census().rule, SideRule::winding_number);
  ASSERT_GT(body.census().open_edges, 0);
  for (std::size_t i = 0; i < bowl.triangles.size(); ++i) {
    const rig::Triangle& t = bowl.triangles[i];
    const Vec3 a = body.positions()[t[0]], b = body.positions()[t[1]], c = body.positions()[t[2]];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    for (const double height : {1e-3, 1e-6, 1e-9, 1e-12})
      for (const Vec3& on : {Vec3((a + b + c) / 3.0), Vec3(0.4 * a + 0.6 * b), Vec3(0.98 * a + 0.01 * b + 0.01 * c)}) {
        EXPECT_TRUE(body.is_inside(on - height * normal)) << i << ", " << height;
        EXPECT_FALSE(body.is_inside(on + height * normal)) << i << ", " << height;
      }
  }
}

TEST(BodyMesh, WithinIsABound) {
  const BodyMesh body = body_of(sphere_surface(1.0, 3));
  const Vec3 point(1.5, 0.2, 0.1);
  const double distance = body.nearest(point, k_anywhere)->distance;
  EXPECT_FALSE(body.nearest(point, distance));
  ASSERT_TRUE(body.nearest(point, distance * (1.0 + 1e-12)));
  EXPECT_EQ(body.nearest(point, distance * (1.0 + 1e-12))->distance, distance);
  EXPECT_FALSE(body.nearest(point, 0.0));
}

TEST(BodyMesh, ARefittedTreeAnswersAsAFreshOne) {
  Surface torus = torus_surface(0.5, 0.2, 60, 30);
  append(torus, sphere_surface(0.1, 2, {0.5f, 0.0f, 0.0f})); // dipoles too
  BodyMesh moved = body_of(torus);
  Surface posed = torus;
  for (int frame = 1; frame <= 6; ++frame) {
    for (std::size_t v = 0; v < posed.positions.size(); ++v) { // bent, twisted, carried away
      const Vec3f& p = torus.positions[v];
      const float turn = 0.25f * static_cast<float>(frame) * p.y() + 0.1f * static_cast<float>(frame);
      posed.positions[v] = Eigen::AngleAxisf(turn, Vec3f::UnitY()) * p +
                           0.05f * static_cast<float>(frame) * Vec3f(1.0f, p.x() * p.x(), 0.0f);
    }
    moved.pose(posed.positions);
    const BodyMesh fresh = body_of(posed);
    for (const Vec3& point : points_about(fresh, 200, static_cast<std::uint64_t>(frame))) {
      // Of two triangles that share the nearest edge either may be found, a rounding apart.
      EXPECT_NEAR(moved.nearest(point, k_anywhere)->distance, fresh.nearest(point, k_anywhere)->distance, 1e-14);
      EXPECT_EQ(moved.is_inside(point), fresh.is_inside(point));
      EXPECT_EQ(moved.winding_number(point), fresh.winding_number(point));
    }
  }
}

TEST(BodyMesh, ManyThreadsMayAskAtOnce) {
  const BodyMesh body = body_of(surface_of(assimp_model("X/BCN_Epileptic.X")));
  const std::vector<Vec3> points = points_about(body, 600, 7);
  const auto ask = [&] {
    std::vector<double> answers;
    for (const Vec3& point : points) {
      answers.push_back(body.signed_distance(point).distance);
      answers.push_back(body.nearest(point, 0.05) ? 1.0 : 0.0);
    }
    for (int i = 0; i < 20; ++i)
      answers.push_back(static_cast<double>(body.hits({points[i], points[i + 1], 0.03}).triangles.size()));
    return answers;
  };
  const std::vector<double> alone = ask();
  std::array<std::vector<double>, 4> together;
  std::vector<std::thread> threads;
  for (auto& answers : together) threads.emplace_back([&] { answers = ask(); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& answers : together) EXPECT_EQ(answers, alone);
}

TEST(BodyMesh, MovesAsAValue) {
  BodyMesh body = body_of(sphere_surface(1.0, 2));
  const BodyMesh moved = std::move(body);
  EXPECT_TRUE(moved.is_inside(Vec3::Zero()));
  EXPECT_FALSE(moved.hits({{2, 0, 0}, {0.5, 0, 0}, 0.1}).triangles.empty());
}

} // namespace
