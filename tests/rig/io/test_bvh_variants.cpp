// BVH as others write it: what the format leaves open is read, and what is decided is told.
#include "rig/error.h"
#include "rig/io/bvh.h"
#include "rig/io/file_io.h"
#include "rig/mannequin/mannequin.h"
#include "tests/support/paths.h"

#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

/// An actor of 170 cm whose ankles are 10 cm above its soles, who stands, and after that lifts a leg.
struct Bone {
  const char *name, *parent;
  Vec3 offset;
  std::optional<Vec3> end;
};
const std::vector<Bone> k_actor = {{"Hips", "", {0, 0, 0}, {}},
                                   {"Spine", "Hips", {0, 25, 0}, {}},
                                   {"Head", "Spine", {0, 35, 0}, Vec3(0, 15, 0)},
                                   {"LeftArm", "Spine", {18, 20, 0}, Vec3(50, 0, 0)},
                                   {"RightArm", "Spine", {-18, 20, 0}, Vec3(-50, 0, 0)},
                                   {"LeftUpLeg", "Hips", {9, -5, 0}, {}},
                                   {"LeftLeg", "LeftUpLeg", {0, -40, 0}, {}},
                                   {"LeftFoot", "LeftLeg", {0, -40, 0}, Vec3(0, 0, 12)},
                                   {"RightUpLeg", "Hips", {-9, -5, 0}, {}},
                                   {"RightLeg", "RightUpLeg", {0, -40, 0}, {}},
                                   {"RightFoot", "RightLeg", {0, -40, 0}, Vec3(0, 0, 12)}};
constexpr int k_frames = 21;

/// How the take is written; the standard is the plain form.
struct Writing {
  std::function<Vec3(const Vec3&)> axes = [](const Vec3& v) { return v; };   ///< of the file, from +Y up
  std::function<Quat(int bone)> zero = [](int) { return Quat::Identity(); }; ///< model_from_joint where all is zero
  std::string root = "Hips", thigh = "LeftUpLeg";
  double floor = 0.0; ///< height
  bool named = true;
};

std::string number(double value) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.12f", value);
  return text.data();
}
std::string numbers(const Vec3& v) { return number(v.x()) + " " + number(v.y()) + " " + number(v.z()); }

/// The pose of frame k: model rotations as changes from the actor's own zero pose, and the root.
Quat turn_of(const std::string& bone, int k) {
  const bool kicks = bone == "LeftUpLeg" || bone == "LeftLeg" || bone == "LeftFoot";
  const double angle = kicks && k > 10 ? -(k - 10) * 0.1 : 0.0;
  return Quat(Eigen::AngleAxisd(angle, Vec3::UnitX()));
}

std::string take(const Writing& w = {}) {
  const Vec3 x = w.axes(Vec3::UnitX()), y = w.axes(Vec3::UnitY()), z = w.axes(Vec3::UnitZ());
  const Eigen::Matrix3d axes = (Eigen::Matrix3d() << x, y, z).finished();
  std::string text = "HIERARCHY\n", motion;
  std::vector<int> order;
  const auto name_of = [&](int b) {
    if (!w.named) return "joint" + std::to_string(b);
    const std::string name = k_actor[b].name;
    return name == "Hips" ? w.root : name == "LeftUpLeg" ? w.thigh : name;
  };
  const std::function<void(int, const std::string&)> write = [&](int b, const std::string& in) {
    const Bone& bone = k_actor[b];
    order.push_back(b);
    const auto parent = std::ranges::find(k_actor, std::string(bone.parent), &Bone::name);
    const int above = parent == k_actor.end() ? -1 : static_cast<int>(parent - k_actor.begin());
    const auto offset = [&](int joint, const Vec3& v) {
      return "OFFSET " + numbers(joint < 0 ? v : axes * (w.zero(joint).conjugate() * v)) + "\n";
    };
    text += in + (above < 0 ? "ROOT " : "JOINT ") + name_of(b) + "\n" + in + "{\n" + in + "\t" +
            offset(above, bone.offset) + in + "\t" +
            (above < 0 ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
                       : "CHANNELS 3 Zrotation Xrotation Yrotation\n");
    for (int c = 0; c < static_cast<int>(k_actor.size()); ++c)
      if (std::string(k_actor[c].parent) == bone.name) write(c, in + "\t");
    if (bone.end) text += in + "\tEnd Site\n" + in + "\t{\n" + in + "\t\t" + offset(b, *bone.end) + in + "\t}\n";
    text += in + "}\n";
  };
  write(0, "");
  for (int k = 0; k < k_frames; ++k) {
    const Vec3 root = axes * Vec3(0, 95 + w.floor, 0.8 * k);
    motion += numbers(root);
    for (const int b : order) {
      const Bone& bone = k_actor[b];
      const auto parent = std::ranges::find(k_actor, std::string(bone.parent), &Bone::name);
      Quat local = turn_of(bone.name, k) * w.zero(b);
      if (parent != k_actor.end()) {
        const int p = static_cast<int>(parent - k_actor.begin());
        local = (turn_of(parent->name, k) * w.zero(p)).conjugate() * local;
      }
      // R = Rz Rx Ry in the file's axes.
      const Eigen::Matrix3d m = axes * local.toRotationMatrix() * axes.transpose();
      Vec3 angles(std::atan2(-m(0, 1), m(1, 1)), std::asin(std::clamp(m(2, 1), -1.0, 1.0)),
                  std::atan2(-m(2, 0), m(2, 2)));
      if (std::abs(m(2, 1)) > 1.0 - 1e-9) angles = {0.0, angles[1], std::atan2(m(0, 2), m(0, 0))}; // gimbal lock
      motion += " " + numbers(angles * 180.0 / std::numbers::pi);
    }
    motion += "\n";
  }
  return text + "MOTION\nFrames: " + std::to_string(k_frames) + "\nFrame Time: 0.0166667\n" + motion;
}

/// Z up and facing -Y, as Blender and 3ds Max write it.
Vec3 z_up(const Vec3& v) { return {v.x(), -v.z(), v.y()}; }

std::string replaced(std::string text, const std::string& from, const std::string& to, bool all = false) {
  for (std::size_t at = text.find(from); at != text.npos; at = all ? text.find(from, at + to.size()) : text.npos)
    text.replace(at, from.size(), to);
  return text;
}

Mocap read(const std::string& text, const BvhOptions& options = {}) {
  const std::filesystem::path folder = test::scratch_folder();
  write_file(folder / "take.bvh", text);
  try {
    Mocap mocap = read_bvh(folder / "take.bvh", options);
    std::filesystem::remove_all(folder);
    return mocap;
  } catch (...) {
    std::filesystem::remove_all(folder);
    throw;
  }
}

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const Skeleton& dancer() {
  static const Skeleton skeleton = make_mannequin().skeleton;
  return skeleton;
}

/// On the dancer; model space.
struct OnDancer {
  const Skeleton& skeleton = dancer();
  std::vector<std::vector<Transform>> frames;

  explicit OnDancer(const Mocap& take) {
    const Clip clip = retarget(take.clip, take.skeleton, skeleton, nullptr);
    for (int k = 0; k < static_cast<int>(clip.times.size()); ++k)
      model_from_local(skeleton, clip.key(k), frames.emplace_back(skeleton.names.size()));
  }
  Vec3 at(const char* joint, int frame) const { return frames[frame][*skeleton.find(joint)].translation; }
};

/// The same poses on the dancer.
void expect_same(const OnDancer& a, const OnDancer& b, double within) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  double worst = 0.0;
  for (std::size_t k = 0; k < a.frames.size(); ++k)
    for (std::size_t j = 0; j < a.skeleton.names.size(); ++j)
      worst = std::max(worst, (a.frames[k][j].translation - b.frames[k][j].translation).norm());
  EXPECT_LT(worst, within);
}

TEST(BvhVariants, TheActorStandsOnTheFloor) {
  const Mocap mocap = read(take());
  EXPECT_THAT(mocap.notes, IsEmpty());
  const OnDancer dancer(mocap);
  const std::vector<Transform> rest = rest_model(dancer.skeleton);
  const Vec3 hips = rest[*dancer.skeleton.find("Hips")].translation;
  EXPECT_NEAR(hips.y(), 0.95, 5e-4);
  // Standing she is as at rest, so that her soles are on the floor; the foot that stands stays there. (Her own legs are
  // a little apart at rest, the actor's are not: 3 mm.)
  for (int k = 0; k < k_frames; ++k) {
    EXPECT_NEAR(dancer.at("Hips", k).y(), hips.y(), 1e-9);
    EXPECT_NEAR(dancer.at("RightFoot", k).y(), rest[*dancer.skeleton.find("RightFoot")].translation.y(), 4e-3) << k;
  }
  EXPECT_GT(dancer.at("LeftFoot", 20).y(), 0.2);
}

TEST(BvhVariants, LegsApartAtRestMakeNobodyStandHigher) {
  // Thighs and shins of a zero pose in a straddle, 20 degrees to either side, as takes of Carnegie Mellon's have it.
  const auto apart = [](int b) {
    const std::string name = k_actor[b].name;
    const bool left = name.starts_with("Left") && name.find("Arm") == name.npos;
    const bool leg = name.find("Leg") != name.npos || name.find("Foot") != name.npos;
    return leg ? Quat(Eigen::AngleAxisd((left ? -20.0 : 20.0) * std::numbers::pi / 180.0, Vec3::UnitZ()))
               : Quat::Identity();
  };
  const OnDancer plain(read(take())), straddled(read(take({.zero = apart})));
  for (int k = 0; k < k_frames; ++k) {
    EXPECT_NEAR(straddled.at("Hips", k).y(), plain.at("Hips", k).y(), 1e-9) << k;
    EXPECT_LT((straddled.at("LeftFoot", k) - plain.at("LeftFoot", k)).norm(), 1e-9) << k;
  }
}

TEST(BvhVariants, ZUpIsFoundAndTurned) {
  const OnDancer y_up(read(take()));
  const Mocap mocap = read(take({.axes = z_up}));
  EXPECT_THAT(mocap.notes, ElementsAre("Z up: turned so that +Y is up"));
  expect_same(OnDancer(mocap), y_up, 1e-9);
  // With a frame for the rest pose, too.
  const Mocap chosen = read(take({.axes = z_up}), {.rest_frame = 0, .from = 0.0, .to = {}});
  EXPECT_THAT(chosen.notes, ElementsAre("Z up: turned so that +Y is up"));
  expect_same(OnDancer(chosen), y_up, 1e-9);
}

TEST(BvhVariants, WhoLiesThroughATakeIsNotStoodUp) {
  // The plain skeleton on its back, in a file with Y up: hips 12 cm above the floor, legs along Z.
  std::string text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 4 Xposition Yposition Zposition Xrotation\n"
                     "JOINT LeftUpLeg\n{\nOFFSET 9 -5 0\nJOINT LeftLeg\n{\nOFFSET 0 -40 0\nJOINT LeftFoot\n{\n"
                     "OFFSET 0 -40 0\nEnd Site\n{\nOFFSET 0 0 12\n}\n}\n}\n}\nJOINT Head\n{\nOFFSET 0 60 0\n"
                     "End Site\n{\nOFFSET 0 20 0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n";
  const Mocap on_back = read(text + "0 12 300 90\n0 12 301 90\n");
  EXPECT_THAT(on_back.notes, testing::Not(testing::Contains(HasSubstr("Z up"))));
  const Mocap z_up = read(text + "0 300 95 90\n0 301 95 90\n");
  EXPECT_THAT(z_up.notes, testing::Contains(HasSubstr("Z up")));
}

TEST(BvhVariants, NamesThatSayNothingLeaveItToExtentsAndTheHeightOfTheHips) {
  const auto height = [](const Mocap& mocap) { return mocap.clip.key(0)[0].translation; };
  const Mocap y_up = read(take({.named = false})), turned = read(take({.axes = z_up, .named = false}));
  EXPECT_THAT(y_up.notes, IsEmpty());
  EXPECT_THAT(turned.notes, ElementsAre("Z up: turned so that +Y is up"));
  EXPECT_LT((height(y_up) - height(turned)).norm(), 1e-9);
  EXPECT_GT(height(y_up).y(), 0.9);
}

TEST(BvhVariants, AFloorThatIsNotAtZeroIsFound) {
  const OnDancer at_zero(read(take()));
  for (const double floor : {-95.0, 40.0, 250.0}) {
    const Mocap mocap = read(take({.floor = floor}));
    EXPECT_THAT(mocap.notes, ElementsAre(HasSubstr("the floor is taken to be there"))) << floor;
    const OnDancer dancer(mocap);
    EXPECT_NEAR(dancer.at("Hips", 0).y(), at_zero.at("Hips", 0).y(), 1e-9) << floor;
  }
}

TEST(BvhVariants, AZeroPoseThatLiesIsStoodUp) {
  // Zero is on the back, or on the face, or on the side: the motion is the same.
  const OnDancer plain(read(take()));
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(-Vec3::UnitX()), Vec3(Vec3::UnitZ())}) {
    const Quat lies = Quat(Eigen::AngleAxisd(std::numbers::pi / 2, axis));
    for (const bool turned : {false, true}) {
      Writing w{.zero = [&](int) { return lies.conjugate(); }};
      if (turned) w.axes = z_up;
      const Mocap mocap = read(take(w));
      EXPECT_EQ(mocap.notes.size(), turned ? 2u : 1u);
      EXPECT_THAT(mocap.notes.back(), HasSubstr("zero lies: stood up"));
      expect_same(OnDancer(mocap), plain, 1e-6);
    }
  }
}

TEST(BvhVariants, AZeroPoseThatIsNoStanceGivesWayToTheFirstFrame) {
  // All bones along +Y where all rotations are zero, as files have it whose joints have axes along their bones.
  const OnDancer plain(read(take()));
  const auto zero = [](int b) {
    const Vec3 along =
        k_actor[b].end ? *k_actor[b].end : Vec3(0, std::string(k_actor[b].name).find("Leg") < 20 ? -1 : 1, 0);
    return rotation_between(Vec3::UnitY(), along);
  };
  const Mocap mocap = read(take({.zero = zero}));
  EXPECT_THAT(mocap.notes, ElementsAre(HasSubstr("does not stand: frame 0 is the rest pose")));
  expect_same(OnDancer(mocap), plain, 1e-6);
}

TEST(BvhVariants, WordsAndBracesAsOthersWriteThem) {
  const std::string plain = take();
  const OnDancer as_plain(read(plain));
  const std::pair<const char*, std::string> variants[] = {
      {"End site", replaced(plain, "End Site", "End site", true)},
      {"END SITE", replaced(plain, "End Site", "END SITE", true)},
      {"EndSite", replaced(plain, "End Site", "EndSite", true)},
      {"named end site", replaced(plain, "End Site", "End Site Head_end", true)},
      {"end site's name below", replaced(plain, "End Site\n", "End Site\nHead end\n", true)},
      {"Time:0.0167", replaced(plain, "Frame Time: ", "Frame Time:")},
      {"Frames:21", replaced(plain, "Frames: ", "Frames:")},
      {"Frames :", replaced(replaced(plain, "Frames: ", "Frames :\t"), "Frame Time:", "FRAME  TIME :")},
      {"mark", "\xEF\xBB\xBF" + plain},
      {"CR LF", replaced(plain, "\n", "\r\n", true)},
      {"CR", replaced(plain, "\n", "\r", true)},
      {"lower case",
       replaced(replaced(replaced(plain, "JOINT", "Joint", true), "HIERARCHY", "Hierarchy"), "MOTION", "Motion")},
      {"channels in lower case", replaced(replaced(plain, "rotation", "ROTATION", true), "Xposition", "xPosition")},
      {"braces on the line", replaced(replaced(plain, "Hips\n{", "Hips {"), "End Site\n\t\t\t{", "End Site {")},
      {"no blank before a brace", replaced(plain, "Hips\n{\n\tOFFSET", "Hips{OFFSET")},
      {"blank lines and trailing blanks", replaced(replaced(plain, "\n", " \t\n\n", true), "MOTION", " MOTION\n ")},
  };
  for (const auto& [what, text] : variants) {
    SCOPED_TRACE(what);
    ASSERT_NE(text, plain);
    const Mocap mocap = read(text);
    EXPECT_THAT(mocap.notes, IsEmpty());
    expect_same(OnDancer(mocap), as_plain, 1e-12);
  }
}

TEST(BvhVariants, OffsetAndChannelsComeInEitherOrderAndChannelsMayBeAbsent) {
  const std::string plain = take();
  const std::string offset = "OFFSET 0.000000000000 25.000000000000 0.000000000000\n",
                    channels = "CHANNELS 3 Zrotation Xrotation Yrotation\n";
  const std::string swapped = replaced(plain, offset + "\t\t" + channels, channels + "\t\t" + offset);
  ASSERT_NE(swapped, plain);
  expect_same(OnDancer(read(swapped)), OnDancer(read(plain)), 1e-12);

  const Mocap mocap = read("HIERARCHY ROOT A\n{ OFFSET 0 0 0 CHANNELS 1 Yposition JOINT B\n{ OFFSET 0 1 0 End Site\n"
                           "{ OFFSET 0 1 0 } } }\nMOTION Frames: 2 Frame Time: 0.1\n5\n6\n");
  EXPECT_EQ(mocap.clip.local.size(), 4u);
  EXPECT_NEAR(mocap.clip.key(1)[0].translation.y(), 6 * k_bvh_stature / 2, 1e-12);
}

TEST(BvhVariants, NamesMayHaveBlanks) {
  Mocap mocap = read(take({.root = "Bip01 Pelvis", .thigh = "L Thigh"}));
  EXPECT_EQ(mocap.skeleton.names[0], "Bip01 Pelvis");
  EXPECT_TRUE(mocap.skeleton.find("L Thigh"));
  rename_joints(mocap.skeleton, {{"Bip01 Pelvis", "Hips"}, {"L Thigh", "LeftUpLeg"}}, "take.bvh");
  expect_same(OnDancer(mocap), OnDancer(read(take())), 1e-12);
}

TEST(BvhVariants, OfSeveralRootsTheFirstIsReadAndTheOthersAreNamed) {
  const std::string plain = take();
  std::string text = replaced(plain, "MOTION\n",
                              "ROOT Prop one\n{\nOFFSET 1 2 3\nCHANNELS 3 Xposition Yposition "
                              "Zposition\nJOINT Hips { OFFSET 0 1 0 CHANNELS 1 Xrotation }\n}\n"
                              "ROOT Camera\n{\nOFFSET 0 0 0\n}\nMOTION\n");
  const std::size_t motion = text.find("Frame Time");
  std::string lines = text.substr(motion);
  std::size_t line = lines.find('\n');
  while ((line = lines.find('\n', line + 1)) != lines.npos) lines.insert(line, " 7 8 9 -10"), line += 10;
  const Mocap mocap = read(text.substr(0, motion) + lines);
  EXPECT_THAT(mocap.notes, ElementsAre("3 roots: Hips is read; left out: Prop one, Camera"));
  expect_same(OnDancer(mocap), OnDancer(read(plain)), 1e-12);
}

TEST(BvhVariants, JointsOfOneNameAreTwo) {
  const Mocap mocap = read(replaced(replaced(take(), "JOINT LeftArm", "JOINT Arm"), "JOINT RightArm", "JOINT Arm"));
  EXPECT_TRUE(mocap.skeleton.find("Arm") && mocap.skeleton.find("Arm_2"));
  EXPECT_THAT(mocap.notes, ElementsAre("1 joint has the name of another (Arm): numbered"));
}

TEST(BvhVariants, NumbersThatAreNotThereAreToldWithTheirFrame) {
  const std::string plain = take();
  // Frame 4, one number less and one more.
  std::size_t line = plain.find("Frame Time");
  for (int k = 0; k < 6; ++k) line = plain.find('\n', line + 1);
  const std::string fewer = plain.substr(0, plain.rfind(' ', line)) + plain.substr(line);
  const std::string more = plain.substr(0, line) + " 1" + plain.substr(line);
  EXPECT_THAT(error_of(fewer), HasSubstr("found 35 numbers for frame 4, expected 36 numbers"));
  EXPECT_THAT(error_of(more), HasSubstr("found 37 numbers for frame 4, expected 36 numbers"));
  EXPECT_THAT(error_of(replaced(plain, "Frames: 21", "Frames: 22")),
              HasSubstr("found the end of the file in frame 21, expected 22 frames of 36 numbers"));
  EXPECT_THAT(error_of(replaced(plain, "Frames: 21", "Frames: 20")),
              HasSubstr("found 36 more numbers, expected the end of the file after 20 frames of 36 numbers"));
  EXPECT_THAT(error_of(replaced(plain, "Frames: 21", "Frames: 0")), HasSubstr("found no frames"));
  EXPECT_THAT(error_of(replaced(plain, "0.0166667", "0,0166667")),
              HasSubstr("found \"0,0166667\", expected a finite number, without a comma"));
  EXPECT_THAT(error_of(replaced(plain, "0.0166667", "1e9 nan")), HasSubstr("found \"nan\", expected a finite number"));
  EXPECT_THAT(error_of(replaced(plain, "JOINT Spine\n", "JOINT \n")), HasSubstr("found no name, expected a joint's"));
  EXPECT_THAT(error_of(replaced(plain, "OFFSET", "OFSET")), HasSubstr("line 4: found \"OFSET\", expected OFFSET"));
  EXPECT_THAT(error_of(replaced(plain, "\n", "\r", true).substr(0, 60)),
              HasSubstr("line 4: found the end of the file"));
}

} // namespace
