// What a session does when a frame does not go as asked.
#include "cloth/state/tolerances.h"
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/run/drape.h"
#include "src/run/session.h"
#include "src/scene/load.h"
#include "tests/support/paths.h"

#include <chrono>
#include <gmock/gmock.h>
#include <thread>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

const LoadedScene& dance() {
  static const LoadedScene scene = load_scene(read_scene(source_file("assets/scenes/dance.json")));
  return scene;
}

GarmentPositions rest_of(const LoadedScene& scene) {
  GarmentPositions positions;
  for (const cloth::Garment& garment : scene.garments) positions.push_back(garment.rest_positions);
  return positions;
}

double fastest_of(const Session& session) {
  double fastest = 0.0;
  for (std::size_t g = 0; g < session.scene().garments.size(); ++g)
    for (const Vec3& v : session.garment(static_cast<int>(g)).particles().velocities)
      fastest = std::max(fastest, v.norm());
  return fastest;
}

/// The dance's first pose, moved.
std::vector<Transform> pose_moved(const LoadedScene& scene, const Vec3& by) {
  const auto first = rig::first_pose(scene.motion);
  std::vector<Transform> local(first.begin(), first.end());
  local[0].translation += by;
  return local;
}

TEST(RunTroubles, ACutInTheClipIsAJumpAndNotAVelocity) {
  const LoadedScene& scene = dance();
  Session session(scene);
  session.start(rest_of(scene));
  for (int frame = 0; frame < 3; ++frame) session.advance_to(pose_moved(scene, Vec3::Zero()), 0.0);
  EXPECT_EQ(session.troubles().teleports, 0);
  const std::vector<Vec3> before = session.garment(0).particles().positions;
  session.advance_to(pose_moved(scene, Vec3(5, 0, 0)), 0.0);
  EXPECT_EQ(session.troubles().teleports, 1);
  ASSERT_FALSE(session.failure().has_value());
  EXPECT_LT(fastest_of(session), 3.0);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((session.garment(0).particles().positions[i] - before[i] - Vec3(5, 0, 0)).norm(), 0.05) << i;
  session.advance_to(pose_moved(scene, Vec3(5, 0, 0)), 0.0);
  EXPECT_EQ(session.troubles().teleports, 1) << "the frame after the jump is a frame like any other";
  EXPECT_EQ(session.troubles().recoveries, 0);
}

TEST(RunTroubles, AFastLimbSplitsTheFrameAndSaysWhich) {
  LoadedScene scene = dance();
  scene.settings.substeps = 2;
  std::uint64_t hashes[2] = {};
  for (const bool adaptive : {true, false}) {
    scene.settings.adaptive_substeps = adaptive;
    Session session(scene);
    session.start(rest_of(scene));
    session.advance_to(pose_moved(scene, Vec3::Zero()), 0.0);
    session.advance_to(pose_moved(scene, Vec3(0.3, 0, 0)), 0.0); // 18 m/s
    ASSERT_FALSE(session.failure().has_value());
    const RunTroubles& troubles = session.troubles();
    if (adaptive) {
      EXPECT_GE(troubles.frames_split, 1);
      EXPECT_GT(troubles.worst_split.substeps, 2);
      EXPECT_THAT(session.worst_split_reason(), ::testing::HasSubstr(" moves 0.3"));
    } else {
      EXPECT_EQ(troubles.frames_split, 0);
    }
    hashes[adaptive] = session.state_hash();
  }
  EXPECT_NE(hashes[0], hashes[1]);
}

/// Whether the text has all of these, one behind the other.
bool are_in_order(const std::string& text, const std::vector<std::string>& parts) {
  std::size_t at = 0;
  for (const std::string& part : parts) {
    at = text.find(part, at);
    if (at == std::string::npos) return false;
    at += part.size();
  }
  return true;
}

TEST(RunTroubles, AFailureSaysWhatWasFoundWhereAndWhy) {
  LoadedScene scene = dance();
  scene.settings.adaptive_substeps = false;
  scene.settings.substeps = 2;
  Session session(scene);
  session.start(rest_of(scene));
  session.advance_to(pose_moved(scene, Vec3::Zero()), 0.0);
  // Joints that stay where they are, and turn the skin that garments hang on: no jump, and no motion either.
  std::vector<Transform> turned = pose_moved(scene, Vec3::Zero());
  for (Transform& local : turned) local.rotation = Quat(Eigen::AngleAxisd(3.0, Vec3::UnitY())) * local.rotation;
  for (int f = 0; f < 40 && !session.failure(); ++f)
    session.advance_to(f % 2 == 0 ? turned : pose_moved(scene, Vec3::Zero()), 0.0);
  std::vector<std::string> told;
  for (const RunRecovery& recovery : session.troubles().first_recoveries) {
    told.push_back(recovery.message());
    EXPECT_TRUE(are_in_order(told.back(), {recovery.garment, " recovered in frame ", " (t = ", " s, substep ", " of ",
                                           "): ", " at (", "; taken again"}))
        << told.back();
  }
  if (session.failure()) {
    told.push_back(session.failure()->message());
    EXPECT_TRUE(are_in_order(
        told.back(), {session.failure()->garment, " diverged in frame ", " (t = ", ", substep ", "): ", " at ("}))
        << told.back();
  }
  ASSERT_FALSE(told.empty()) << "else this shows nothing";
  for (const std::string& message : told) {
    EXPECT_THAT(message, ::testing::Not(::testing::HasSubstr("nan"))) << message;
    if (message.find("times its rest length") == std::string::npos) continue;
    const std::size_t at = message.find(" m long, ");
    ASSERT_NE(at, std::string::npos) << message;
    EXPECT_GE(std::stod(message.substr(at + 9)), 1.0 + cloth::k_diverged_stretch - 1e-3) << message;
  }
}

TEST(RunTroubles, AFrameThatIsStoppedIsNeitherTakenNorAFailure) {
  LoadedScene scene = dance();
  scene.settings.substeps = 200000;
  Session session(scene);
  session.start(rest_of(scene));
  const std::uint64_t before = session.state_hash();
  std::atomic<bool> stop = false;
  session.stop_when(&stop);
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop = true;
  });
  const auto begin = std::chrono::steady_clock::now();
  session.advance();
  other.join();
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 1.0);
  EXPECT_TRUE(session.stopped());
  EXPECT_FALSE(session.failure().has_value());
  EXPECT_EQ(session.troubles().recoveries, 0);
  EXPECT_EQ(session.frame(), 0);
  EXPECT_EQ(session.state_hash(), before) << "garments are as at its start";
  session.advance();
  EXPECT_EQ(session.frame(), 0) << "nothing goes on by itself";
  stop = false;
  scene.settings.substeps = 2;
  session.start(rest_of(scene));
  session.advance();
  EXPECT_FALSE(session.stopped());
  EXPECT_EQ(session.frame(), 1);
}

TEST(RunTroubles, ADrapeStopsWithinAFrame) {
  LoadedScene scene = dance();
  scene.settings.substeps = 200000;
  const std::atomic<bool> stop = true;
  int frames = 0;
  const auto count = [&](int, int) { return ++frames > 0; };
  const DrapeResult result = drape(scene, 1.0, count, &stop);
  EXPECT_EQ(frames, 0);
  EXPECT_EQ(result.seconds, 0.0);
  EXPECT_FALSE(result.failure.has_value());
  EXPECT_EQ(result.positions.size(), scene.garments.size());
}

TEST(RunTroubles, StartForgetsThem) {
  LoadedScene scene = dance();
  scene.settings.substeps = 1;
  Session session(scene);
  session.start(rest_of(scene));
  session.advance_to(pose_moved(scene, Vec3(5, 0, 0)), 0.0);
  EXPECT_EQ(session.troubles().teleports, 1);
  session.start(rest_of(scene));
  EXPECT_EQ(session.troubles().teleports, 0);
  EXPECT_TRUE(session.troubles().first_recoveries.empty());
}

TEST(SceneFile, AdaptiveSubstepsAreOnUnlessTurnedOff) {
  const auto folder = scratch_folder();
  for (const char* name : {"a.dae", "m.json"}) write_file(folder / name, "");
  const auto read = [&](const std::string& solver) {
    write_file(folder / "s.json", R"({"character": "a.dae", "motion": "m.json", "solver": )" + solver + "}");
    return read_scene(folder / "s.json");
  };
  EXPECT_TRUE(read("{}").settings.adaptive_substeps);
  EXPECT_FALSE(read(R"({"adaptive_substeps": false})").settings.adaptive_substeps);
  EXPECT_THROW(read(R"({"adaptive_substeps": 3})"), InputError);
  std::filesystem::remove_all(folder);
}

} // namespace
