#include "cloth/garment/elements.h"
#include "cloth/garment/garment_file.h"
#include "cloth/solver.h"
#include "rig/error.h"
#include "rig/import/surface.h"
#include "rig/io/file_io.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>
#include <numbers>
#include <numeric>

using namespace tutu;
using namespace tutu::cloth;

namespace {

GarmentDescription round_sheet(int rings, double hole) {
  GarmentDescription description;
  description.file = "disc";
  description.shape = DiscShape{{0.1, 1, 0.2}, 0.15, 0.15, rings, hole};
  return description;
}

double angle_at(const Vec3& corner, const Vec3& p, const Vec3& q) {
  return std::acos((p - corner).normalized().dot((q - corner).normalized()));
}

TEST(Disc, IsRoundFlatAndOfNearlyEquilateralTriangles) {
  for (const double hole : {0.0, 0.3, 0.9})
    for (const int rings : {3, 20}) {
      const Garment garment = build_garment(round_sheet(rings, hole));
      EXPECT_EQ(garment.rows, 0);
      EXPECT_EQ(garment.columns, 0);
      double area = 0.0;
      for (const auto& t : garment.triangles) {
        const Vec3 &a = garment.rest_positions[t[0]], &b = garment.rest_positions[t[1]],
                   &c = garment.rest_positions[t[2]];
        EXPECT_GT((b - a).cross(c - a).y(), 0.0) << "the front is up";
        area += 0.5 * (b - a).cross(c - a).norm();
        for (const double angle : {angle_at(a, b, c), angle_at(b, c, a), angle_at(c, a, b)}) {
          EXPECT_GT(angle, 0.60) << rings << " rings, hole " << hole; // 34 degrees
          EXPECT_LT(angle, 1.95);                                     // 112 degrees
        }
      }
      const double exact = std::numbers::pi * 0.15 * 0.15 * (1.0 - hole * hole);
      EXPECT_NEAR(area, exact, 0.2 * exact / (rings * rings));
      int borders = 0;
      for (const Edge& edge : edges_of(garment.triangles)) {
        EXPECT_LE(edge.triangles, 2);
        borders += edge.triangles == 1;
      }
      const int outer = std::max(6, static_cast<int>(std::lround(6.0 * rings / (1.0 - hole))));
      const int inner = hole > 0.0 ? std::max(6, static_cast<int>(std::lround(6.0 * hole * rings / (1.0 - hole)))) : 0;
      EXPECT_EQ(borders, outer + inner);
      EXPECT_NEAR(std::accumulate(garment.masses.begin(), garment.masses.end(), 0.0), garment.fabric.density * area,
                  1e-12);
    }
}

TEST(Disc, ANarrowRingOfVeryManyParticlesIsStitchedAllAround) {
  const int around = 60'000; // the product of two such numbers is more than an int holds
  const Garment garment = build_garment(round_sheet(1, 1.0 - 6.0 / around));
  EXPECT_NEAR(garment.particle_count(), 2 * around, 10);
  EXPECT_EQ(static_cast<int>(garment.triangles.size()), garment.particle_count());
  double longest = 0.0;
  for (const auto& t : garment.triangles)
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (garment.rest_positions[t[k]] - garment.rest_positions[t[(k + 1) % 3]]).norm());
  EXPECT_LT(longest, 2.0 * 0.15 * 6.0 / around); // twice the ring's width
}

TEST(Disc, PulledBothWaysItAnswersAsAnIsotropicSheet) {
  // Springs along equilateral triangles: plane stress with Poisson ratio 1/3; equal strain e both ways costs
  // k e^2 / (1 - 1/3) per area.
  const Garment garment = build_garment(round_sheet(24, 0.0));
  const double e = 1e-3;
  double energy = 0.0;
  for (const Spring& spring : garment.springs)
    energy += 0.5 * spring.stiffness * e * spring.rest_length * e * spring.rest_length;
  const double area = std::accumulate(garment.masses.begin(), garment.masses.end(), 0.0) / garment.fabric.density;
  EXPECT_NEAR(energy / (garment.fabric.stretch * e * e * 1.5 * area), 1.0, 0.01);
}

TEST(Disc, WhatCannotBeOneIsRefused) {
  EXPECT_THROW(build_garment(round_sheet(0, 0.0)), InputError);
  EXPECT_THROW(build_garment(round_sheet(4, 1.0)), InputError);
  EXPECT_THROW(build_garment(round_sheet(100000, 0.0)), InputError);
}

TEST(MeshGarment, IsHeldByPlace) {
  GarmentDescription description = round_sheet(6, 0.0);
  Attachment attachment;
  attachment.joint = "Hips";
  attachment.within = Attachment::Ball{{0.1, 1, 0.2}, 0.026};
  description.attachments = {attachment};
  EXPECT_EQ(build_garment(description).pins.size(), 7u) << "the centre and the first ring";
  description.attachments[0].above = 1.1;
  EXPECT_THROW(build_garment(description), InputError) << "within and above: none";
  description.attachments[0].above = 0.9;
  description.attachments[0].within.reset();
  EXPECT_EQ(build_garment(description).pins.size(), build_garment(description).rest_positions.size());
  description.attachments = {{"Hips", 0, 0, 0, -1}};
  EXPECT_THROW(build_garment(description), InputError) << "it has no rows";

  const GarmentDescription moved = fitted(round_sheet(6, 0.0), {2, 1, 2}, {0, 0.5, 0});
  EXPECT_NEAR((build_garment(moved).rest_positions[0] - Vec3(0.2, 1.5, 0.4)).norm(), 0.0, 1e-15);
}

TEST(MeshGarment, CrumbsAndLooseCornersAreLeftOut) {
  GarmentDescription description;
  description.file = "mesh";
  MeshShape mesh;
  mesh.positions = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  mesh.triangles = {{1, 2, 3}, {2, 4, 3}, {1, 1, 2}};
  description.shape = mesh;
  const Garment garment = build_garment(description);
  EXPECT_EQ(garment.particle_count(), 4);
  EXPECT_EQ(garment.triangles.size(), 2u);
  EXPECT_EQ(garment.springs.size(), 5u);
  for (const double mass : garment.masses) EXPECT_GT(mass, 0.0);
  mesh.triangles = {{1, 2, 7}};
  description.shape = mesh;
  EXPECT_THROW(build_garment(description), InputError);
  mesh.triangles = {{1, 2, 2}};
  description.shape = mesh;
  EXPECT_THROW(build_garment(description), InputError);
}

class MeshFile : public ::testing::Test {
protected:
  void SetUp() override { folder_ = test::scratch_folder(); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string refusal(const std::string& garment) {
    write_file(folder_ / "g.json", garment);
    try {
      build_garment(read_garment(folder_ / "g.json"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(MeshFile, CornersThatDifferInTextureOnlyAreOneParticle) {
  write_file(folder_ / "square.obj", "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                     "f 1/1 2/2 3/3\nf 1/4 3/2 4/4\n");
  write_file(folder_ / "g.json", R"({"shape": {"mesh": {"file": "square.obj", "scale": 0.01}},
      "attachments": [{"joint": "Hips", "above": 0.5}]})");
  const Garment garment = build_garment(read_garment(folder_ / "g.json"));
  EXPECT_EQ(garment.particle_count(), 4);
  EXPECT_EQ(garment.triangles.size(), 2u);
  EXPECT_EQ(garment.pins.size(), 2u);
  EXPECT_EQ(build_bends(garment).size(), 1u);
  EXPECT_NEAR(std::accumulate(garment.masses.begin(), garment.masses.end(), 0.0), garment.fabric.density, 1e-9);
}

TEST_F(MeshFile, EveryFormatIsRead) {
  for (const char* model : {"OBJ/box.obj", "PLY/cube.ply", "STL/Spider_ascii.stl"}) {
    const auto file = test::assimp_model(model);
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << " (Debian's assimp-testmodels)";
    const rig::TriangleSurface surface = rig::import_surface(file);
    EXPECT_GE(surface.triangles.size(), 12u) << model;
    EXPECT_GE(surface.positions.size(), 8u);
  }
  EXPECT_EQ(rig::import_surface(test::assimp_model("PLY/cube.ply")).positions.size(), 8u) << "welded";
}

TEST_F(MeshFile, EveryMistakeIsNamedWithItsPlace) {
  using ::testing::HasSubstr;
  EXPECT_THAT(refusal(R"({"shape": {"mesh": {"file": "none.obj"}}})"), HasSubstr("/shape/mesh/file: found no file"));
  write_file(folder_ / "far.obj", "v 0 0 0\nv 2e8 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(refusal(R"({"shape": {"mesh": {"file": "far.obj"}}})"),
              HasSubstr("/shape/mesh/file: found the point 2e+08 0 0 m in " + (folder_ / "far.obj").string() +
                        ", expected points within 1e+06 m of the origin"));
  EXPECT_EQ(refusal(R"({"shape": {"mesh": {"file": "far.obj", "scale": 1e-6}}})"), "");
  write_file(folder_ / "points.obj", "v 0 0 0\nv 1 0 0\n");
  EXPECT_THAT(refusal(R"({"shape": {"mesh": {"file": "points.obj"}}})"), HasSubstr("points.obj"));
  write_file(folder_ / "rubbish.obj", std::string(300, '\xff'));
  EXPECT_THAT(refusal(R"({"shape": {"mesh": {"file": "rubbish.obj"}}})"), HasSubstr("rubbish.obj"));
  write_file(folder_ / "a.exe", "MZ");
  EXPECT_THAT(refusal(R"({"shape": {"mesh": {"file": "a.exe"}}})"), HasSubstr("a .exe file"));
  const std::string disc = R"({"shape": {"disc": {"centre": [0,1,0], "radius": 0.15, "rings": 4}}, "attachments": [)";
  EXPECT_EQ(refusal(disc + R"({"joint": "Hips", "within": {"centre": [0,1,0], "radius": 0.05}}]})"), "");
  EXPECT_EQ(refusal(disc + R"({"skin": true, "above": 0.5}]})"), "");
  EXPECT_THAT(refusal(disc + R"({"joint": "Hips", "rows": 0}]})"), HasSubstr("within or above"));
  EXPECT_THAT(refusal(disc + R"({"joint": "Hips", "skin": true, "above": 0}]})"), HasSubstr("both joint and skin"));
  EXPECT_THAT(refusal(disc + R"({"above": 0}]})"), HasSubstr("neither joint nor skin"));
  EXPECT_THAT(refusal(disc + R"({"joint": "Hips", "rows": 0, "above": 0}]})"), HasSubstr("/attachments/0/rows"));
  EXPECT_THAT(refusal(R"({"shape": {"disc": {"centre": [0,1,0], "radius": 0.15, "rings": 4, "hole": 0.2}}})"),
              HasSubstr("/shape/disc/hole"));
}

} // namespace
