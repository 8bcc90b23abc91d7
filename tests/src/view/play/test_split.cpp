// Two settings of a scene side by side.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/scene/load.h"
#include "src/scene/scene_override.h"
#include "src/view/play/split_player.h"
#include "src/view/render/error_colours.h"
#include "tests/support/paths.h"
#include "tests/support/read_png.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"
#include "tests/support/virtual_display.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

class Split : public ::testing::Test {
protected:
  Split()
      : folder_(test::scratch_folder()), file_(test::write_small_scene(folder_)), scene_(load_scene(read_scene(file_))),
        coarse_(scene_) {
    SceneDescription description = scene_.description();
    override_setting(description, "substeps=2", "--split");
    coarse_.settings = description.changed_settings();
  }
  ~Split() override { std::filesystem::remove_all(folder_); }

  GarmentPositions start() const { return {scene_.garments[0].rest_positions}; }

  std::filesystem::path folder_;
  std::string file_;
  LoadedScene scene_, coarse_;
};

TEST_F(Split, BothShowTheSameFrameEachWithTheBitsOfItsOwnRun) {
  Session left(scene_), right(coarse_);
  left.start(start());
  right.start(start());
  std::vector<std::array<std::uint64_t, 2>> hashes = {{left.state_hash(), right.state_hash()}};
  for (int frame = 0; frame < 12; ++frame) {
    left.advance();
    right.advance();
    hashes.push_back({left.state_hash(), right.state_hash()});
  }
  ASSERT_NE(hashes[12][0], hashes[12][1]);
  SplitPlayer player({&scene_, start(), "as it is"}, {&coarse_, start(), "substeps=2"}, 12);
  for (const int way : {5, -2, 9, -7}) {
    player.go(way);
    do {
      const std::vector<FrameView> views = player.views({});
      ASSERT_EQ(views.size(), 2u);
      const std::vector<Figures> figures = player.figures();
      ASSERT_EQ(figures[0].frame, figures[1].frame);
      for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(figures[k].state_hash, hashes[figures[k].frame][k]);
    } while (player.behind());
  }
  EXPECT_EQ(player.figures()[0].frame, 5);
  EXPECT_EQ(player.views({})[1].caption, "substeps=2");
  player.left().pick(0, 44);
  player.right().pick_as(player.left());
  EXPECT_EQ(player.right().why_shown()->particle, 44);
}

TEST_F(Split, TheClothOfTheSecondIsColouredByTheDistance) {
  Session left(scene_), right(coarse_);
  for (Session* session : {&left, &right}) {
    session->start(start());
    for (int frame = 0; frame < 12; ++frame) session->advance();
    session->skin_body();
  }
  FrameState other;
  capture(left, other);
  SceneView view(coarse_);
  const FrameView frame = view.frame(right, {}, &other);
  const SurfaceView& cloth = frame.surfaces.back();
  ASSERT_EQ(cloth.colours.size(), cloth.positions.size());
  // Drawn three times as fine; particles are every third vertex of every third row.
  const int columns = scene_.garments[0].columns, fine = 3 * (columns - 1) + 1;
  double most = 0.0;
  for (int i = 0; i < scene_.garments[0].particle_count(); ++i) {
    const double apart = (left.garment(0).particles().positions[i] - right.garment(0).particles().positions[i]).norm();
    most = std::max(most, apart);
    const Colour expected = error_colour(k_apart_scale, apart);
    const Colour& found = cloth.colours[static_cast<std::size_t>(i / columns * 3 * fine + i % columns * 3)];
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5f) << i;
  }
  EXPECT_GT(most, k_apart_scale.tolerance); // there was something to see
  EXPECT_TRUE(view.frame(right, {}).surfaces.back().colours.empty());
}

TEST_F(Split, TheProgramMeasuresBothAndWhatIsBetween_slow) {
  const auto json_file = folder_ / "split.json";
  const test::Outcome outcome = test::run_program({"play", file_, "--split", "substeps=2", "--at", "0,12", "-o",
                                                   folder_ / "shots", "--size", "320x240", "--json", json_file});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const auto json = nlohmann::json::parse(read_file(json_file));
  EXPECT_EQ(json["substeps"]["asked"], 8);
  EXPECT_EQ(json["against"]["substeps"]["asked"], 2);
  EXPECT_NE(json["state_hash"], json["against"]["state_hash"]);
  EXPECT_GT(json["apart_mm"]["max"], 0.0);
  EXPECT_LE(json["apart_mm"]["mean"], json["apart_mm"]["max"]);
  const auto first = test::read_png(folder_ / "shots" / "small-0000.png");
  ASSERT_TRUE(first);
  EXPECT_EQ(first->width, 320);
  // A scene against itself is nowhere apart.
  const test::Outcome same = test::run_program(
      {"play", file_, "--against", file_, "--headless", "--no-pictures", "--frames", "12", "--json", json_file});
  ASSERT_EQ(same.status, 0) << same.output;
  EXPECT_EQ(nlohmann::json::parse(read_file(json_file))["apart_mm"]["max"], 0.0);
}

TEST_F(Split, InAWindowBothComeToTheBitsOfNoWindow_slow) {
  const VirtualDisplay display;
  if (!display.running()) GTEST_SKIP() << "no Xvfb here";
  const auto in_window = folder_ / "window.json", without = folder_ / "headless.json";
  test::Outcome outcome = test::run_program(
      {"play", file_, "--split", "substeps=2", "--window", "--frames", "12", "--size", "320x240", "--json", in_window});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  outcome = test::run_program(
      {"play", file_, "--split", "substeps=2", "--headless", "--no-pictures", "--frames", "12", "--json", without});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const auto window = nlohmann::json::parse(read_file(in_window)), headless = nlohmann::json::parse(read_file(without));
  EXPECT_EQ(window["state_hash"], headless["state_hash"]);
  EXPECT_EQ(window["against"]["state_hash"], headless["against"]["state_hash"]);
}

TEST_F(Split, SettingsThatAreNoneAreRefusedInOneLine) {
  for (const char* wrong : {"substeps", "substeps=", "substeps=0", "substeps=two", "speed=1", "solver=magic",
                            "swept=perhaps", "proxies=nowhere.json", "", "="}) {
    SceneDescription description = scene_.description();
    try {
      override_setting(description, wrong, "--split");
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("--split"), std::string::npos) << error.what();
    }
  }
  SceneDescription description = scene_.description();
  for (const char* right : {"solver=mass_spring", "backend=brute", "features=particles", "swept=false", "passes=3",
                            "adaptive_substeps=false", "double_precision=true", "self_collision=true", "proxies=none"})
    override_setting(description, right, "--split");
  const RunSettings changed = description.changed_settings();
  EXPECT_EQ(changed.solver, cloth::SolverKind::mass_spring);
  EXPECT_EQ(changed.backend, proxies::Backend::brute);
  EXPECT_EQ(changed.passes, 3);
  EXPECT_FALSE(changed.swept);
  EXPECT_FALSE(description.proxies);
}

} // namespace
} // namespace tutu::app
