// What a triangle of cloth meets of the body, against every vertex and edge asked by other formulas.
#include "proxies/body/body_features.h"
#include "rig/character.h"
#include "rig/import/import.h"
#include "tests/support/brute_features.h"
#include "tests/support/paths.h"
#include "tests/support/shaped_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iomanip>
#include <limits>
#include <sstream>

using namespace tutu;
using namespace tutu::proxies;
using namespace tutu::test;

namespace {

constexpr BodyReach k_reach{0.004, 0.02};

std::vector<BodyContact> contacts_of(const BodyFeatures& features, const std::array<Vec3, 3>& cloth,
                                     const BodyReach& reach) {
  std::vector<BodyContact> contacts;
  features.contacts(cloth, reach, contacts);
  return contacts;
}

Vec3 cloth_point(const BodyContact& contact, const std::array<Vec3, 3>& cloth) {
  return contact.weights[0] * cloth[0] + contact.weights[1] * cloth[1] + contact.weights[2] * cloth[2];
}

/// Of one body however it is put together: kind, and where on the cloth and on the body, by size.
struct Met {
  BodyPair pair;
  Vec3 cloth, body;
};

std::vector<Met> met_by(const BodyFeatures& features, const std::array<Vec3, 3>& cloth) {
  std::vector<Met> all;
  for (const BodyContact& contact : contacts_of(features, cloth, k_reach))
    all.push_back({contact.pair, cloth_point(contact, cloth), contact.closest});
  return all;
}

/// As sets, to rounding.
bool same_set(const std::vector<Met>& some, std::vector<Met> others) {
  for (const Met& one : some) {
    const auto same = std::ranges::find_if(others, [&](const Met& other) {
      return one.pair == other.pair && (one.cloth - other.cloth).norm() < 1e-10 &&
             (one.body - other.body).norm() < 1e-10;
    });
    if (same == others.end()) return false;
    others.erase(same);
  }
  return others.empty();
}

/// On random cloth about `shape`, whose mesh both bodies are another form of. How many contacts were compared.
int expect_same_contacts(const ShapedBody& shape, const BodyMesh& one, const BodyMesh& other) {
  const BodyFeatures features(one), other_features(other);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> height(-0.02, 0.004);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const std::array<Vec3, 3> cloth = cloth_near(random, shape, height(random), 0.05);
    const std::vector<Met> met = met_by(features, cloth);
    EXPECT_TRUE(same_set(met, met_by(other_features, cloth))) << shape.name << ", cloth " << i;
    compared += static_cast<int>(met.size());
  }
  return compared;
}

/// Everything that the header says of a contact, whatever the body.
void expect_convention(const BodyContact& contact, const BodyMesh& body, const std::array<Vec3, 3>& cloth,
                       const BodyReach& reach) {
  ASSERT_TRUE(std::isfinite(contact.distance) && contact.normal.allFinite() && contact.closest.allFinite());
  EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
  EXPECT_GE(contact.distance, -reach.depth);
  EXPECT_LE(contact.distance, reach.outside);
  const rig::Triangle& t = body.triangles()[contact.triangle];
  Vec3 on_body = Vec3::Zero();
  double sum = 0.0, body_sum = 0.0;
  int parts = 0, body_parts = 0;
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(contact.weights[k], 0.0);
    EXPECT_GE(contact.on_body[k], 0.0);
    sum += contact.weights[k];
    body_sum += contact.on_body[k];
    parts += contact.weights[k] != 0.0;
    body_parts += contact.on_body[k] != 0.0;
    on_body += contact.on_body[k] * body.positions()[t[k]];
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_NEAR(body_sum, 1.0, 1e-12);
  EXPECT_LE(body_parts, contact.pair == BodyPair::face_vertex ? 1 : 2);
  EXPECT_LE(parts, contact.pair == BodyPair::face_vertex ? 3 : 2);
  EXPECT_LT((on_body - contact.closest).norm(), 1e-14);
  const Vec3 point = cloth_point(contact, cloth);
  EXPECT_LT((contact.closest + contact.distance * contact.normal - point).norm(), 1e-11);
}

/// The pairs that the twin is sure of are found, and none that it is sure against; each once.
void expect_as_twin(const ShapedBody& shape, int count, std::uint64_t seed, const BodyReach& reach = k_reach) {
  const BodyMesh body(shape.surface.positions, shape.surface.triangles);
  const BodyFeatures features(body);
  const BruteFeatures twin(body.positions(), body.triangles(), shape.outward);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> height(-reach.depth - 0.002, 0.018), size(0.01, 0.08);
  int hits = 0, through = 0;
  std::array<int, 2> kinds = {};
  for (int i = 0; i < count; ++i) {
    const std::array<Vec3, 3> cloth = cloth_near(random, shape, height(random), size(random));
    const std::vector<BodyContact> found = contacts_of(features, cloth, reach);
    std::vector<BrutePair> expected = twin.pairs(cloth, reach, -1e-6);
    std::ostringstream who;
    who << shape.name << std::setprecision(17);
    for (const Vec3& corner : cloth) who << " {" << corner.transpose() << "}";
    for (const BodyContact& contact : found) {
      expect_convention(contact, body, cloth, reach);
      EXPECT_GT(contact.normal.dot(shape.outward(contact.closest)), 0.0) << who.str();
      const auto same = std::ranges::find_if(expected, [&](const BrutePair& pair) {
        return pair.pair == contact.pair && (pair.cloth - cloth_point(contact, cloth)).norm() < 1e-9 &&
               (pair.body - contact.closest).norm() < 1e-9;
      });
      ASSERT_NE(same, expected.end()) << who.str() << ", distance " << contact.distance;
      EXPECT_NEAR(contact.distance, same->distance, 1e-11);
      EXPECT_LT((contact.normal - same->normal).norm(), 1e-9);
      expected.erase(same);
      ++kinds[static_cast<std::size_t>(contact.pair)];
      through += contact.distance < 0.0;
    }
    for (const BrutePair& pair : expected)
      EXPECT_LT(pair.margin, 1e-6) << who.str() << ", at " << pair.body.transpose() << ", distance " << pair.distance;
    hits += !found.empty();
  }
  EXPECT_GT(hits, 0.3 * count) << shape.name;
  EXPECT_LT(hits, 0.7 * count) << shape.name;
  EXPECT_EQ(through > 0.1 * count, reach.depth > 0.0) << shape.name;
  for (const int kind : kinds) EXPECT_GT(kind, 0.01 * count) << shape.name;
}

TEST(BodyFeatures, AreAsTheTwinFindsThem) {
  expect_as_twin(sphere_body(), 150, 1);
  expect_as_twin(box_body(), 150, 2);
  expect_as_twin(capsule_shaped(0.05, 0.2), 150, 3);
  expect_as_twin(dented_body(), 150, 4);
}

TEST(BodyFeatures, AreAsTheTwinFindsThem_slow) {
  expect_as_twin(sphere_body(), 2000, 11);
  expect_as_twin(box_body(), 2000, 12);
  expect_as_twin(capsule_shaped(0.05, 0.2), 2000, 13);
  expect_as_twin(dented_body(), 2000, 14);
  expect_as_twin(bumpy_body(3), 2000, 15);
}

TEST(BodyFeatures, OfAnOpenBodyAreAsTheTwinFindsThem) {
  ShapedBody bowl = sphere_body();
  std::erase_if(bowl.surface.triangles,
                [&](const rig::Triangle& t) { return bowl.surface.positions[t[0]].y() > 0.01f; });
  ASSERT_GT(BodyMesh(bowl.surface.positions, bowl.surface.triangles).census().open_edges, 0);
  expect_as_twin(bowl, 300, 5, {0.008, 0.0});
}

TEST(BodyFeatures, AreTheSameWhateverTheOrderOfTriangles) {
  std::mt19937_64 random(6);
  for (const ShapedBody& shape : {dented_body(), box_body()}) {
    std::vector<rig::Triangle> shuffled = shape.surface.triangles;
    std::ranges::shuffle(shuffled, random);
    for (rig::Triangle& t : shuffled) std::ranges::rotate(t, t.begin() + random() % 3);
    const BodyMesh body(shape.surface.positions, shape.surface.triangles), other(shape.surface.positions, shuffled);
    EXPECT_GT(expect_same_contacts(shape, body, other), 200);
  }
}

TEST(BodyFeatures, SeamsAreNoOpenings) {
  const ShapedBody shape = dented_body();
  Surface torn; // each triangle with corners of its own
  for (const rig::Triangle& t : shape.surface.triangles) {
    const auto first = static_cast<std::uint32_t>(torn.positions.size());
    for (const std::uint32_t v : t) torn.positions.push_back(shape.surface.positions[v]);
    torn.triangles.push_back({first, first + 1, first + 2});
  }
  const BodyMesh body(shape.surface.positions, shape.surface.triangles), other(torn.positions, torn.triangles);
  EXPECT_GT(expect_same_contacts(shape, body, other), 200);
}

TEST(BodyFeatures, OfInnerShellsAreNotThere) {
  const ShapedBody shape = sphere_body();
  Surface filled = shape.surface;
  append(filled, sphere_surface(0.095, 2));
  const BodyMesh body(shape.surface.positions, shape.surface.triangles), other(filled.positions, filled.triangles);
  ASSERT_EQ(other.census().inner_shells, 1);
  EXPECT_GT(expect_same_contacts(shape, body, other), 200);
}

TEST(BodyFeatures, FollowThePose) {
  const ShapedBody shape = dented_body();
  const BodyMesh still(shape.surface.positions, shape.surface.triangles);
  std::vector<Vec3> away(still.positions().begin(), still.positions().end());
  for (Vec3& p : away) p = 1.3 * Vec3(p.z(), p.x(), p.y());
  Surface elsewhere = shape.surface;
  for (std::size_t v = 0; v < away.size(); ++v) elsewhere.positions[v] = away[v].cast<float>();
  BodyMesh moved(elsewhere.positions, shape.surface.triangles);
  BodyFeatures features(moved);
  moved.pose(still.positions());
  features.refresh();
  const BodyFeatures fresh(still);
  std::mt19937_64 random(8);
  for (int i = 0; i < 100; ++i) {
    const std::array<Vec3, 3> cloth = cloth_near(random, shape, -0.005, 0.05);
    EXPECT_TRUE(same_set(met_by(features, cloth), met_by(fresh, cloth)));
  }
}

TEST(BodyFeatures, FarSideOfAThinLimbIsNotMet) {
  const ShapedBody limb = capsule_shaped(0.006, 0.3);
  const BodyMesh body(limb.surface.positions, limb.surface.triangles);
  const BodyFeatures features(body);
  std::mt19937_64 random(9);
  int met = 0;
  for (int i = 0; i < 400; ++i) {
    // Beside the limb, along +X: from 3 mm off it to 3 mm into it.
    const double x = 0.006 + (i % 2 ? 0.003 : -0.003) * std::uniform_real_distribution<double>(0.1, 1.0)(random);
    const double turn = std::uniform_real_distribution<double>(0.0, 6.28)(random);
    std::array<Vec3, 3> cloth;
    for (int k = 0; k < 3; ++k)
      cloth[k] = Vec3(x, 0.04 * std::cos(turn + 2.1 * k), 0.04 * std::sin(turn + 2.1 * k)) + random_point(random, 1e-3);
    for (const BodyContact& contact : contacts_of(features, cloth, k_reach)) {
      EXPECT_GT(contact.normal.x(), 0.5);
      EXPECT_GT(contact.distance, -0.006);
      ++met;
    }
  }
  EXPECT_GT(met, 400);
}

TEST(BodyFeatures, OfTheDancerComeThroughClothThatIsInsideHer) {
  const rig::Mesh mesh = rig::import_character(source_file("assets/characters/dancer.dae")).character.mesh;
  const BodyMesh body(mesh.positions, mesh.triangles);
  const BodyFeatures features(body);
  const ShapedBody dancer{"dancer", {mesh.positions, mesh.triangles}, {}};
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> height(-0.015, 0.01);
  int through = 0;
  for (int i = 0; i < 400; ++i) {
    const std::array<Vec3, 3> cloth = cloth_near(random, dancer, height(random), 0.03);
    for (const BodyContact& contact : contacts_of(features, cloth, k_reach)) {
      expect_convention(contact, body, cloth, k_reach);
      if (contact.distance > -1e-6) continue;
      EXPECT_TRUE(body.is_inside(cloth_point(contact, cloth))) << i << ", distance " << contact.distance;
      ++through;
    }
  }
  EXPECT_GT(through, 400);
}

TEST(BodyFeatures, WhatIsDeeperIsNoContact) {
  const ShapedBody sphere = sphere_body();
  const BodyMesh body(sphere.surface.positions, sphere.surface.triangles);
  const BodyFeatures features(body);
  const std::array<Vec3, 3> cloth = {Vec3(-0.02, 0.07, -0.015), Vec3(0.02, 0.07, -0.016), Vec3(0.001, 0.07, 0.02)};
  EXPECT_TRUE(contacts_of(features, cloth, {0.004, 0.02}).empty());
  const std::vector<BodyContact> met = contacts_of(features, cloth, {0.004, 0.035});
  ASSERT_FALSE(met.empty());
  for (const BodyContact& contact : met) EXPECT_NEAR(contact.distance, -0.03, 0.003);
}

TEST(BodyFeatures, NothingNonFiniteComesOfFlatTriangles) {
  std::mt19937_64 random(10);
  const ShapedBody shape = sphere_body();
  BodyMesh body(shape.surface.positions, shape.surface.triangles);
  BodyFeatures features(body);
  // Edges collapse to points, and triangles to lines.
  std::vector<Vec3> posed(body.positions().begin(), body.positions().end());
  for (const rig::Triangle& t : body.triangles()) {
    if (random() % 6 == 0) posed[t[0]] = posed[t[1]];
    else if (random() % 6 == 0) posed[t[0]] = 0.5 * (posed[t[1]] + posed[t[2]]);
  }
  body.pose(posed);
  features.refresh();
  int met = 0;
  for (int i = 0; i < 600; ++i) {
    std::array<Vec3, 3> cloth = cloth_near(random, shape, -0.002, 0.04);
    if (i % 4 == 1) cloth[2] = 0.3 * cloth[0] + 0.7 * cloth[1]; // a line
    if (i % 4 == 2) cloth[2] = cloth[0];                        // an edge, there and back
    if (i % 4 == 3) cloth[1] = cloth[2] = cloth[0];             // a point
    for (const BodyContact& contact : contacts_of(features, cloth, k_reach)) {
      expect_convention(contact, body, cloth, k_reach);
      EXPECT_NE(i % 4, 3);
      if (i % 4 != 0) {
        EXPECT_EQ(contact.pair, BodyPair::edge_edge);
      }
      ++met;
    }
  }
  EXPECT_GT(met, 200);
}

TEST(BodyFeatures, NothingNonFiniteComesOfABodyThatTouchesItself) {
  // Two boxes that share a face, two that share an edge, two that overlap, and one that is there twice.
  Surface heap = box_surface({0.05f, 0.05f, 0.05f});
  for (const Vec3f& at : {Vec3f(0.1f, 0, 0), Vec3f(0, 0.1f, 0.1f), Vec3f(-0.07f, 0.02f, 0.01f), Vec3f(0.1f, 0, 0)}) {
    Surface box = box_surface({0.05f, 0.05f, 0.05f});
    for (Vec3f& p : box.positions) p += at;
    append(heap, box);
  }
  const ShapedBody shape{"heap", subdivided(subdivided(heap)), {}};
  const BodyMesh body(shape.surface.positions, shape.surface.triangles);
  const BodyFeatures features(body);
  std::mt19937_64 random(11);
  int met = 0;
  for (int i = 0; i < 500; ++i) {
    const std::array<Vec3, 3> cloth = cloth_near(random, shape, i % 2 ? 0.002 : -0.002, 0.04);
    for (const BodyContact& contact : contacts_of(features, cloth, k_reach)) {
      expect_convention(contact, body, cloth, k_reach);
      ++met;
    }
  }
  EXPECT_GT(met, 100);
}

TEST(BodyFeatures, RefusesWhatIsNoNumber) {
  const ShapedBody shape = box_body();
  const BodyMesh body(shape.surface.positions, shape.surface.triangles);
  const BodyFeatures features(body);
  const std::array<Vec3, 3> cloth = {Vec3(0, 0.06, 0), Vec3(0.01, 0.06, 0), Vec3(0, 0.06, 0.01)};
  std::vector<BodyContact> contacts;
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  EXPECT_THROW(features.contacts({Vec3(nan, 0, 0), cloth[1], cloth[2]}, k_reach, contacts), std::invalid_argument);
  EXPECT_THROW(features.contacts(cloth, {-0.001, 0.02}, contacts), std::invalid_argument);
  EXPECT_THROW(features.contacts(cloth, {0.001, infinite}, contacts), std::invalid_argument);
  EXPECT_TRUE(contacts.empty());
}

} // namespace
