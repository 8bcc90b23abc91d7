// The pose editor without its window: pointer, keys and menus against closed forms.
#include "rig/drag.h"
#include "rig/error.h"
#include "rig/import/import.h"
#include "rig/io/clip_file.h"
#include "rig/io/file_io.h"
#include "rig/mannequin/mannequin.h"
#include "src/view/pose/editor.h"
#include "src/view/pose/joint_limits_file.h"
#include "tests/support/paths.h"

#include <cmath>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

namespace tutu::app {
namespace {

using enum EditorCommand;

const rig::Character& dancer() {
  static const rig::Character k_dancer = [] {
    const rig::Mannequin mannequin = rig::make_mannequin();
    return rig::Character{"dancer", mannequin.skeleton, mannequin.surface, mannequin.surface_skin};
  }();
  return k_dancer;
}

class PoseEditor : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = test::scratch_folder();
    open();
  }
  void TearDown() override {
    editor_.reset();
    std::filesystem::remove_all(folder_);
  }
  void open(std::vector<rig::JointLimit> limits = {}) {
    EditState start = edit_state_at_rest(character_.skeleton, "test");
    editor_.emplace(character_, std::move(start), folder_ / "test.json", std::move(limits));
    editor_->resize(640, 480, 1.0f);
  }

  int joint(const std::string& name) const { return *character_.skeleton.find(name); }
  Vec3 place(const std::string& name) const {
    return rig::model_of_joint(character_.skeleton, editor_->state().pose, joint(name)).translation;
  }
  Eigen::Vector2d pixel_of(const Vec3& point) const {
    const Picture& picture = editor_->picture();
    return project(picture.camera, picture.width, picture.height, point.cast<float>())->cast<double>();
  }
  Eigen::Vector2d pixel(const std::string& name) const { return pixel_of(place(name)); }
  void hold(const Eigen::Vector2d& from) {
    editor_->point(from.x(), from.y(), true);
    editor_->press(PointerButton::left);
  }
  void drag(const std::string& name, const Eigen::Vector2d& by) {
    const Eigen::Vector2d from = pixel(name);
    hold(from);
    editor_->point(from.x() + by.x(), from.y() + by.y(), true);
    editor_->release();
  }
  Pose pose() const { return editor_->state().pose; }

  const rig::Character& character_ = dancer();
  std::filesystem::path folder_;
  std::optional<Editor> editor_;
};

TEST_F(PoseEditor, TheRayGoesThroughThePixelThatShowsAPoint) {
  for (const char* name : {"LeftHand", "Head", "RightToeBase"}) {
    const Eigen::Vector2d at = pixel(name);
    const Ray ray = ray_through(editor_->picture(), at.x(), at.y());
    EXPECT_LT((place(name) - ray.origin).cross(ray.direction).norm(), 1e-5) << name; // pixels are in floats here
  }
}

TEST_F(PoseEditor, ShiftMarksTheJointUnderThePointer) {
  for (const char* name : {"LeftHand", "RightFoot", "Head", "Hips"}) {
    const Eigen::Vector2d at = pixel(name);
    editor_->point(at.x() + 1, at.y(), false);
    EXPECT_FALSE(editor_->hovered()) << name;
    editor_->point(at.x() + 1, at.y(), true);
    ASSERT_TRUE(editor_->hovered()) << name;
    EXPECT_LE((pixel(character_.skeleton.names[*editor_->hovered()]) - at).norm(), 2.0) << name;
  }
  editor_->point(3, 3, true);
  EXPECT_FALSE(editor_->hovered());
}

TEST_F(PoseEditor, ADraggedJointStaysUnderThePointerOnItsBonesSphere) {
  const double bone = (place("LeftHand") - place("LeftForeArm")).norm();
  const Pose before = pose();
  const Eigen::Vector2d from = pixel("LeftHand");
  hold(from);
  double worst = 0.0;
  for (int i = 1; i <= 20; ++i) {
    editor_->point(from.x() - i, from.y() - 0.7 * i, true);
    EXPECT_NEAR((place("LeftHand") - place("LeftForeArm")).norm(), bone, 1e-12);
    worst = std::max(worst, (pixel("LeftHand") - Eigen::Vector2d(from.x() - i, from.y() - 0.7 * i)).norm());
  }
  EXPECT_LT(worst, 1e-3);                         // px; project() works in floats
  editor_->point(from.x() + 400, from.y(), true); // far beyond the sphere: its outline
  EXPECT_NEAR((place("LeftHand") - place("LeftForeArm")).norm(), bone, 1e-12);
  editor_->point(from.x() - 5, from.y() - 3, true);

  // The closed form: the rule of rig/drag.h, to where the ray meets the sphere.
  const Ray ray = ray_through(editor_->picture(), from.x() - 5, from.y() - 3);
  const Vec3 centre = place("LeftForeArm");
  const double along = (centre - ray.origin).dot(ray.direction);
  const Vec3 middle = ray.origin + along * ray.direction;
  const double half = std::sqrt(bone * bone - (middle - centre).squaredNorm());
  const Vec3 start = rig::model_of_joint(character_.skeleton, before, joint("LeftHand")).translation;
  Vec3 target = middle - half * ray.direction;
  if ((middle + half * ray.direction - start).norm() < (target - start).norm()) target = middle + half * ray.direction;
  Pose expected = before;
  rig::drag_joint(character_.skeleton, expected, joint("LeftHand"), target);
  for (std::size_t j = 0; j < expected.size(); ++j)
    EXPECT_LT((expected[j].rotation.coeffs() - pose()[j].rotation.coeffs()).norm(), 1e-9) << j;
  editor_->release();
  EXPECT_EQ(editor_->document().undo_depth(), 1U); // however many moves it had
  EXPECT_TRUE(editor_->state().loose);
  editor_->run(undo);
  EXPECT_TRUE(same_pose(pose(), before));
}

TEST_F(PoseEditor, APointerThatComesBackBringsThePoseBackToTheBit) {
  const Pose before = pose();
  const Eigen::Vector2d from = pixel("LeftHand");
  const auto pass = [&] {
    hold(from);
    editor_->point(from.x() + 9, from.y() + 4, true);
    const Pose there = pose();
    for (const double way : {30.0, -20.0, 12.0}) editor_->point(from.x() + way, from.y() - way, true);
    editor_->point(from.x() + 9, from.y() + 4, true);
    EXPECT_TRUE(same_pose(pose(), there));
    editor_->release();
    editor_->run(undo);
    EXPECT_TRUE(same_pose(pose(), before));
  };
  pass();
  editor_->run(toggle_ik);
  pass();
}

TEST_F(PoseEditor, TheRootMovesInThePlaneThatFacesTheCamera) {
  const Vec3 before = place("Hips");
  drag("Hips", {40, -25});
  const Vec3 way = place("Hips") - before;
  const Camera& camera = editor_->picture().camera;
  EXPECT_GT(way.norm(), 0.05);
  EXPECT_NEAR(way.dot((camera.target - camera.eye).cast<double>().normalized()), 0.0, 1e-9);
  EXPECT_EQ(pose()[0].rotation.coeffs(), character_.skeleton.rest_local[0].rotation.coeffs());
}

TEST_F(PoseEditor, OneChildOnlyLeavesParentAndSiblingsTheirBits) {
  editor_->run(toggle_one_child);
  const Pose before = pose();
  drag("LeftUpLeg", {8, 6});
  const Pose after = pose();
  for (int j = 0; j < character_.skeleton.joint_count(); ++j) {
    const bool same =
        before[j].rotation.coeffs() == after[j].rotation.coeffs() && before[j].translation == after[j].translation;
    EXPECT_EQ(same, j != joint("LeftUpLeg")) << character_.skeleton.names[j];
  }
  // Without it the pelvis turns, and with it all that hangs there.
  editor_->run(undo);
  editor_->run(toggle_one_child);
  drag("LeftUpLeg", {8, 6});
  EXPECT_NE(pose()[0].rotation.coeffs(), before[0].rotation.coeffs());
  EXPECT_EQ(pose()[joint("LeftUpLeg")].rotation.coeffs(), before[joint("LeftUpLeg")].rotation.coeffs());
}

TEST_F(PoseEditor, InverseKinematicsPutsHandsAndFeetUnderThePointer) {
  editor_->run(toggle_ik);
  for (const char* name : {"LeftHand", "RightHand", "LeftFoot", "RightFoot"}) {
    const Eigen::Vector2d to = pixel(name) + Eigen::Vector2d(name[0] == 'L' ? -15 : 15, -30);
    drag(name, to - pixel(name));
    EXPECT_LT((pixel(name) - to).norm(), 1e-3) << name;
    EXPECT_LT((place(name) - ray_through(editor_->picture(), to.x(), to.y()).origin)
                  .cross(ray_through(editor_->picture(), to.x(), to.y()).direction)
                  .norm(),
              1e-9)
        << name;
  }
  // A straight knee goes forwards.
  EXPECT_GT(place("LeftLeg").z(), 0.5 * (place("LeftUpLeg").z() + place("LeftFoot").z()));
  const Eigen::Vector2d to = pixel("Head") + Eigen::Vector2d(10, 8);
  drag("Head", {10, 8});
  EXPECT_LT((pixel("Head") - to).norm(), 0.05);
}

TEST_F(PoseEditor, AKneeDraggedByInverseKinematicsLeavesTheFoot) {
  editor_->run(toggle_ik);
  drag("LeftFoot", {10, -40});
  const Vec3 foot = place("LeftFoot"), knee = place("LeftLeg");
  drag("LeftLeg", {25, 0});
  EXPECT_LT((place("LeftFoot") - foot).norm(), 1e-9);
  EXPECT_GT((place("LeftLeg") - knee).norm(), 0.02);
}

TEST_F(PoseEditor, APinnedFootStaysWhileTheBodyMoves) {
  editor_->select(joint("LeftFoot"));
  editor_->run(toggle_pin);
  EXPECT_TRUE(editor_->is_on(toggle_pin));
  const Vec3 foot = place("LeftFoot"), other = place("RightFoot");
  drag("Hips", {0, 20});
  EXPECT_LT((place("LeftFoot") - foot).norm(), 1e-9);
  EXPECT_GT((place("RightFoot") - other).norm(), 0.05);
  // Dragged itself it slides on its own height.
  drag("LeftFoot", {12, 6});
  EXPECT_GT((place("LeftFoot") - foot).norm(), 0.02);
  EXPECT_NEAR(place("LeftFoot").y(), foot.y(), 1e-9);
  editor_->select(joint("LeftFoot"));
  editor_->run(toggle_pin);
  EXPECT_FALSE(editor_->is_on(toggle_pin));
  editor_->select(joint("Head"));
  editor_->run(toggle_pin);
  EXPECT_THAT(editor_->message(), ::testing::HasSubstr("foot"));
}

TEST_F(PoseEditor, TheRingTwistsAboutTheBone) {
  editor_->select(joint("LeftForeArm"));
  const Vec3 hand = place("LeftHand");
  const Ring ring = *ring_of(character_.skeleton, pose(), joint("LeftForeArm"));
  const auto at = [&](double angle) { return pixel_of(ring.at(angle)); };
  // Of the ring's points take one that no joint covers.
  double from = 0.0;
  const auto free = [&](double angle) {
    for (const Transform& model : editor_->model_from_joint())
      if ((pixel_of(model.translation) - at(angle)).norm() < 7) return false;
    return true;
  };
  while (!free(from)) from += 0.1;
  hold(at(from));
  EXPECT_TRUE(editor_->ring_hovered());
  const Eigen::Vector2d to = at(from + 0.5);
  editor_->point(to.x(), to.y(), true);
  editor_->release();
  EXPECT_LT((place("LeftHand") - hand).norm(), 1e-12);
  const Quat turn =
      character_.skeleton.rest_local[joint("LeftForeArm")].rotation.conjugate() * pose()[joint("LeftForeArm")].rotation;
  EXPECT_NEAR(2.0 * turn.vec().norm(), 2.0 * std::sin(0.25), 2e-4); // to the float of a pixel
  const double before = 2.0 * std::atan2(turn.vec().norm(), turn.w());
  editor_->run(twist_right);
  const Quat more =
      character_.skeleton.rest_local[joint("LeftForeArm")].rotation.conjugate() * pose()[joint("LeftForeArm")].rotation;
  EXPECT_NEAR(2.0 * std::atan2(more.vec().norm(), more.w()) - before, 5.0 * std::numbers::pi / 180.0, 1e-9);
}

TEST_F(PoseEditor, LimitsHold) {
  write_file(
      folder_ / "limits.json",
      R"({"limits": [{"joint": "LeftForeArm", "axis": [0, 1, 0], "swing_degrees": 10, "twist_degrees": [-5, 8]}]})");
  open(read_joint_limits(folder_ / "limits.json", character_.skeleton));
  const auto swing = [&] {
    const Quat turn = pose()[joint("LeftForeArm")].rotation; // at rest the identity
    return 2.0 * std::asin(std::min(1.0, std::hypot(turn.x(), turn.z())));
  };
  drag("LeftHand", {3, -3});
  EXPECT_GT(swing(), 0.01);
  drag("LeftHand", {-60, -60});
  EXPECT_NEAR(swing(), 10.0 * std::numbers::pi / 180.0, 0.02);
  editor_->run(rest_pose);
  editor_->run(toggle_ik);
  drag("LeftHand", {-40, -60});
  EXPECT_LT(swing(), 10.0 * std::numbers::pi / 180.0 + 1e-9);

  const auto refused = [&](const std::string& text) {
    write_file(folder_ / "bad.json", text);
    try {
      read_joint_limits(folder_ / "bad.json", character_.skeleton);
      return std::string("read");
    } catch (const InputError& error) {
      return error.place();
    }
  };
  EXPECT_EQ(refused(R"({"limits": [{"joint": "Tail", "axis": [0,1,0], "swing_degrees": 1, "twist_degrees": [0,0]}]})"),
            "/limits/0/joint");
  EXPECT_EQ(refused(R"({"limits": [{"joint": "Head", "axis": [0,0,0], "swing_degrees": 1, "twist_degrees": [0,0]}]})"),
            "/limits/0/axis");
  EXPECT_EQ(refused(R"({"limits": [{"joint": "Head", "axis": [0,1,0], "swing_degrees": 1, "twist_degrees": [5,1]}]})"),
            "/limits/0/twist_degrees");
}

TEST_F(PoseEditor, WithTheShippedLimitsKneesAndElbowsBendOneWay) {
  const std::vector<rig::JointLimit> limits =
      read_joint_limits(test::source_file("assets/limits/dancer.json"), character_.skeleton);
  ASSERT_EQ(limits.size(), 4U);
  open(limits);
  editor_->run(side_view); // forwards is to the left
  const auto lift = [&](const char* foot, double pixels) {
    drag(foot, {pixels, -20});
    const double ahead = place(foot).z() - place("LeftLeg").z();
    editor_->run(undo);
    return ahead;
  };
  const double at_rest = place("LeftFoot").z() - place("LeftLeg").z();
  const double back = lift("LeftFoot", 40), front = lift("LeftFoot", -40);
  EXPECT_LT(std::min(back, front), at_rest - 0.05);
  EXPECT_LT(std::max(back, front), at_rest + 0.01);
  // What elbows may do they do forwards.
  editor_->run(front_view);
  editor_->run(rest_pose);
  editor_->run(toggle_ik);
  for (const char* hand : {"LeftHand", "RightHand"}) {
    drag(hand, {hand[0] == 'L' ? -20 : 20, -40});
    EXPECT_GT(place(hand).z(), place(hand[0] == 'L' ? "LeftForeArm" : "RightForeArm").z()) << hand;
  }
}

TEST_F(PoseEditor, KeysAreSavedWrittenAndReadAgain) {
  editor_->run(save_key);
  drag("LeftHand", {5, -20});
  const Pose second = pose();
  editor_->run(save_key);
  EXPECT_TRUE(editor_->document().dirty());
  EXPECT_TRUE(std::filesystem::exists(editor_->autosave().file()));
  editor_->run(write_files);
  EXPECT_FALSE(editor_->document().dirty());
  EXPECT_FALSE(std::filesystem::exists(editor_->autosave().file()));
  const EditState read = edit_state(rig::read_clip(folder_ / "test.json"), character_.skeleton);
  EXPECT_TRUE(same_clip(read, editor_->state()));
  ASSERT_EQ(read.keys.size(), 3U);
  EXPECT_TRUE(is_closed(read));
  EXPECT_TRUE(same_pose(*read.keys[1].pose, second));
  editor_->scrub(0.25);
  editor_->keep();
  EXPECT_FALSE(editor_->document().dirty());
  EXPECT_FALSE(same_pose(pose(), second));
  editor_->run(EditorCommand::next_key);
  EXPECT_TRUE(same_pose(pose(), second));
}

TEST_F(PoseEditor, TheTimelineMovesNamesDuplicatesAndDeletesKeys) {
  for (int k = 0; k < 3; ++k) {
    drag("LeftHand", {2, -6});
    editor_->run(save_key);
  }
  const std::size_t depth = editor_->document().undo_depth();
  int key = 1; // 0, 0.5, 1 s
  for (const double time : {0.6, 0.9, 1.2}) key = editor_->show_key_moved(key, time, false);
  editor_->keep();
  EXPECT_EQ(key, 2);
  EXPECT_EQ(editor_->document().undo_depth(), depth + 1); // one drag, one step
  EXPECT_EQ(editor_->current_key(), 2);
  editor_->show_key_moved(1, 2.0, true); // and all later ones
  editor_->keep();
  EXPECT_NEAR(editor_->state().keys[2].time, 2.2, 1e-12);
  editor_->rename_key(1, "leap");
  editor_->run(toggle_airborne);
  EXPECT_TRUE(editor_->state().keys[1].airborne);
  editor_->run(EditorCommand::duplicate_key);
  ASSERT_EQ(editor_->state().keys.size(), 4U);
  EXPECT_NEAR(editor_->state().time, 2.1, 1e-12);
  EXPECT_EQ(editor_->state().keys[2].name, "leap");
  EXPECT_TRUE(same_pose(pose(), *editor_->state().keys[1].pose));
  editor_->run(EditorCommand::delete_key);
  EXPECT_EQ(editor_->state().keys.size(), 3U);
  editor_->run(EditorCommand::delete_key);
  EXPECT_THAT(editor_->message(), ::testing::HasSubstr("on no key"));
  drag("LeftHand", {2, -6});
  editor_->scrub(0.5);
  EXPECT_THAT(editor_->message(), ::testing::HasSubstr("Ctrl+Z"));
}

TEST_F(PoseEditor, CopiesMirrorsAndRests) {
  drag("LeftHand", {5, -20});
  const Pose dragged = pose();
  editor_->run(copy);
  editor_->run(mirror);
  EXPECT_EQ(pose()[joint("LeftForeArm")].rotation.coeffs(), Quat::Identity().coeffs());
  editor_->run(mirror);
  EXPECT_TRUE(pose()[joint("LeftForeArm")].rotation.isApprox(dragged[joint("LeftForeArm")].rotation, 1e-12));
  editor_->run(rest_pose);
  EXPECT_TRUE(same_pose(pose(), character_.skeleton.rest_local));
  editor_->run(paste);
  EXPECT_TRUE(same_pose(pose(), dragged));
}

TEST_F(PoseEditor, WorkLeftBehindIsOfferedAndTakenUpOrDropped) {
  editor_->run(save_key);
  drag("LeftHand", {5, -20});
  const Pose hand = pose();
  open(); // as after a crash: nobody closed the first
  EXPECT_EQ(editor_->question(), EditorQuestion::take_up_autosave);
  drag("LeftHand", {5, -20}); // not before the answer
  editor_->run(rest_pose);
  EXPECT_EQ(editor_->document().undo_depth(), 0U);
  editor_->answer(Answer::yes);
  EXPECT_TRUE(same_pose(pose(), hand));
  EXPECT_EQ(editor_->state().keys.size(), 1U);
  EXPECT_TRUE(editor_->document().dirty());
  EXPECT_TRUE(std::filesystem::exists(editor_->autosave().file()));
  open();
  editor_->answer(Answer::no);
  EXPECT_FALSE(std::filesystem::exists(editor_->autosave().file()));
  EXPECT_TRUE(editor_->state().keys.empty());
}

TEST_F(PoseEditor, LeavingWithUnsavedWorkAsks) {
  editor_->ask_to_leave();
  EXPECT_TRUE(editor_->done());
  open();
  drag("LeftHand", {5, -20});
  editor_->ask_to_leave();
  EXPECT_FALSE(editor_->done());
  EXPECT_EQ(editor_->question(), EditorQuestion::leave_unsaved);
  editor_->answer(Answer::cancel);
  EXPECT_FALSE(editor_->done());
  editor_->ask_to_leave();
  editor_->answer(Answer::yes);
  EXPECT_TRUE(editor_->done());
  EXPECT_EQ(rig::read_clip(folder_ / "test.json").keys.size(), 1U);
  EXPECT_FALSE(std::filesystem::exists(editor_->autosave().file()));
}

TEST_F(PoseEditor, WhatCannotBeWrittenStaysUnsaved) {
  editor_->run(save_key);
  editor_->run(toggle_airborne);
  editor_->run(write_files);
  EXPECT_THAT(editor_->message(), ::testing::HasSubstr("not written"));
  EXPECT_TRUE(editor_->document().dirty());
  EXPECT_TRUE(std::filesystem::exists(editor_->autosave().file()));
}

TEST_F(PoseEditor, TellsItsStateToMachines) {
  drag("LeftHand", {5, -20});
  const auto json = editor_->json();
  EXPECT_EQ(json["selected"], character_.skeleton.names[joint("LeftHand")]);
  EXPECT_EQ(json["undo_depth"], 1);
  EXPECT_EQ(json["dirty"], true);
  EXPECT_EQ(json["pose"].size(), character_.skeleton.names.size());
  EXPECT_DOUBLE_EQ(json["pose"][joint("LeftForeArm")]["rotation"][3].get<double>(),
                   pose()[joint("LeftForeArm")].rotation.w());
}

TEST(PoseLimbs, AreFoundOnOtherCharactersToo) {
  const auto file = test::assimp_model("X/BCN_Epileptic.X");
  if (!exists(file)) GTEST_SKIP() << "assimp-testmodels is not installed";
  for (const rig::Skeleton& skeleton : {rig::import_character(file).character.skeleton, dancer().skeleton}) {
    const std::vector<BodyLimb> limbs = find_limbs(skeleton);
    EXPECT_EQ(limbs.size(), 4U);
    EXPECT_EQ(std::count_if(limbs.begin(), limbs.end(), [](const BodyLimb& limb) { return limb.leg; }), 2);
    for (const BodyLimb& limb : limbs) {
      EXPECT_EQ(limb_ending_at(limbs, limb.limb.end)->limb.lower, limb.limb.lower);
      EXPECT_EQ(limb_bending_at(limbs, limb.limb.lower)->limb.end, limb.limb.end);
    }
  }
}

TEST(PoseCommands, EveryKeyIsThereOnceAndEveryCommandInAMenu) {
  std::set<std::string> keys;
  for (const CommandEntry& entry : command_table()) {
    EXPECT_TRUE(keys.insert(entry.keys).second) << entry.keys;
    EXPECT_NE(std::string(entry.menu), "");
    const std::string shown = entry.keys;
    const auto found = shown.size() > 1 ? command_of_key(shown) : command_of_character(shown[0]);
    ASSERT_TRUE(found) << shown;
    EXPECT_EQ(*found, entry.command) << shown;
    EXPECT_EQ(entry_of(entry.command).label, entry.label);
  }
  EXPECT_EQ(command_of_character(U's'), EditorCommand::save_key);
  EXPECT_FALSE(command_of_character(U'x'));
  EXPECT_FALSE(command_of_key("Ctrl+X"));
}

} // namespace
} // namespace tutu::app
