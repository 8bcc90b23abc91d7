// Grids of settings as a person writes them, and what a setting makes of a scene.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/run/session.h"
#include "src/scene/load.h"
#include "src/scene/saved_drape.h"
#include "src/study/chart/same_cloth.h"
#include "src/study/chart/settings_grid.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <numeric>
#include <random>
#include <set>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;
using ::testing::HasSubstr;

namespace {

class SettingsGrid : public ::testing::Test {
protected:
  void SetUp() override { folder_ = scratch_folder(); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::vector<Setting> read(const std::string& text) {
    write_file(folder_ / "settings.json", text);
    return read_settings(folder_ / "settings.json", RunSettings());
  }
  void expect_refused(const std::string& text, const ::testing::Matcher<std::string>& message) {
    try {
      read(text);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), message);
    }
  }

  std::filesystem::path folder_;
};

TEST_F(SettingsGrid, IsEveryCombinationAndTheScenesOwnFirst) {
  const auto settings = read(R"({"settings": [
    {"substeps": [2, 4, 10], "features": ["auto", "particles"]},
    {"name": "plain", "solver": "mass_spring", "proxies": "none"}, {"substeps": 4}]})");
  ASSERT_EQ(settings.size(), 7u); // the scene's own 10 substeps and the second 4 are there once
  EXPECT_EQ(settings[0].name, "default");
  EXPECT_EQ(settings[0].substeps, 10);
  EXPECT_EQ(settings.back().name, "plain");
  EXPECT_EQ(settings.back().proxies, k_no_proxies);
  std::set<SettingValues> different;
  for (const Setting& s : settings) different.insert(setting_values(s));
  EXPECT_EQ(different.size(), settings.size());
}

TEST_F(SettingsGrid, EmptyOrUnknownIsRefusedWithItsPlace) {
  expect_refused(R"({"settings": []})",
                 HasSubstr("settings.json: /settings: found an empty grid of settings, expected"));
  expect_refused(R"({"settings": [{"substeps": []}]})", HasSubstr("/settings/0/substeps: found an empty grid"));
  expect_refused(R"({"settings": [{"substeps": [4, 0]}]})", HasSubstr("/settings/0/substeps/1: found 0"));
  expect_refused(R"({"settings": [{"colour": 3}]})", HasSubstr("unknown key \"colour\""));
  expect_refused(R"({"settings": [{"proxies": "nowhere.json"}]})", HasSubstr("no file"));
  expect_refused("{}", HasSubstr("settings"));
}

TEST_F(SettingsGrid, TooManyAreRefusedBeforeTheyAreMade) {
  const auto list = [](int count, int most) {
    std::vector<int> values;
    for (int k = 0; k < count; ++k) values.push_back(1 + k % most);
    return fmt::format("[{}]", fmt::join(values, ", "));
  };
  const std::string five_thousand = list(5000, 10000), hundred = list(100, 100);
  expect_refused(fmt::format(R"({{"settings": [{{"passes": {}, "substeps": {}}}]}})", hundred, five_thousand),
                 HasSubstr("/settings/0/substeps: found 5000 values, 100 times, expected at most 10000 settings"));
  const std::string grid = fmt::format(R"({{"passes": {}, "substeps": {}}})", hundred, hundred);
  expect_refused(fmt::format(R"({{"settings": [{}, {{}}]}})", grid),
                 HasSubstr("/settings/1: found {}, expected at most 9999 settings before it"));
  EXPECT_EQ(read(fmt::format(R"({{"settings": [{}]}})", grid)).size(), 10'000u); // in no time: the scene's is in it
}

TEST_F(SettingsGrid, ANumberOfProxiesIsToBeFitted) {
  const auto settings = read(R"({"settings": [{"proxies": 24}]})");
  EXPECT_EQ(fitted_count(settings.at(1)), 24);
  EXPECT_EQ(fitted_count(settings.at(0)), std::nullopt);
}

TEST_F(SettingsGrid, TheDancersHasTheReportsSettingAndItsOwn) {
  const SceneDescription dance = read_scene(source_file("assets/scenes/dance.json"));
  for (const bool quick : {true, false}) {
    const auto settings = builtin_settings(dance, quick);
    EXPECT_EQ(settings.front(), own_setting(dance.settings));
    const Setting report = settings.back();
    EXPECT_EQ(report.name, "report");
    EXPECT_EQ(report.substeps * 5, 1000 / report.frames_per_second); // of 5 ms
    EXPECT_THAT(report.proxies, ::testing::EndsWith("dancer-hand.json"));
  }
}

TEST(Setting, OptionsNameWhatDiffers) {
  Setting own, other;
  EXPECT_THAT(setting_options(setting_values(own), setting_values(own)), ::testing::IsEmpty());
  other.solver = cloth::SolverKind::mass_spring;
  other.adaptive_substeps = false;
  EXPECT_THAT(setting_options(setting_values(other), setting_values(own)),
              ::testing::ElementsAre("--solver", "mass_spring", "--no-adaptive-substeps"));
  EXPECT_EQ(difference(setting_values(other), setting_values(own)), "mass_spring, adaptive substeps off");
  EXPECT_EQ(difference(setting_values(own), setting_values(own)), "");
}

TEST(Setting, ASceneOfAnotherResolutionWearsTheSameGarments) {
  const LoadedScene scene = load_scene(read_scene(source_file("assets/scenes/dance.json")));
  for (const double resolution : {0.5, 2.0}) {
    Setting setting = own_setting(scene.settings);
    setting.resolution = resolution;
    const LoadedScene other = with_setting(scene, setting);
    for (std::size_t g = 0; g < scene.garments.size(); ++g) {
      const cloth::Garment &a = scene.garments[g], &b = other.garments[g];
      EXPECT_NEAR(b.rows, resolution * a.rows, 1.0);
      EXPECT_NEAR(b.columns, resolution * a.columns, 1.0);
      const auto mass = [](const cloth::Garment& x) { return std::accumulate(x.masses.begin(), x.masses.end(), 0.0); };
      EXPECT_NEAR(mass(b), mass(a), 0.04 * mass(a)); // chords of a coarser tube
      // Positions carried over lie where the garment was made anew, up to the chords.
      const std::vector<Vec3> carried = positions_on(a, a.rest_positions, b);
      for (std::size_t i = 0; i < carried.size(); ++i)
        EXPECT_LT((carried[i] - b.rest_positions[i]).norm(), 0.012) << a.name << " " << i;
      EXPECT_EQ(b.pins.size(), static_cast<std::size_t>(b.columns));
    }
  }
}

TEST(Setting, CoarserClothDoesNotSpringApartAtTheStart) {
  const LoadedScene scene = load_scene(read_scene(source_file("assets/scenes/dance.json")));
  bool stale = false;
  const auto start = saved_drape(scene, &stale);
  ASSERT_TRUE(start.has_value());
  Setting setting = own_setting(scene.settings);
  setting.resolution = 0.5;
  const LoadedScene coarse = with_setting(scene, setting);
  Session session(coarse);
  session.start(start_at_resolution(scene, *start, setting.resolution));
  for (int f = 0; f < 6; ++f) session.advance();
  double fastest = 0.0;
  for (const Vec3& v : session.garment(0).particles().velocities) fastest = std::max(fastest, v.norm());
  EXPECT_LT(fastest, 3.0); // m/s; it was more than 6 where it began pressed together
  EXPECT_EQ(session.troubles().frames_split, 0);
}

TEST(SameCloth, PositionsAreCarriedExactlyWhereGridsMeet) {
  cloth::GarmentDescription coarse;
  coarse.shape = cloth::GridShape{5, 4, Vec3::Zero(), Vec3::UnitX(), -Vec3::UnitY()};
  const cloth::Garment a = cloth::build_garment(coarse), b = cloth::build_garment(cloth::resampled(coarse, 3.0));
  std::mt19937_64 random(6);
  std::vector<Vec3> positions;
  for (int i = 0; i < a.particle_count(); ++i)
    positions.emplace_back(static_cast<double>(random() % 100), static_cast<double>(random() % 100), 1.0);
  const std::vector<Vec3> fine = positions_on(a, positions, b);
  for (int row = 0; row < a.rows; ++row)
    for (int column = 0; column < a.columns; ++column)
      EXPECT_LT((fine[3 * row * b.columns + 3 * column] - positions[row * a.columns + column]).norm(), 1e-12);
  const std::vector<Vec3> back = positions_on(b, fine, a);
  for (std::size_t i = 0; i < back.size(); ++i) EXPECT_LT((back[i] - positions[i]).norm(), 1e-9);
}

TEST(SameCloth, DistanceOfAMovedSheetIsTheWay) {
  cloth::GarmentDescription sheet;
  sheet.shape = cloth::GridShape{6, 6, Vec3::Zero(), Vec3::UnitX(), -Vec3::UnitY()};
  const cloth::Garment a = cloth::build_garment(sheet), b = cloth::build_garment(cloth::resampled(sheet, 2.0));
  std::vector<Vec3> moved = b.rest_positions;
  for (Vec3& p : moved) p += Vec3(0, 0, 0.03);
  const SurfaceDistance d = surface_distance(a, a.rest_positions, b, moved);
  EXPECT_NEAR(d.rms(), 0.03, 1e-12);
  EXPECT_NEAR(d.hausdorff, 0.03, 1e-12);
  EXPECT_NEAR(surface_distance(a, a.rest_positions, b, b.rest_positions).hausdorff, 0.0, 1e-12);
  moved[0].z() = 0.5; // one corner far out: only one of the two directions sees it
  EXPECT_NEAR(surface_distance(a, a.rest_positions, b, moved).hausdorff, 0.5, 1e-12);
}

} // namespace
