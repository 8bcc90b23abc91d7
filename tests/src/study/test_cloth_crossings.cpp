// What validations and benches count where cloth goes through something, of cloth of any topology.
#include "src/measure/crossings.h"

#include "proxies/crossing/capsule_surface.h"
#include "src/study/bench/mesh_sheet.h"
#include "tests/support/capsule_body.h"
#include "tests/support/collider_scenes.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::app;
using proxies::Capsule;

namespace {

using Shape = std::variant<cloth::GridShape, cloth::TubeShape, cloth::DiscShape, cloth::MeshShape>;

/// Held above `held`, where that is said.
cloth::Garment built(const Shape& shape, std::optional<double> held = std::nullopt) {
  cloth::GarmentDescription description;
  description.file = "shape";
  description.shape = shape;
  if (held) {
    cloth::Attachment upper;
    upper.joint = "stage";
    upper.above = held;
    description.attachments = {upper};
  }
  return cloth::build_garment(description);
}

/// 0.6 m x 0.6 m in the plane z = 0, hanging down from y = 1.6, woven and of irregular triangles.
std::array<cloth::Garment, 2> sheets(std::optional<double> held = std::nullopt) {
  return {built(cloth::GridShape{10, 10, {-0.3, 1.6, 0}, {0.6, 0, 0}, {0, -0.6, 0}}, held),
          built(mesh_sheet(10, {-0.3, 1.6, 0}, {0.6, 0, 0}, {0, -0.6, 0}, 0.3), held)};
}

TEST(ClothCrossings, LimbsInClothAreCounted) {
  for (const cloth::Garment& garment : sheets()) {
    const GarmentSurface surface(garment);
    const std::vector<Capsule> two = {{{0.01, 1.3, -0.2}, {0.02, 1.31, 0.2}, 0.03},
                                      {{0.2, 1.4, 0.01}, {0.2, 1.4, 0.01}, 0.04}};
    EXPECT_EQ(surface.with(two).crossings, 2) << "a sphere as well";
    EXPECT_EQ(surface.with(std::vector<Capsule>{{{-0.5, 1.31, 0.2}, {0.5, 1.31, 0.2}, 0.06}}).pairs, 0);
    EXPECT_EQ(surface.with_itself().pairs, 0);
  }
}

TEST(ClothCrossings, LimbsThatAreLookedAtNoCloserHaveNoCrossing) {
  // The twin: every capsule's surface asked.
  std::mt19937_64 random(3);
  int limbs = 0, crossed = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const cloth::Garment garment = sheets()[trial % 2];
    GarmentSurface surface(garment);
    std::vector<Vec3> positions = garment.rest_positions;
    for (Vec3& p : positions) p += test::random_point(random, 0.02);
    surface.move(positions);
    for (Capsule capsule : test::random_scene(random, 8, 0, 0.0).start) {
      for (Vec3* end : {&capsule.a, &capsule.b}) *end = Vec3(end->x(), end->y() + 1.3, 0.3 * end->z());
      const proxies::CapsuleTriangles limb = proxies::capsule_surface(capsule, 48);
      const std::vector<std::uint8_t> placed(limb.positions.size(), 1);
      const proxies::SurfaceCrossings all = proxies::crossings_between(
          surface.surface(), proxies::CrossingSurface(limb.positions, limb.triangles, {}, placed));
      const proxies::SurfaceCrossings found = surface.with({&capsule, 1});
      EXPECT_EQ(found.pairs, all.pairs) << "trial " << trial;
      EXPECT_EQ(found.crossings, all.crossings) << "trial " << trial;
      ++limbs;
      crossed += all.crossings > 0;
    }
  }
  EXPECT_GT(crossed, limbs * 3 / 10);
  EXPECT_LT(crossed, limbs * 9 / 10);
}

TEST(ClothCrossings, ClothInItselfIsCountedAndASeamAndAFoldAreNot) {
  for (const cloth::Garment& garment : sheets()) {
    GarmentSurface surface(garment);
    std::vector<Vec3> rolled = garment.rest_positions; // the lower half turns up and through the upper
    for (Vec3& p : rolled)
      if (p.y() < 1.3) p = Vec3(p.x(), 1.3 + 0.8 * (1.3 - p.y()), 0.1 - (1.3 - p.y()));
    surface.move(rolled);
    EXPECT_EQ(surface.with_itself().crossings, 1);
  }
  const cloth::Garment woven = sheets()[0];
  GarmentSurface surface(woven);
  std::vector<Vec3> folded = woven.rest_positions; // in two, its halves flush
  for (Vec3& p : folded) p.x() = std::abs(p.x());
  surface.move(folded);
  EXPECT_EQ(surface.with_itself().pairs, 0);
  const cloth::Garment sewn = built(cloth::TubeShape{20, 30, {{1.0, 0.2, 0.2}, {0.5, 0.3, 0.3}}, 0.0, 1.0});
  ASSERT_FALSE(sewn.seams.empty());
  EXPECT_EQ(GarmentSurface(sewn).with_itself().pairs, 0) << "a seam is no crossing";
}

TEST(ClothCrossings, ChordsOfWhatIsPinnedAreCountedApart) {
  // The upper border lies a hair outside a limb that bulges between its particles.
  for (const cloth::Garment& garment : sheets(1.6 - 1e-9)) {
    GarmentSurface surface(garment);
    EXPECT_EQ(surface.with(std::vector<Capsule>{{{0.01, 1.8, 0}, {0.01, 1.8, 0}, 0.203}}).crossings, 0);
    EXPECT_EQ(surface.with(std::vector<Capsule>{{{0.01, 1.8, 0}, {0.01, 1.8, 0}, 0.203}}).placed, 1);
    EXPECT_EQ(surface.with(std::vector<Capsule>{{{0.01, 1.3, 0}, {0.01, 1.3, 0}, 0.103}}).crossings, 1);
  }
}

/// A body that stands at y = 1.1 to 1.5, with a texture seam: vertices there stand twice.
proxies::BodyMesh body_with_a_seam() {
  test::CapsuleBody body;
  body.add({{0, 1.2, 0}, {0, 1.4, 0}, 0.1}, 32, 8, 6);
  for (std::size_t t = 0; t < body.triangles.size(); t += 2) // every other triangle has corners of its own
    for (std::uint32_t& corner : body.triangles[t]) {
      body.positions.push_back(Vec3f(body.positions[corner]));
      corner = static_cast<std::uint32_t>(body.positions.size() - 1);
    }
  return {body.positions, body.triangles};
}

TEST(ClothCrossings, ABodyInClothIsCountedThoughItsVerticesStandTwice) {
  const proxies::BodyMesh body = body_with_a_seam();
  const proxies::CrossingSurface skin = skin_surface(body);
  for (const cloth::Garment& garment : sheets()) {
    GarmentSurface surface(garment);
    EXPECT_EQ(proxies::crossings_between(surface.surface(), skin).crossings, 1) << "along a sheet through its middle";
    std::vector<Vec3> level;
    for (const Vec3& p : garment.rest_positions) level.push_back(Vec3(p.x(), 1.3, p.y() - 1.3));
    surface.move(level);
    EXPECT_EQ(proxies::crossings_between(surface.surface(), skin).crossings, 1) << "around its waist";
    for (Vec3& p : level) p.z() += 0.45;
    surface.move(level);
    EXPECT_EQ(proxies::crossings_between(surface.surface(), skin).pairs, 0) << "beside it";
  }
}

TEST(ClothCrossings, OneGarmentThroughAnotherIsCounted) {
  const auto garments = sheets();
  GarmentSurface one(garments[0]), other(garments[1]);
  EXPECT_EQ(proxies::crossings_between(one.surface(), other.surface()).pairs, 0) << "flush";
  std::vector<Vec3> slanted = garments[1].rest_positions;
  for (Vec3& p : slanted) p.z() += 0.5 * (p.y() - 1.31);
  other.move(slanted);
  EXPECT_EQ(proxies::crossings_between(one.surface(), other.surface()).crossings, 1);
}

TEST(ClothCrossings, ATallyKnowsFramesTheWorstAndTheSum) {
  CrossingTally tally;
  const auto add = [&](int frame, int crossings, int placed) { tally.add(frame, {0, crossings, placed}); };
  add(0, 0, 2);
  add(4, 3, 0);
  add(5, 3, 1);
  add(6, 1, 0);
  EXPECT_EQ(tally.frames, 3);
  EXPECT_EQ(tally.worst, 3);
  EXPECT_EQ(tally.worst_frame, 4);
  EXPECT_EQ(tally.total, 7);
  EXPECT_EQ(tally.placed, 3);
}

} // namespace
