// The history of the pose editor, its keys, the mirror and its files. No window.
#include "rig/error.h"
#include "rig/io/clip_file.h"
#include "rig/io/file_io.h"
#include "rig/mannequin/mannequin.h"
#include "src/view/pose/edit_document.h"
#include "src/view/pose/mirror.h"
#include "src/view/pose/pose_files.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>
#include <random>

namespace tutu::app {
namespace {

const rig::Skeleton& dancer() {
  static const rig::Skeleton k_skeleton = rig::make_mannequin().skeleton;
  return k_skeleton;
}

Quat random_turn(std::mt19937& random, double most) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> angle(-most, most);
  const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
  return Quat(Eigen::AngleAxisd(angle(random), axis));
}

Pose random_pose(std::mt19937& random) {
  Pose pose = dancer().rest_local;
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  for (Transform& joint : pose) joint.rotation = (random_turn(random, 2.0) * joint.rotation).normalized();
  pose[0].translation += Vec3(shift(random), shift(random), shift(random));
  return pose;
}

bool same_state(const EditState& a, const EditState& b) {
  return same_clip(a, b) && same_pose(a.pose, b.pose) && a.loose == b.loose && a.time == b.time &&
         a.pins.size() == b.pins.size();
}

double largest_difference(std::span<const Transform> a, std::span<const Transform> b) {
  double worst = 0.0;
  for (std::size_t j = 0; j < a.size(); ++j)
    worst = std::max({worst, (a[j].rotation.coeffs() - b[j].rotation.coeffs()).cwiseAbs().maxCoeff(),
                      (a[j].translation - b[j].translation).cwiseAbs().maxCoeff()});
  return worst;
}

/// One edit of any kind.
EditState random_edit(const EditState& state, std::mt19937& random) {
  EditState next = state;
  const int key = state.keys.empty() ? -1 : static_cast<int>(random() % state.keys.size());
  std::uniform_real_distribution<double> time(-1.0, 12.0);
  switch (random() % 8) {
  case 0: add_next_key(next, 0.5); break;
  case 1: set_key_here(next); break;
  case 2:
    if (key >= 0) delete_key(next, key);
    break;
  case 3:
    if (key >= 0) duplicate_key(next, key, 0.5);
    break;
  case 4:
    if (key >= 0) move_key(next, key, time(random));
    break;
  case 5:
    if (key >= 0) retime_from(next, key, time(random));
    break;
  case 6: seek(next, dancer(), time(random)); break;
  default: next.pose = random_pose(random); next.loose = true;
  }
  return next;
}

void expect_rising(const EditState& state) {
  for (std::size_t k = 1; k < state.keys.size(); ++k) ASSERT_LT(state.keys[k - 1].time, state.keys[k].time);
}

TEST(PoseDocument, UndoAndRedoVisitTheSameStatesWhateverWasEdited) {
  std::mt19937 random(7);
  EditDocument document(edit_state_at_rest(dancer(), "test"));
  std::vector<EditState> told = {document.state()}; // what the history should be
  std::size_t at = 0;
  int undone = 0, redone = 0, edited = 0;
  for (int step = 0; step < 3000; ++step) {
    const auto kind = random() % 10;
    if (kind < 3) {
      ASSERT_EQ(document.undo(), at > 0);
      if (at > 0) --at, ++undone;
    } else if (kind < 5) {
      ASSERT_EQ(document.redo(), at + 1 < told.size());
      if (at + 1 < told.size()) ++at, ++redone;
    } else {
      const EditState next = random_edit(document.state(), random);
      if (kind == 5) { // a gesture that is let go leaves nothing
        document.show(next);
        document.drop();
      } else {
        if (kind == 6) {
          document.show(random_edit(document.state(), random));
          document.show(next);
          document.keep();
        } else {
          document.change(next);
        }
        told.resize(at + 1);
        told.push_back(next);
        ++at;
        ++edited;
      }
    }
    ASSERT_TRUE(same_state(document.state(), told[at])) << "step " << step;
    ASSERT_EQ(document.undo_depth(), at);
    ASSERT_EQ(document.redo_depth(), told.size() - 1 - at);
    expect_rising(document.state());
  }
  EXPECT_GT(undone, 300);
  EXPECT_GT(redone, 100);
  EXPECT_GT(edited, 1000);
  while (document.undo()) {
  }
  EXPECT_TRUE(same_state(document.state(), told[0]));
}

TEST(PoseDocument, DirtyIsWhatTheFilesDoNotHold) {
  std::mt19937 random(3);
  EditDocument document(edit_state_at_rest(dancer(), "test"));
  EXPECT_FALSE(document.dirty());
  EditState next = document.state();
  next.pose = random_pose(random);
  next.loose = true;
  document.change(next);
  EXPECT_TRUE(document.dirty());
  document.undo();
  EXPECT_FALSE(document.dirty());
  document.redo();
  next = document.state();
  add_next_key(next, 0.5);
  document.change(next);
  document.mark_written();
  EXPECT_FALSE(document.dirty());
  document.undo(); // before the key that the files hold
  EXPECT_TRUE(document.dirty());
  document.redo();
  EXPECT_FALSE(document.dirty());
  next = document.state();
  seek(next, dancer(), 0.0);
  document.change(next); // looking elsewhere is no work
  EXPECT_FALSE(document.dirty());
}

TEST(PoseKeys, TheNextKeyGoesBehindTheLastAndBeforeAClosingOne) {
  std::mt19937 random(11);
  EditState state = edit_state_at_rest(dancer(), "test");
  const Pose first = state.pose;
  add_next_key(state, 0.5);
  const Pose second = state.pose = random_pose(random);
  state.loose = true;
  add_next_key(state, 0.5);
  EXPECT_FALSE(state.loose);
  EXPECT_FALSE(is_closed(state));
  close_loop(state, 0.5);
  ASSERT_EQ(state.keys.size(), 3U);
  EXPECT_TRUE(is_closed(state));
  close_loop(state, 0.5); // it is
  ASSERT_EQ(state.keys.size(), 3U);

  const Pose third = state.pose = random_pose(random);
  add_next_key(state, 0.5);
  ASSERT_EQ(state.keys.size(), 4U);
  EXPECT_TRUE(is_closed(state));
  const std::vector<const Pose*> wanted = {&first, &second, &third, &first};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_DOUBLE_EQ(state.keys[k].time, 0.5 * static_cast<double>(k));
    EXPECT_TRUE(same_pose(*state.keys[k].pose, *wanted[k])) << k;
  }
  EXPECT_DOUBLE_EQ(state.time, 1.0);

  EditState open = state;
  open.extrapolation = rig::Extrapolation::clamp;
  EXPECT_FALSE(is_closed(open)); // what clamps is no loop
  open.keys.pop_back();
  close_loop(open, 0.5);
  EXPECT_EQ(open.keys.size(), 3U);
}

TEST(PoseKeys, AreMovedRetimedDuplicatedAndDeleted) {
  EditState state = edit_state_at_rest(dancer(), "test");
  for (int k = 0; k < 4; ++k) {
    state.pose[0].translation.x() = k; // to tell them apart
    add_next_key(state, 1.0);
  }
  const auto marks = [&] {
    std::vector<double> x;
    for (const EditKey& key : state.keys) x.push_back((*key.pose)[0].translation.x());
    return x;
  };
  const auto times = [&] {
    std::vector<double> t;
    for (const EditKey& key : state.keys) t.push_back(key.time);
    return t;
  };
  EXPECT_EQ(move_key(state, 1, 2.5), 2); // past another
  EXPECT_THAT(marks(), ::testing::ElementsAre(0, 2, 1, 3));
  EXPECT_THAT(times(), ::testing::ElementsAre(0, 2, 2.5, 3));
  EXPECT_EQ(move_key(state, 2, 3.0), 2); // there is one
  EXPECT_NEAR(state.keys[2].time, 2.999, 1e-12);
  retime_from(state, 1, 1.0);
  EXPECT_THAT(marks(), ::testing::ElementsAre(0, 2, 1, 3));
  EXPECT_NEAR(state.keys[1].time, 1.0, 1e-12);
  EXPECT_NEAR(state.keys[3].time, 2.0, 1e-12);
  retime_from(state, 1, -5.0); // not before the one before it
  EXPECT_NEAR(state.keys[1].time, 0.001, 1e-12);
  duplicate_key(state, 0, 1.0); // where there is no room half way: beside them
  EXPECT_EQ(state.keys.size(), 5U);
  expect_rising(state);
  EXPECT_EQ(duplicate_key(state, 4, 0.25), 5);
  EXPECT_NEAR(state.keys[5].time, state.keys[4].time + 0.25, 1e-12);
  delete_key(state, 5);
  EXPECT_EQ(state.keys.size(), 5U);
}

TEST(PoseKeys, ScrubbingShowsWhatPlayingWouldAndKeysToTheBit) {
  const rig::RawClip raw = rig::read_clip(test::source_file("assets/poses/dance.json"));
  const rig::Clip clip = rig::build_clip(raw, dancer());
  EditState state = edit_state(raw, dancer());
  Pose expected(state.pose.size());
  for (double t = 0.013; t < clip.duration(); t += 0.31) {
    seek(state, dancer(), t);
    rig::sample(clip, t, expected);
    EXPECT_TRUE(same_pose(state.pose, expected)) << t;
  }
  seek(state, dancer(), raw.keys[3].time);
  EXPECT_TRUE(same_pose(state.pose, *state.keys[3].pose));
  seek(state, dancer(), 1e6);
  EXPECT_DOUBLE_EQ(state.time, raw.keys.back().time);
}

TEST(PoseMirror, TwiceIsTheSamePose) {
  std::mt19937 random(5);
  for (int n = 0; n < 50; ++n) {
    const Pose pose = random_pose(random);
    EXPECT_LT(largest_difference(mirrored(dancer(), mirrored(dancer(), pose)), pose), 1e-12);
  }
  EXPECT_TRUE(same_pose(mirrored(dancer(), dancer().rest_local), dancer().rest_local));
}

TEST(PoseMirror, PutsEveryJointWhereItsCounterpartIsInTheMirror) {
  std::mt19937 random(6);
  const std::vector<int> other = other_sides(dancer());
  const Pose pose = random_pose(random), seen = mirrored(dancer(), pose);
  int sided = 0;
  for (int j = 0; j < dancer().joint_count(); ++j) {
    Vec3 wanted = rig::model_of_joint(dancer(), pose, other[j]).translation;
    wanted.x() = -wanted.x();
    EXPECT_LT((rig::model_of_joint(dancer(), seen, j).translation - wanted).norm(), 1e-12) << dancer().names[j];
    sided += other[j] != j;
  }
  EXPECT_EQ(sided, 46);

  const Pose across = copied_across(dancer(), pose, rig::Side::left);
  for (int j = 0; j < dancer().joint_count(); ++j) {
    const bool right = rig::side_of(dancer().names[j]) == rig::Side::right;
    EXPECT_EQ(across[j].rotation.coeffs(), (right ? seen : pose)[j].rotation.coeffs()) << dancer().names[j];
  }
}

class PoseFiles : public ::testing::Test {
protected:
  void SetUp() override { folder_ = test::scratch_folder(); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(PoseFiles, ClipAndTextsComeBackToTheBit) {
  std::mt19937 random(9);
  EditState state = edit_state_at_rest(dancer(), "steps");
  state.interpolation = rig::Interpolation::cubic;
  for (int k = 0; k < 4; ++k) {
    if (k > 0) state.pose = random_pose(random);
    add_next_key(state, 0.37);
  }
  state.keys[1].name = "leap";
  close_loop(state, 0.4);
  const std::filesystem::path file = folder_ / "steps.json";
  write_pose_files(state, dancer(), file);
  EXPECT_TRUE(same_clip(edit_state(rig::read_clip(file), dancer()), state));

  const auto texts = three_text_paths(file);
  EXPECT_EQ(texts[1], folder_ / "steps.rotations.txt");
  std::vector<std::string> notes;
  EditState read =
      edit_state(rig::read_three_texts({texts[0], texts[1], texts[2], std::nullopt}, dancer(), &notes), dancer());
  EXPECT_TRUE(notes.empty());
  read.name = state.name; // texts hold no names, nor how it is interpolated
  read.keys[1].name = "leap";
  read.interpolation = state.interpolation;
  EXPECT_TRUE(same_clip(read, state));
  EXPECT_TRUE(is_closed(read));
}

TEST_F(PoseFiles, AJumpThatCannotBeIsNotWritten) {
  EditState state = edit_state_at_rest(dancer(), "jump");
  add_next_key(state, 0.5);
  state.keys[0].airborne = true; // it begins in the air
  EXPECT_THROW(write_pose_files(state, dancer(), folder_ / "jump.json"), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(PoseFiles, TheAutosaveHoldsKeysAndThePoseInHand) {
  std::string trouble;
  std::mt19937 random(13);
  const Autosave autosave(folder_ / "steps.json");
  EXPECT_EQ(autosave.file(), folder_ / "steps.autosave.json");
  EXPECT_FALSE(autosave.found(dancer(), trouble));
  EditDocument document(edit_state_at_rest(dancer(), "steps"));
  autosave.update(document, dancer());
  EXPECT_FALSE(autosave.found(dancer(), trouble)); // nothing to lose

  EditState next = document.state();
  next.pose = random_pose(random);
  add_next_key(next, 0.5);
  document.change(next);
  autosave.update(document, dancer());
  auto found = autosave.found(dancer(), trouble);
  ASSERT_TRUE(found);
  EXPECT_TRUE(same_clip(*found, document.state()));
  EXPECT_FALSE(found->loose);

  next.pose = random_pose(random);
  next.loose = true;
  document.change(next);
  autosave.update(document, dancer());
  found = autosave.found(dancer(), trouble);
  ASSERT_TRUE(found);
  EXPECT_TRUE(same_clip(*found, document.state()));
  EXPECT_TRUE(found->loose);
  EXPECT_TRUE(same_pose(found->pose, document.state().pose));

  document.undo();
  document.undo();
  autosave.update(document, dancer());
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(PoseFiles, ADamagedAutosaveIsPutAsideAndSaid) {
  const Autosave autosave(folder_ / "steps.json");
  for (const char* damaged : {"", "{", "[]", R"({"keys": [{"time": 0, "joints": {"Nobody": {}}}]})"}) {
    write_file(autosave.file(), damaged);
    std::string trouble;
    EXPECT_FALSE(autosave.found(dancer(), trouble)) << damaged;
    EXPECT_NE(trouble.find("put aside as "), trouble.npos) << trouble;
    EXPECT_FALSE(std::filesystem::exists(autosave.file()));
    EXPECT_EQ(read_file(trouble.substr(trouble.find("put aside as ") + 13)), damaged) << "nothing is lost";
  }
}

} // namespace
} // namespace tutu::app
