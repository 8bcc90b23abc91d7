// What BodyFeatures promises of cloth and bodies that move: how long nothing can come, and that contacts hold cloth
// out.
#include "proxies/body/body_features.h"
#include "tests/support/shaped_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace tutu;
using namespace tutu::proxies;
using namespace tutu::test;

namespace {

/// Of a triangle, evenly: 28 barycentric weights.
std::vector<Vec3> samples_of(const std::array<Vec3, 3>& cloth) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 6; ++i)
    for (int j = 0; i + j <= 6; ++j) points.push_back((i * cloth[0] + j * cloth[1] + (6 - i - j) * cloth[2]) / 6.0);
  return points;
}

TEST(BodyFeatures, NothingComesWithinTheBound) {
  constexpr BodyReach reach{0.003, 0.02};
  ShapedBody bowl = sphere_body();
  std::erase_if(bowl.surface.triangles,
                [&](const rig::Triangle& t) { return bowl.surface.positions[t[0]].y() > 0.01f; });
  bowl.name = "bowl";
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> height(-0.07, 0.07), uniform(0.0, 1.0);
  for (const ShapedBody& shape : {sphere_body(), dented_body(), box_body(), capsule_shaped(0.05, 0.2), bowl}) {
    BodyMesh body(shape.surface.positions, shape.surface.triangles);
    BodyFeatures features(body);
    const std::vector<Vec3> still(body.positions().begin(), body.positions().end());
    const int count = 400;
    int bounded = 0, came = 0;
    double bounds = 0.0, gaps = 0.0;
    for (int i = 0; i < count; ++i) {
      body.pose(still);
      features.refresh();
      const std::array<Vec3, 3> cloth = cloth_near(random, shape, height(random), 0.04);
      std::vector<BodyContact> contacts;
      const double bound = features.contacts(cloth, reach, contacts);
      if (bound <= 0.0) continue;
      ++bounded;
      EXPECT_TRUE(contacts.empty());
      MeshPoint nearest;
      Vec3 towards = Vec3::Zero(); // from the cloth to the surface
      nearest.distance = std::numeric_limits<double>::infinity();
      for (const Vec3& point : samples_of(cloth)) {
        const MeshPoint on = *body.nearest(point, std::numeric_limits<double>::infinity());
        if (on.distance < nearest.distance) nearest = on, towards = (on.closest - point) / on.distance;
      }
      EXPECT_LE(bound, nearest.distance - reach.outside + 1e-12);
      bounds += bound;
      gaps += nearest.distance - reach.outside;

      // The body turns and slides, the cloth's corners go where they like: at each other, half of the time.
      const auto moved = [&](double budget, bool aimed) {
        const double share = uniform(random);
        const Eigen::AngleAxisd turn(aimed ? 0.0 : 2.0 * uniform(random), random_point(random, 1.0).normalized());
        const Vec3 slide = aimed ? Vec3(-towards) : Vec3(0.1 * random_point(random, 1.0));
        std::vector<Vec3> posed;
        double farthest = 0.0;
        for (const Vec3& p : still) farthest = std::max(farthest, (turn * p + slide - p).norm());
        for (const Vec3& p : still) posed.push_back(p + share * budget / farthest * (turn * p + slide - p));
        body.pose(posed);
        features.refresh();
        std::array<Vec3, 3> to = cloth;
        for (Vec3& corner : to)
          corner += (1.0 - share) * budget * (aimed ? towards : Vec3(random_point(random, 1.0).normalized()));
        std::vector<BodyContact> now;
        features.contacts(to, reach, now);
        return !now.empty();
      };
      for (int trial = 0; trial < 4; ++trial) EXPECT_FALSE(moved(0.9999 * bound, trial % 2 == 0)) << shape.name << i;
      came += moved(nearest.distance, true);
    }
    EXPECT_GT(bounded, 0.3 * count) << shape.name;
    EXPECT_LT(bounded, 0.9 * count) << shape.name;
    EXPECT_GT(came, 0.3 * bounded) << shape.name;
    EXPECT_GT(bounds, 0.5 * gaps) << shape.name;
  }
}

/// What the particles of a solver do for the corners.
void push_corners(const BodyMesh& body, std::array<Vec3, 3>& cloth) {
  for (Vec3& corner : cloth) {
    const Contact contact = body.signed_distance(corner);
    if (contact.distance < 0.0) corner = contact.closest;
  }
}

double deepest_of(const BodyMesh& body, const std::array<Vec3, 3>& cloth) {
  double deepest = 0.0;
  for (const Vec3& point : samples_of(cloth)) deepest = std::max(deepest, -body.signed_distance(point).distance);
  return deepest;
}

TEST(BodyFeatures, ContactsHoldATriangleOutOfABumpyBody) {
  const ShapedBody shape = bumpy_body(5);
  const BodyMesh body(shape.surface.positions, shape.surface.triangles);
  const BodyFeatures features(body);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> height(-0.008, 0.001), size(0.02, 0.06);
  int deep_by_corners_alone = 0;
  for (int i = 0; i < 100; ++i) {
    std::array<Vec3, 3> cloth = cloth_near(random, shape, height(random), size(random));
    std::array<Vec3, 3> by_corners = cloth;
    push_corners(body, by_corners);
    deep_by_corners_alone += deepest_of(body, by_corners) > 0.0005;
    for (int sweep = 0; sweep < 12; ++sweep) {
      std::vector<BodyContact> contacts;
      features.contacts(cloth, {0.001, 0.02}, contacts);
      for (const BodyContact& contact : contacts) {
        double distance = -contact.normal.dot(contact.closest), squares = 0.0;
        for (int k = 0; k < 3; ++k) {
          distance += contact.weights[k] * contact.normal.dot(cloth[k]);
          squares += contact.weights[k] * contact.weights[k];
        }
        if (distance >= 0.0) continue;
        for (int k = 0; k < 3; ++k) cloth[k] -= distance * contact.weights[k] / squares * contact.normal;
      }
      push_corners(body, cloth);
    }
    EXPECT_LT(deepest_of(body, cloth), 0.0005) << i;
  }
  EXPECT_GT(deep_by_corners_alone, 50);
}

} // namespace
