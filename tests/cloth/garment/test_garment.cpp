#include "cloth/garment/garment.h"
#include "cloth/garment/garment_file.h"
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>
#include <numeric>

using namespace tutu;
using namespace tutu::cloth;

namespace {

GarmentDescription rectangle(int rows, int columns) {
  GarmentDescription description;
  description.file = "rectangle";
  description.shape = GridShape{rows, columns, {0, 1, 0}, {0.6, 0, 0}, {0, -0.4, 0}};
  return description;
}

GarmentDescription tube(int rows, int columns, std::optional<double> seam) {
  GarmentDescription description;
  description.file = "tube";
  TubeShape shape;
  shape.rows = rows;
  shape.columns = columns;
  shape.rings = {{1.0, 0.15, 0.12, 0, 0.01}, {0.7, 0.3, 0.3, 0, 0}};
  shape.seam = seam;
  description.shape = shape;
  return description;
}

int count(const Garment& garment, SpringKind kind) {
  return static_cast<int>(
      std::count_if(garment.springs.begin(), garment.springs.end(), [&](const Spring& s) { return s.kind == kind; }));
}

TEST(Garment, ARectangleHasTheReportsSprings) {
  const int rows = 7, columns = 9;
  const Garment garment = build_garment(rectangle(rows, columns));
  EXPECT_EQ(count(garment, SpringKind::structural), rows * (columns - 1) + columns * (rows - 1));
  EXPECT_EQ(count(garment, SpringKind::shear), 2 * (rows - 1) * (columns - 1));
  EXPECT_EQ(count(garment, SpringKind::bend), rows * (columns - 2) + columns * (rows - 2));
  EXPECT_EQ(garment.triangles.size(), 2u * (rows - 1) * (columns - 1));
  for (int k = 0; k < static_cast<int>(garment.springs.size()); ++k) {
    EXPECT_EQ(garment.springs[k].kind == SpringKind::structural, k < garment.structural_count);
    EXPECT_GT(garment.springs[k].stiffness, 0.0);
    EXPECT_GT(garment.springs[k].rest_length, 0.0);
  }
}

TEST(Garment, AWovenTubeGoesAllTheWayRound) {
  const int rows = 5, columns = 8;
  const Garment garment = build_garment(tube(rows, columns, std::nullopt));
  EXPECT_EQ(count(garment, SpringKind::structural), rows * columns + columns * (rows - 1));
  EXPECT_EQ(count(garment, SpringKind::shear), 2 * (rows - 1) * columns);
  EXPECT_EQ(count(garment, SpringKind::bend), rows * columns + columns * (rows - 2));
  EXPECT_TRUE(garment.seams.empty());
}

TEST(Garment, TheSeamEndsWhereTheSlitBegins) {
  const Garment garment = build_garment(tube(30, 30, 1.0 / 3.0));
  EXPECT_EQ(garment.seams.size(), 10u);
  for (int row = 0; row < 30; ++row)
    EXPECT_EQ(garment.rest_positions[row * 30], garment.rest_positions[row * 30 + 29])
        << "both edges start in one place";
}

TEST(Garment, MassIsDensityTimesArea) {
  GarmentDescription description = rectangle(11, 13);
  description.fabric.density = 0.2;
  const Garment garment = build_garment(description);
  EXPECT_NEAR(std::accumulate(garment.masses.begin(), garment.masses.end(), 0.0), 0.2 * 0.6 * 0.4, 1e-12);
}

TEST(Garment, AFinerGridIsTheSameSheet) {
  // Pulled along one thread direction by a strain e, the sheet stores k A e^2 / 2 in its structural springs, however
  // fine.
  for (const int n : {5, 10, 40}) {
    const Garment garment = build_garment(rectangle(n, n));
    const double strain = 0.01;
    double energy = 0.0;
    for (int k = 0; k < garment.structural_count; ++k) {
      const Spring& spring = garment.springs[k];
      const double along = std::abs(garment.rest_positions[spring.j].x() - garment.rest_positions[spring.i].x());
      energy += 0.5 * spring.stiffness * (strain * along) * (strain * along);
    }
    EXPECT_NEAR(energy, 0.5 * garment.fabric.stretch * 0.6 * 0.4 * strain * strain, 1e-12) << n;
  }
}

TEST(Garment, ATubesTrianglesFaceOutwards) {
  const Garment garment = build_garment(tube(10, 20, std::nullopt));
  for (const auto& t : garment.triangles) {
    const Vec3 &a = garment.rest_positions[t[0]], &b = garment.rest_positions[t[1]], &c = garment.rest_positions[t[2]];
    const Vec3 normal = (b - a).cross(c - a), middle = (a + b + c) / 3.0;
    EXPECT_GT(normal.dot(Vec3(middle.x(), 0.0, middle.z())), 0.0);
  }
}

TEST(Garment, AttachmentsCountFromTheEndToo) {
  GarmentDescription description = rectangle(4, 5);
  description.attachments = {{"Neck", 0, 0, 0, 1}, {"Hips", -1, -1, 0, -1}};
  const Garment garment = build_garment(description);
  ASSERT_EQ(garment.pins.size(), 2u + 5u);
  EXPECT_EQ(garment.pins[2].particle, 15);
  EXPECT_EQ(garment.pins[2].attachment, 1);
}

TEST(Garment, WhatCannotBeClothIsRefused) {
  GarmentDescription twice = rectangle(4, 5);
  twice.attachments = {{"Neck", 0, 1, 0, -1}, {"Hips", 1, 1, 0, -1}};
  EXPECT_THROW(build_garment(twice), InputError);
  GarmentDescription beyond = rectangle(4, 5);
  beyond.attachments = {{"Neck", 4, 4, 0, -1}};
  EXPECT_THROW(build_garment(beyond), InputError);
  EXPECT_THROW(build_garment(rectangle(1, 5)), InputError);
  GarmentDescription flat = rectangle(4, 5);
  std::get<GridShape>(flat.shape).down = Vec3::Zero();
  EXPECT_THROW(build_garment(flat), InputError);
}

TEST(Garment, FittingScalesThenMoves) {
  const Garment garment = build_garment(fitted(rectangle(3, 3), {2, 1, 1}, {0, 0.5, 0}));
  EXPECT_NEAR((garment.rest_positions.front() - Vec3(0, 1.5, 0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((garment.rest_positions.back() - Vec3(1.2, 1.1, 0)).norm(), 0.0, 1e-15);
}

class GarmentFile : public ::testing::Test {
protected:
  void SetUp() override { folder_ = test::scratch_folder(); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// The message for a garment file of this text; "" when it reads.
  std::string message_for(const std::string& text) {
    write_file(folder_ / "g.json", text);
    try {
      build_garment(read_garment(folder_ / "g.json"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(GarmentFile, ReadsATube) {
  const std::string text = R"({ "name": "skirt", // a comment
    "shape": { "tube": { "rows": 6, "columns": 8, "seam": 0.5, "rings": [ {"height": 1, "radius": [0.1, 0.2], "centre": [0, 0.01]}, {"height": 0.5, "radius": 0.4} ] } },
    "fabric": { "density": 0.2, "stretch": 50 }, "attachments": [ {"joint": "Hips", "rows": 0} ], "colour": [1, 0, 0.5] })";
  EXPECT_EQ(message_for(text), "");
}

TEST_F(GarmentFile, AFabricIsNamedOrWrittenOutOrBoth) {
  std::filesystem::create_directories(folder_ / "garments");
  std::filesystem::create_directories(folder_ / "fabrics");
  write_file(folder_ / "fabrics/felt.json", R"({"source": "made up", "density": 0.5, "bend": 1e-4, "shear": 7})");
  write_file(folder_ / "garments/local.json", R"({"density": 0.3})");
  const auto fabric_of = [&](const std::string& fabric) {
    write_file(folder_ / "garments/g.json",
               R"({"shape": {"grid": {"rows": 3, "columns": 3, "corner": [0,0,0], "across": [1,0,0], "down": [0,-1,0]}},
                  "fabric": )" +
                   fabric + "}");
    return read_garment(folder_ / "garments/g.json").fabric;
  };
  const Fabric felt = fabric_of("\"felt\"");
  EXPECT_EQ(felt.density, 0.5);
  EXPECT_EQ(felt.bend, 1e-4);
  EXPECT_EQ(felt.bend_springs, Fabric{}.bend_springs);
  EXPECT_EQ(fabric_of("\"local.json\"").density, 0.3);
  const Fabric changed = fabric_of(R"({"base": "felt", "density": 0.4, "bend_springs": 3})");
  EXPECT_EQ(changed.density, 0.4);
  EXPECT_EQ(changed.shear, 7.0);
  EXPECT_EQ(changed.bend_springs, 3.0);
  const auto refused = [&](const std::string& fabric) -> std::string {
    try {
      fabric_of(fabric);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(refused("\"flet\""), HasSubstr("/fabric: found \"flet\", expected one of: felt"));
  EXPECT_THAT(refused(R"({"base": "flet"})"), HasSubstr("/fabric/base"));
  EXPECT_THAT(refused("\"nowhere.json\""), HasSubstr("no file"));
  EXPECT_THAT(refused("\"../felt\""), HasSubstr("the name of a fabric"));
  EXPECT_THAT(refused("3"), HasSubstr("/fabric: found 3"));
}

TEST_F(GarmentFile, AirStandsInForDrag) {
  std::filesystem::create_directories(folder_ / "fabrics");
  std::filesystem::create_directories(folder_ / "garments");
  write_file(folder_ / "fabrics/felt.json", R"({"source": "made up", "density": 0.5})");
  write_file(folder_ / "fabrics/airy.json", R"({"source": "made up", "air": {"friction": 0.02}})");
  write_file(folder_ / "fabrics/both.json", R"({"source": "made up", "drag": 0.7})");
  const auto fabric_of = [&](const std::string& fabric) {
    write_file(folder_ / "garments/g.json",
               R"({"shape": {"grid": {"rows": 3, "columns": 3, "corner": [0,0,0], "across": [1,0,0], "down": [0,-1,0]}},
                  "fabric": )" +
                   fabric + "}");
    return read_garment(folder_ / "garments/g.json").fabric;
  };
  EXPECT_FALSE(fabric_of("\"felt\"").air);
  EXPECT_EQ(fabric_of("\"felt\"").drag, Fabric{}.drag);
  const Fabric plain = fabric_of(R"({"base": "felt", "air": true})");
  ASSERT_TRUE(plain.air);
  EXPECT_EQ(plain.air->pressure, Air{}.pressure);
  EXPECT_EQ(plain.drag, 0.0);
  const Fabric airy = fabric_of("\"airy\"");
  EXPECT_EQ(airy.air->friction, 0.02);
  EXPECT_EQ(airy.air->lift, Air{}.lift);
  EXPECT_EQ(airy.drag, 0.0);
  EXPECT_EQ(read_fabric(folder_ / "fabrics/airy.json").drag, 0.0);
  EXPECT_EQ(fabric_of(R"({"base": "both", "air": true})").drag, 0.7) << "said, though by its base";
  EXPECT_EQ(fabric_of(R"({"air": {}, "drag": 0.3})").drag, 0.3);
  const Fabric still = fabric_of(R"({"base": "airy", "air": false})");
  EXPECT_FALSE(still.air);
  EXPECT_EQ(still.drag, Fabric{}.drag);
  using ::testing::HasSubstr;
  const auto refused = [&](const std::string& air) -> std::string {
    try {
      fabric_of("{\"air\": " + air + "}");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refused("1.2"), HasSubstr("/fabric/air: found 1.2, expected true, false, or an object"));
  EXPECT_THAT(refused(R"({"pressure": -1})"), HasSubstr("/fabric/air/pressure: found -1"));
  EXPECT_THAT(refused(R"({"density": 1.2})"), HasSubstr("unknown key \"density\""));
}

TEST_F(GarmentFile, TheShippedFabricsOrderAsTheyShould) {
  const auto shipped = [&](const std::string& name) {
    write_file(folder_ / "g.json", R"({"shape": {"grid": {"rows": 3, "columns": 3, "corner": [0,0,0], "across": [1,0,0],
                                   "down": [0,-1,0]}}, "fabric": ")" +
                                       test::source_file("assets/fabrics/" + name + ".json").string() + "\"}");
    return read_garment(folder_ / "g.json").fabric;
  };
  const Fabric silk = shipped("silk"), cotton = shipped("cotton"), wool = shipped("wool"), denim = shipped("denim");
  EXPECT_LT(silk.density, cotton.density);
  EXPECT_LT(cotton.density, wool.density);
  EXPECT_LT(wool.density, denim.density);
  EXPECT_LT(silk.bend, cotton.bend);
  EXPECT_LT(cotton.bend, wool.bend);
  EXPECT_LT(wool.bend, denim.bend);
}

TEST_F(GarmentFile, EveryMistakeIsNamedWithItsPlace) {
  using ::testing::HasSubstr;
  const auto with_shape = [](const std::string& shape) { return "{\"shape\": " + shape + "}"; };
  const std::string grid =
      R"({"grid": {"rows": 3, "columns": 3, "corner": [0,0,0], "across": [1,0,0], "down": [0,-1,0]}})";
  EXPECT_EQ(message_for(with_shape(grid)), "");
  EXPECT_THAT(message_for("{}"), HasSubstr("shape"));
  EXPECT_THAT(message_for(""), HasSubstr("an empty file"));
  EXPECT_THAT(message_for("{\"shape\": "), HasSubstr("line 1"));
  EXPECT_THAT(message_for(with_shape("{}")), HasSubstr("/shape"));
  EXPECT_THAT(message_for(R"({"shap": 1})"), HasSubstr("unknown key \"shap\""));
  EXPECT_THAT(message_for(with_shape(
                  R"({"grid": {"rows": 1, "columns": 3, "corner": [0,0,0], "across": [1,0,0], "down": [0,-1,0]}})")),
              HasSubstr("/shape/grid/rows: found 1, expected a whole number from 2"));
  EXPECT_THAT(message_for("{\"shape\": " + grid + R"(, "fabric": {"density": -1}})"),
              HasSubstr("/fabric/density: found -1"));
  EXPECT_THAT(message_for("{\"shape\": " + grid + R"(, "fabric": {"density": 1e999}})"), HasSubstr("finite"));
  EXPECT_THAT(message_for("{\"shape\": " + grid + R"(, "attachments": [{"joint": "Hips", "rows": 7}]})"),
              HasSubstr("/attachments/0"));
  EXPECT_THAT(message_for("{\"shape\": " + grid + R"(, "name": "a", "name": "b"})"), HasSubstr("twice"));
}

} // namespace
