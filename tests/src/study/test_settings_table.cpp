// The one table of settings against everything that is made from it, and what of it garments honour.
#include "cloth/solver.h"
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/run/settings_table.h"
#include "src/scene/load.h"
#include "src/scene/scene_override.h"
#include "src/study/bench/mesh_sheet.h"
#include "src/study/chart/row.h"
#include "src/study/chart/settings_grid.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using namespace tutu::app;
using nlohmann::json;
using ::testing::HasSubstr;

namespace {

/// A value besides the standard one.
double another(const SettingRow& row) { return row.standard() == row.most ? row.least : row.standard() + 1; }

TEST(SettingsTable, EachRowReadsAndWritesOneMember) {
  for (const SettingRow& row : settings_table()) {
    RunSettings settings;
    row.set(settings, another(row));
    EXPECT_NE(settings, RunSettings{}) << row.name << " is its own";
    for (const SettingRow& other : settings_table())
      EXPECT_EQ(other.get(settings), &other == &row ? another(row) : other.standard())
          << row.name << ", " << other.name;
    row.set(settings, row.standard());
    EXPECT_EQ(settings, RunSettings{}) << row.name;
    EXPECT_EQ(find_setting(row.name), &row);
  }
  EXPECT_EQ(find_setting("speed"), nullptr);
}

TEST(SettingsTable, TextsAreValuesAndNothingElseIs) {
  for (const SettingRow& row : settings_table()) {
    for (const double value : {1.0 * row.least, row.standard(), another(row), 1.0 * row.most})
      EXPECT_EQ(value_of(row, text_of(row, value)), value) << row.name;
    for (const char* none : {"", " ", "magic", "-1", "1e3", "3x", "100000000000000000000"})
      EXPECT_FALSE(value_of(row, none)) << row.name << none;
    if (row.is_choice() || row.is_switch()) continue;
    EXPECT_FALSE(value_of(row, std::to_string(row.least - 1)));
    EXPECT_FALSE(value_of(row, std::to_string(row.most + 1)));
    EXPECT_EQ(value_of(row, "29.97"), row.has_fractions ? std::optional(29.97) : std::nullopt) << row.name;
    EXPECT_EQ(value_of(row, "0").has_value(), row.least <= 0) << row.name;
    for (const char* bad : {"-29.97", "nan", "inf", "1000000000", "29.97.1", "29,97"})
      EXPECT_FALSE(value_of(row, bad)) << row.name << bad;
  }
}

TEST(SettingsTable, ARateMayHaveFractions) {
  const SettingRow& row = *find_setting("frames_per_second");
  for (const char* rate : {"29.97", "23.976", "59.94", "12.5", "1", "60", "10000"})
    EXPECT_EQ(text_of(row, *value_of(row, rate)), rate);
  RunSettings settings;
  row.set(settings, 29.97);
  EXPECT_EQ(settings.frame_seconds(), 1.0 / 29.97);
  // What a drape depends on: of whole rates the number, so that hashes stay what they were.
  const auto numbers = [](const RunSettings& of) {
    std::vector<int> all;
    for_each_draping(of, [&](int number) { all.push_back(number); });
    return all;
  };
  EXPECT_TRUE(numbers({}).empty());
  const std::size_t name = std::string_view("frames_per_second").size();
  EXPECT_EQ(numbers(settings).size(), name + 2);
  row.set(settings, 30);
  EXPECT_EQ(numbers(settings).size(), name + 1);
  EXPECT_EQ(numbers(settings).back(), 30);
}

json schema_of(const SettingRow& row) {
  if (row.is_choice()) return {{"enum", row.names}};
  if (row.is_switch()) return {{"type", "boolean"}};
  return {{"type", row.has_fractions ? "number" : "integer"}, {"minimum", row.least}, {"maximum", row.most}};
}

TEST(SettingsTable, SchemasSayTheSame) {
  const auto schema = [](const std::string& name) {
    return json::parse(read_file(test::source_file("assets/schema/" + name)));
  };
  const json scene = schema("scene.schema.json").at("properties");
  const json grid = schema("settings.schema.json").at("properties").at("settings").at("items").at("properties");
  std::size_t in_scene = 0;
  for (const SettingRow& row : settings_table()) {
    json expected = schema_of(row);
    if (row.repeats) {
      EXPECT_FALSE(grid.contains(row.name)) << "starts are the chart's own";
    } else {
      EXPECT_EQ(grid.at(row.name),
                (json{{"oneOf", {expected, {{"type", "array"}, {"minItems", 1}, {"items", expected}}}}}))
          << row.name;
    }
    const std::string standard = row.is_switch() ? (row.standard() ? "true" : "false") : text_of(row, row.standard());
    expected["description"] = row.words + (" (default " + standard + ")");
    EXPECT_EQ(scene.at(row.section).at("properties").at(row.key), expected) << row.name;
  }
  for (const char* section : {"solver", "collision"}) in_scene += scene.at(section).at("properties").size();
  EXPECT_EQ(in_scene, settings_table().size()) << "and nothing else";
  EXPECT_EQ(grid.size(), settings_table().size() - 1 + 4) << "name, comment, resolution, proxies; no seed";
}

TEST(SettingsTable, HelpOptionsAndColumnsAreMadeFromIt) {
  for (const char* command : {"play", "drape", "validate", "stability", "cell"}) {
    const std::string help = test::run_program({command, "--help"}).output;
    for (const SettingRow& row : settings_table()) EXPECT_THAT(help, HasSubstr("  " + option_of(row))) << command;
  }
  for (const SettingRow& row : settings_table()) {
    EXPECT_THAT(row_columns(), ::testing::Contains(row.name));
    const auto wrong = test::run_program({"play", option_of(row) + "=magic"});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_THAT(wrong.output, HasSubstr(option_of(row).substr(2)));
    if (!row.is_switch()) {
      EXPECT_THAT(wrong.output, HasSubstr(expected_of(row)));
    }
  }
}

cloth::Garment woven() {
  cloth::GarmentDescription description;
  description.shape = cloth::GridShape{5, 5};
  return cloth::build_garment(description);
}
cloth::Garment meshed() {
  cloth::GarmentDescription description;
  description.shape = app::mesh_sheet(5, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  return cloth::build_garment(description);
}

/// Of the settings that not everything honours, what is done without.
struct Without {
  const char* name;
  int value;
  bool in_springs, on_meshes, against_the_body; ///< refused there
};
constexpr Without k_without[] = {{"passes", 2, true, true, false},
                                 {"self_collision", 1, true, true, false},
                                 {"features", 0, false, false, true},
                                 {"swept", 1, false, false, true},
                                 {"double_precision", 0, true, false, false}};

TEST(SettingsTable, WhatAGarmentDoesNotHonourIsTold) {
  const std::vector<cloth::Garment> grids = {woven()}, meshes = {meshed()};
  for (const SettingRow& row : settings_table())
    for (const auto solver : {cloth::SolverKind::xpbd, cloth::SolverKind::mass_spring})
      for (const auto backend :
           {proxies::Backend::hybrid, proxies::Backend::fcl, proxies::Backend::brute, proxies::Backend::mesh})
        for (const std::vector<cloth::Garment>* garments : {&grids, &meshes})
          for (int value = row.least; value <= std::min(row.most, row.least + 2); ++value) {
            RunSettings settings;
            settings.solver = solver;
            settings.backend = backend;
            const bool fixed = std::string_view(row.name) == "solver" || std::string_view(row.name) == "backend";
            if (!fixed) row.set(settings, value);
            const bool springs = solver == cloth::SolverKind::mass_spring;
            bool refused = false;
            for (const Without& without : k_without)
              if (without.name == std::string_view(row.name) && without.value == value && !fixed)
                refused = refused || (springs && without.in_springs) ||
                          (garments == &meshes && !springs && without.on_meshes) ||
                          (backend == proxies::Backend::mesh && without.against_the_body);
            if (row.name == std::string_view("passes") && value > 2 && (springs || garments == &meshes)) refused = true;
            EXPECT_EQ(unhonoured(row, settings, *garments).has_value(), refused)
                << row.name << " " << value << (springs ? ", springs" : "") << (garments == &meshes ? ", mesh" : "");
          }
}

class StatedSettings : public ::testing::Test {
protected:
  void SetUp() override { scene_ = test::write_small_scene(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// The scene with these sections, loaded with these changes; what is refused in it, or "".
  std::string refusal(const std::string& sections, const std::vector<std::string>& changes = {}) {
    json scene = json::parse(read_file(scene_));
    scene.erase("solver");
    scene.update(json::parse("{" + sections + "}"));
    write_file(folder_ / "other.json", scene.dump());
    try {
      SceneDescription description = read_scene(folder_ / "other.json");
      for (const std::string& change : changes) override_setting(description, change, "--split");
      notes_ = load_scene(description).notes;
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  std::filesystem::path folder_ = test::scratch_folder();
  std::string scene_;
  std::vector<std::string> notes_;
};

TEST_F(StatedSettings, InASceneAreRefusedWithTheirPlace) {
  EXPECT_EQ(refusal(R"("solver": {"passes": 3})"), "");
  EXPECT_THAT(
      refusal(R"("solver": {"name": "mass_spring", "passes": 3})"),
      HasSubstr("other.json: /solver/passes: found 3 passes, expected 1 passes, or nothing: solver mass_spring"));
  EXPECT_THAT(refusal(R"("solver": {"name": "mass_spring"}, "collision": {"self_collision": true})"),
              HasSubstr("/collision/self_collision: found self collision on"));
  EXPECT_EQ(refusal(R"("solver": {"name": "mass_spring", "passes": 1}, "collision": {"swept": false})"), "")
      << "what is true is no mistake";
}

TEST_F(StatedSettings, InPlaceOfTheScenesAreRefusedByTheirOption) {
  EXPECT_THAT(refusal(R"("solver": {})", {"solver=mass_spring", "self_collision=true"}),
              HasSubstr("--split: found self collision on"));
  EXPECT_EQ(refusal(R"("solver": {"passes": 3})", {"solver=mass_spring"}), "") << "what only that made useless";
  EXPECT_THAT(notes_, ::testing::Contains(HasSubstr("3 passes of the scene does not count")));
  EXPECT_THAT(refusal(R"("solver": {"name": "mass_spring", "passes": 3})", {"substeps=4"}),
              HasSubstr("/solver/passes"));
}

TEST_F(StatedSettings, OfAChartAndItsCellsAreRefused) {
  write_file(folder_ / "grid.json", R"({"settings": [{"solver": ["xpbd", "mass_spring"], "passes": [1, 3]}]})");
  const auto chart = test::run_program(
      {"chart", scene_, "--settings", (folder_ / "grid.json").string(), "--out", (folder_ / "chart").string()});
  EXPECT_EQ(chart.status, 2);
  EXPECT_THAT(chart.output, HasSubstr("grid.json"));
  EXPECT_THAT(chart.output, HasSubstr("found 3 passes"));
  const auto cell = test::run_program({"cell", scene_, "--solver", "mass_spring", "--self-collision"});
  EXPECT_EQ(cell.status, 2);
  EXPECT_THAT(cell.output, HasSubstr("--self-collision: found self collision on"));
}

} // namespace
