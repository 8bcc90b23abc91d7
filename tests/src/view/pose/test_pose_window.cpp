// The pose editor as a user meets it: its window on a display of the test's own, with real pointer and keys; and what
// it says to bad input.
#include "rig/character.h"
#include "rig/import/import.h"
#include "rig/io/clip_file.h"
#include "rig/io/file_io.h"
#include "src/view/pose/edit_state.h"
#include "tests/support/child_program.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/virtual_display.h"

#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace tutu::app {
namespace {

using nlohmann::json;
using test::xdotool;
using ::testing::HasSubstr;

const rig::Skeleton& dancer() {
  static const rig::Skeleton k_skeleton =
      rig::import_character(test::source_file("assets/characters/dancer.dae")).character.skeleton;
  return k_skeleton;
}

/// An editor at work in a folder.
class PoseWindow : public ::testing::Test {
protected:
  static constexpr int k_width = 480, k_height = 420;

  void SetUp() override { folder_ = test::scratch_folder(); }
  void TearDown() override {
    program_.reset();
    std::filesystem::remove_all(folder_);
  }

  /// Starts the program and waits for its first picture.
  void start() {
    std::filesystem::remove(folder_ / "state.json");
    program_.emplace(std::vector<std::string>{"pose", test::source_file("assets/characters/dancer.dae"), "--out",
                                              clip(), "--json", folder_ / "state.json", "--width",
                                              std::to_string(k_width), "--height", std::to_string(k_height)},
                     folder_ / "output.txt");
    ASSERT_TRUE(wait_for([](const json&) { return true; })) << output();
    ASSERT_THAT(output(), HasSubstr("ready"));
    ASSERT_TRUE(xdotool("search --sync --onlyvisible --name 'tutu pose' windowmove 0 0 windowfocus --sync"));
  }

  /// Until the editor's state is so; false when it is not within a minute.
  bool wait_for(const std::function<bool(const json&)>& reached) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < end) {
      if (std::filesystem::exists(folder_ / "state.json")) {
        state_ = json::parse(read_file(folder_ / "state.json"));
        if (reached(state_)) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ADD_FAILURE() << "waited in vain; the state is " << state_.dump(1).substr(0, 1500) << "\n" << output();
    return false;
  }
  bool wait_for(const char* member, const json& value) {
    return wait_for([&](const json& state) { return state[member] == value; });
  }
  bool wait_for_keys(std::size_t count) {
    return wait_for([&](const json& state) { return state["keys"].size() == count; });
  }

  std::string clip() const { return folder_ / "steps.json"; }
  std::string output() const {
    const auto file = folder_ / "output.txt";
    return std::filesystem::exists(file) ? read_file(file) : "";
  }

  static double number(const json& value) { return value.get<double>(); }
  static Vec3 vector_of(const json& v) { return Vec3(number(v[0]), number(v[1]), number(v[2])); }
  Pose pose() const {
    Pose pose;
    for (const json& joint : state_["pose"]) {
      const json& q = joint["rotation"];
      pose.push_back({Quat(number(q[3]), number(q[0]), number(q[1]), number(q[2])), vector_of(joint["translation"])});
    }
    return pose;
  }

  // The camera, once more, from its numbers alone.
  struct Sight {
    Vec3 eye, forward, right, up;
    double per_pixel;
  };
  Sight sight() const {
    const json& camera = state_["camera"];
    Sight sight;
    sight.eye = vector_of(camera["eye"]);
    sight.forward = (vector_of(camera["target"]) - sight.eye).normalized();
    sight.right = sight.forward.cross(Vec3::UnitY()).normalized();
    sight.up = sight.right.cross(sight.forward);
    sight.per_pixel = 2.0 * std::tan(0.5 * camera["vertical_fov"].get<double>()) / camera["height"].get<double>();
    return sight;
  }
  Vec3 direction_of(int x, int y) const {
    const Sight s = sight();
    const double right = (x + 0.5 - 0.5 * k_width) * s.per_pixel, up = (0.5 * k_height - y - 0.5) * s.per_pixel;
    return (s.forward + right * s.right + up * s.up).normalized();
  }
  std::pair<int, int> pixel_of(const std::string& joint) const {
    const Sight s = sight();
    const Vec3 away = rig::model_of_joint(dancer(), pose(), *dancer().find(joint)).translation - s.eye;
    const double depth = away.dot(s.forward) * s.per_pixel;
    return {static_cast<int>(std::floor(0.5 * k_width + away.dot(s.right) / depth)),
            static_cast<int>(std::floor(0.5 * k_height - away.dot(s.up) / depth))};
  }

  /// Takes the left hand with Shift and moves it to a pixel in three steps.
  void take_hand_to(int x, int y) {
    const auto [from_x, from_y] = pixel_of("LeftHand");
    ASSERT_TRUE(xdotool(fmt::format("mousemove {} {} keydown shift", from_x, from_y)));
    ASSERT_TRUE(wait_for("hovered", dancer().names[*dancer().find("LeftHand")]));
    ASSERT_TRUE(xdotool("mousedown 1"));
    ASSERT_TRUE(wait_for("dragging", true));
    for (const int step : {1, 2, 3})
      ASSERT_TRUE(
          xdotool(fmt::format("mousemove {} {}", from_x + (x - from_x) * step / 3, from_y + (y - from_y) * step / 3)));
    ASSERT_TRUE(wait_for("pointer", json::array({x + 0.5, y + 0.5})));
  }
  void drag_hand_to(int x, int y) {
    take_hand_to(x, y);
    if (HasFatalFailure()) return;
    ASSERT_TRUE(xdotool("mouseup 1 keyup shift"));
    ASSERT_TRUE(wait_for("dragging", false));
  }
  void press(const std::string& key) { ASSERT_TRUE(xdotool("key " + key)); }

  std::filesystem::path folder_;
  std::optional<test::ChildProgram> program_;
  json state_;
};

/// What a drag of the hand along this line of sight makes of the rotation of the forearm above it:
/// R <- (R_gp^-1 R(theta, n) R_gp) R, the bone turned to where the line meets its sphere on the side of the hand.
Quat dragged_forearm(const Pose& pose, const Vec3& eye, const Vec3& direction) {
  const int hand = *dancer().find("LeftHand"), forearm = dancer().parents[hand], arm = dancer().parents[forearm];
  const Vec3 centre = rig::model_of_joint(dancer(), pose, forearm).translation;
  const Vec3 bone = rig::model_of_joint(dancer(), pose, hand).translation - centre;
  const Vec3 foot = eye + (centre - eye).dot(direction) * direction;
  const double half = std::sqrt(bone.squaredNorm() - (foot - centre).squaredNorm());
  const Vec3 front = foot - half * direction, back = foot + half * direction;
  const Vec3 to = ((front - centre - bone).norm() < (back - centre - bone).norm() ? front : back) - centre;
  const double angle = std::atan2(bone.cross(to).norm(), bone.dot(to));
  const Quat turn(Eigen::AngleAxisd(angle, bone.cross(to).normalized()));
  const Quat above = rig::model_of_joint(dancer(), pose, arm).rotation;
  return above.conjugate() * turn * above * pose[forearm].rotation;
}

TEST_F(PoseWindow, AWristIsDraggedSavedScrubbedAndSurvivesAKill_slow) {
  if (!test::xdotool_available()) GTEST_SKIP() << "no xdotool here";
  const VirtualDisplay display;
  if (!display.running()) GTEST_SKIP() << "no Xvfb here";
  start();
  if (HasFatalFailure()) return;
  press("s"); // the rest pose
  ASSERT_TRUE(wait_for_keys(1));

  // Shift + drag, against the closed form.
  const Pose before = pose();
  const auto [x, y] = pixel_of("LeftHand");
  const int to_x = x - 6, to_y = y - 17;
  const Quat expected = dragged_forearm(before, sight().eye, direction_of(to_x, to_y));
  drag_hand_to(to_x, to_y);
  if (HasFatalFailure()) return;
  EXPECT_EQ(state_["undo_depth"], 2);
  EXPECT_EQ(state_["selected"], dancer().names[*dancer().find("LeftHand")]);
  press("s");
  ASSERT_TRUE(wait_for_keys(2));
  press("f");
  ASSERT_TRUE(wait_for("dirty", false));
  const EditState written = edit_state(rig::read_clip(clip()), dancer());
  ASSERT_EQ(written.keys.size(), 3U); // closed with the first
  EXPECT_TRUE(is_closed(written));
  const int forearm = *dancer().find("LeftForeArm");
  const Pose& saved = *written.keys[1].pose;
  const double error = (saved[forearm].rotation.coeffs() - expected.coeffs()).norm();
  EXPECT_LT(error, 1e-6);
  RecordProperty("drag_error", fmt::format("{:.3g}", error));
  std::printf("drag: off the closed form by %.3g\n", error);
  EXPECT_GT(saved[forearm].rotation.angularDistance(before[forearm].rotation), 0.05);
  for (std::size_t j = 0; j < saved.size(); ++j)
    if (static_cast<int>(j) != forearm) {
      EXPECT_EQ(saved[j].rotation.coeffs(), before[j].rotation.coeffs()) << dancer().names[j];
    }
  for (const char* text : {"translations", "rotations", "times"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / fmt::format("steps.{}.txt", text)));

  // Undo and redo by their keys.
  press("ctrl+z");
  ASSERT_TRUE(wait_for("redo_depth", 1));
  press("ctrl+y");
  ASSERT_TRUE(wait_for("redo_depth", 0));
  press("ctrl+q");
  EXPECT_EQ(program_->end(0), 0);

  // Again: what was written is there; the timeline scrubs between its keys.
  start();
  if (HasFatalFailure()) return;
  EXPECT_EQ(state_["keys"].size(), 3U);
  EXPECT_TRUE(same_pose(pose(), *written.keys[0].pose));
  ASSERT_TRUE(xdotool(fmt::format("mousemove {} {} mousedown 1", k_width / 4, k_height - 38)));
  ASSERT_TRUE(wait_for([](const json& state) { return state["time"] > 0.0; }));
  ASSERT_TRUE(xdotool("mouseup 1"));
  ASSERT_TRUE(wait_for("undo_depth", 1));
  EXPECT_EQ(state_["dirty"], false);
  Pose between(before.size());
  rig::sample(rig::build_clip(rig::read_clip(clip()), dancer()), number(state_["time"]), between);
  EXPECT_TRUE(same_pose(pose(), between));

  // A key is dragged along the timeline: the middle one, a third of the way from 0 to 1.5 s.
  const int key_x = 172, along = 40;
  ASSERT_TRUE(xdotool(fmt::format("mousemove {} {} mousedown 1", key_x, k_height - 38)));
  ASSERT_TRUE(wait_for("time", 0.5));
  ASSERT_TRUE(xdotool(fmt::format("mousemove {} {}", key_x + along, k_height - 38)));
  ASSERT_TRUE(wait_for([](const json& state) { return state["keys"][1]["time"] > 0.55; }));
  ASSERT_TRUE(xdotool("mouseup 1"));
  ASSERT_TRUE(wait_for("undo_depth", 2));
  EXPECT_LT(number(state_["keys"][1]["time"]), 0.75);
  EXPECT_EQ(state_["dirty"], true);
  press("ctrl+z");
  ASSERT_TRUE(wait_for("undo_depth", 1));
  EXPECT_EQ(state_["dirty"], false);

  // Killed in the middle of a drag: the drag before it is offered again.
  const auto [from_x, from_y] = pixel_of("LeftHand");
  drag_hand_to(from_x + 5, from_y + 4);
  if (HasFatalFailure()) return;
  const Pose in_hand = pose();
  ASSERT_TRUE(wait_for("dirty", true));
  take_hand_to(from_x - 9, from_y - 8);
  if (HasFatalFailure()) return;
  EXPECT_EQ(program_->end(SIGKILL), 128 + SIGKILL);
  ASSERT_TRUE(xdotool("mouseup 1 keyup shift"));

  start();
  if (HasFatalFailure()) return;
  EXPECT_THAT(output(), HasSubstr("found unsaved work of an earlier session"));
  EXPECT_EQ(state_["question"], "take up autosave");
  press("Return");
  ASSERT_TRUE(wait_for("question", ""));
  EXPECT_TRUE(same_pose(pose(), in_hand));
  EXPECT_TRUE(same_clip(edit_state(rig::read_clip(clip()), dancer()), written));
  EXPECT_EQ(state_["keys"].size(), 3U);
  EXPECT_EQ(state_["dirty"], true);

  // Leaving asks.
  press("ctrl+q");
  ASSERT_TRUE(wait_for("question", "leave unsaved"));
  press("Escape");
  ASSERT_TRUE(wait_for("question", ""));
  press("ctrl+q");
  ASSERT_TRUE(wait_for("question", "leave unsaved"));
  press("Return"); // write and leave
  EXPECT_EQ(program_->end(0), 0);
  EXPECT_EQ(rig::read_clip(clip()).keys.size(), 4U);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "steps.autosave.json"));
}

class PoseProgram : public PoseWindow {
protected:
  std::string file(const std::string& name, const std::string& text) {
    write_file(folder_ / name, text);
    return folder_ / name;
  }
  void expect_refused(std::vector<std::string> arguments, const ::testing::Matcher<std::string>& message) {
    arguments.insert(arguments.begin(), "pose");
    const test::Outcome outcome = test::run_program(arguments, "unset DISPLAY WAYLAND_DISPLAY;");
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, message);
    EXPECT_THAT(outcome.output, ::testing::StartsWith("tutu: "));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  }
  const std::string dancer_ = test::source_file("assets/characters/dancer.dae");
};

TEST_F(PoseProgram, BadInputIsOneMessageAndStatus2) {
  expect_refused({folder_ / "none.dae", "--out", clip()}, HasSubstr("none.dae: found no such file"));
  expect_refused({file("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "--out", clip()},
                 HasSubstr("bare.obj: found"));
  const std::string foreign = file("foreign.json", R"({"keys": [{"time": 0, "joints": {"Tail": {}}}]})");
  expect_refused({dancer_, "--motion", foreign, "--out", clip()},
                 ::testing::AllOf(HasSubstr("foreign.json: key 0, joint Tail: found"), HasSubstr("expected")));
  expect_refused({dancer_, "--out", folder_ / "no" / "steps.json"}, HasSubstr("expected an existing folder"));
  expect_refused({dancer_, "--out", folder_}, HasSubstr("--out: found"));
  expect_refused({dancer_, "--out", clip(), "--joint", "Tail"}, HasSubstr("--joint: found Tail"));
  expect_refused({dancer_, "--out", clip(), "--limits", file("l.json", R"({"limits": [{"joint": "Tail"}]})")},
                 HasSubstr("l.json: /limits/0"));
}

TEST_F(PoseProgram, AnAutosaveOfAnotherCharacterIsPutAsideAndSaid) {
  const std::string text = R"({"keys": [{"time": 0, "joints": {"Tail": {}}}]})";
  file("steps.autosave.json", text);
  const test::Outcome outcome = test::run_program({"pose", dancer_, "--out", clip()}, "unset DISPLAY WAYLAND_DISPLAY;");
  EXPECT_THAT(outcome.output, HasSubstr("steps.autosave.json: key 0, joint Tail"));
  EXPECT_EQ(read_file(folder_ / "steps.autosave.damaged-1.json"), text) << "nothing of it is lost";
}

TEST_F(PoseProgram, WithoutADisplaySaysSo) { expect_refused({dancer_, "--out", clip()}, HasSubstr("no display")); }

TEST_F(PoseProgram, DrawsItsWindowAsAPicture) {
  const test::Outcome outcome =
      test::run_program({"pose", dancer_, "--out", clip(), "--motion", test::source_file("assets/poses/dance.json"),
                         "--time", "3.3", "--joint", "LeftForeArm", "--width", "320", "--height", "240", "--screenshot",
                         folder_ / "pose.png", "--json", folder_ / "state.json"},
                        "unset DISPLAY WAYLAND_DISPLAY;");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(read_file(folder_ / "pose.png"), ::testing::StartsWith("\x89PNG"));
  const json state = json::parse(read_file(folder_ / "state.json"));
  EXPECT_NEAR(state["time"].get<double>(), 3.3, 1e-12);
  EXPECT_EQ(state["selected"], dancer().names[*dancer().find("LeftForeArm")]);
  EXPECT_FALSE(std::filesystem::exists(clip())); // a picture changes nothing
}

} // namespace
} // namespace tutu::app
