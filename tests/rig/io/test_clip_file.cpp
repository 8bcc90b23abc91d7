#include "rig/error.h"
#include "rig/io/clip_file.h"
#include "rig/io/file_io.h"
#include "rig/io/json_file.h"
#include "tests/rig/random_skeleton.h"
#include "tests/support/paths.h"

#include <bit>
#include <cstdint>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::rig;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

/// What the call throws as InputError; "" when it throws none.
template <class Call> std::string error_of(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

void expect_same_joints(const RawClip& a, const RawClip& b) {
  ASSERT_EQ(a.keys.size(), b.keys.size());
  for (std::size_t k = 0; k < a.keys.size(); ++k) {
    EXPECT_TRUE(same_bits(a.keys[k].time, b.keys[k].time));
    ASSERT_EQ(a.keys[k].joints.size(), b.keys[k].joints.size());
    for (const auto& [name, joint] : a.keys[k].joints) {
      const JointKey& other = b.keys[k].joints.at(name);
      ASSERT_EQ(joint.translation.has_value(), other.translation.has_value());
      ASSERT_EQ(joint.rotation.has_value(), other.rotation.has_value());
      for (int i = 0; joint.translation && i < 3; ++i)
        EXPECT_TRUE(same_bits((*joint.translation)[i], (*other.translation)[i]));
      for (int i = 0; joint.rotation && i < 4; ++i)
        EXPECT_TRUE(same_bits(joint.rotation->coeffs()[i], other.rotation->coeffs()[i]));
    }
  }
}

/// Doubles of every size a file may hold, for what has no unit to be recognised.
double any_double(std::mt19937_64& random) {
  for (;;)
    if (const double value = std::bit_cast<double>(random()); std::abs(value) <= k_largest_number) return value;
}

std::string clip_error(const std::string& json) {
  const fs::path folder = test::scratch_folder();
  write_file(folder / "clip.json", json);
  std::string error = error_of([&] { read_clip(folder / "clip.json"); });
  fs::remove_all(folder);
  return error;
}

TEST(ClipFile, ReadsWhatAPersonWrites) {
  const fs::path file = test::scratch_folder() / "pirouette.json";
  write_file(file, R"({
    // the turn
    "$schema": "../schema/clip.schema.json",
    "extrapolation": "clamp",
    "keys": [
      {"time": 0, "name": "stand"},
      {"time": 1, "joints": {
        "Hips": {"translation": [0, 1, 0]},
        "Spine": {"rotation": [0, 0.6, 0, 0.8], "comment": "half"},
        "Neck": {}
      }}
    ]
  })");
  const RawClip clip = read_clip(file);
  EXPECT_EQ(clip.name, "pirouette");
  EXPECT_EQ(clip.file, file.string());
  EXPECT_EQ(clip.extrapolation, Extrapolation::clamp);
  ASSERT_EQ(clip.keys.size(), 2u);
  EXPECT_EQ(clip.keys[0].name, "stand");
  EXPECT_TRUE(clip.keys[0].joints.empty());
  EXPECT_EQ(clip.keys[1].time, 1.0);
  EXPECT_EQ(clip.keys[1].joints.at("Hips").translation, Vec3(0, 1, 0));
  EXPECT_EQ(clip.keys[1].joints.at("Hips").rotation, std::nullopt);
  EXPECT_EQ(clip.keys[1].joints.at("Spine").rotation->y(), 0.6);
  EXPECT_EQ(clip.keys[1].joints.at("Spine").rotation->w(), 0.8);
  EXPECT_EQ(clip.keys[1].joints.at("Neck"), JointKey());
  fs::remove_all(file.parent_path());
}

TEST(ClipFile, RoundTripKeepsEveryBit) {
  const fs::path file = test::scratch_folder() / "clip.json";
  std::mt19937_64 random(1);
  for (int round = 0; round < 6; ++round) {
    const Skeleton skeleton = test::random_skeleton(random, 20);
    RawClip clip = test::random_clip(random, skeleton, 4);
    clip.name = "a \"name\" with \\ and \xc3\xa9";
    clip.extrapolation = round % 2 == 0 ? Extrapolation::loop : Extrapolation::clamp;
    clip.interpolation = static_cast<Interpolation>(round % 3);
    clip.keys[1].airborne = round % 2 == 0;
    clip.keys[1].name.clear();
    clip.keys[2].joints.clear();
    for (auto& [name, joint] : clip.keys[0].joints)
      joint.translation = Vec3(any_double(random), any_double(random), any_double(random));
    clip.keys[0].joints["J0"].translation = Vec3(-0.0, 5e-324, -k_largest_number);
    clip.keys[0].joints["J1"].translation.reset();
    clip.keys[0].joints["J2"].rotation.reset();
    clip.keys[0].joints["J3"] = {};
    write_clip(clip, file);
    const RawClip back = read_clip(file);
    EXPECT_EQ(back.name, clip.name);
    EXPECT_EQ(back.extrapolation, clip.extrapolation);
    EXPECT_EQ(back.interpolation, clip.interpolation);
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(back.keys[k].name, clip.keys[k].name);
      EXPECT_EQ(back.keys[k].airborne, clip.keys[k].airborne);
    }
    expect_same_joints(clip, back);
    const std::string written = read_file(file);
    write_clip(back, file);
    EXPECT_EQ(read_file(file), written);
  }
  fs::remove_all(file.parent_path());
}

TEST(ClipFile, IsLaidOutForPeople) {
  const fs::path file = test::scratch_folder() / "clip.json";
  RawClip clip;
  clip.name = "dance";
  clip.keys.push_back(
      {0.0, "stand", {{"Hips", {Vec3(0, 1, 0.1), Quat(1, 0, 0, 0)}}, {"Neck", {{}, Quat(0.8, 0, 0.6, 0)}}}});
  clip.keys.push_back({0.5, "", {{"Hips", {Vec3(0, 1, 0.1), {}}}}});
  write_clip(clip, file);
  EXPECT_EQ(read_file(file), R"({
  "name": "dance",
  "extrapolation": "loop",
  "interpolation": "nlerp",
  "keys": [
    {"time": 0.0, "name": "stand", "joints": {
      "Hips": {"translation": [0.0, 1.0, 0.1], "rotation": [0.0, 0.0, 0.0, 1.0]},
      "Neck": {"rotation": [0.0, 0.6, 0.0, 0.8]}
    }},
    {"time": 0.5, "joints": {
      "Hips": {"translation": [0.0, 1.0, 0.1]}
    }}
  ]
}
)");
  fs::remove_all(file.parent_path());
}

TEST(ClipFile, WhatCannotBeReadBackIsNotWritten) {
  const fs::path folder = test::scratch_folder();
  RawClip clip;
  EXPECT_THROW(write_clip(clip, folder / "clip.json"), InputError);
  clip.keys.push_back({0.0, "", {{"Hips", {Vec3(0, NAN, 0), {}}}}});
  EXPECT_THROW(write_clip(clip, folder / "clip.json"), InputError);
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

TEST(ClipFile, ErrorsTellFilePlaceFoundAndExpected) {
  const auto key = [](const std::string& inside) {
    return "{\"keys\": [{\"time\": 0, \"joints\": {\"Hips\": {" + inside + "}}}]}";
  };
  EXPECT_THAT(clip_error(""), HasSubstr("clip.json: found an empty file"));
  EXPECT_THAT(clip_error("{}"), HasSubstr("no key \"keys\""));
  EXPECT_THAT(clip_error("[]"), HasSubstr("expected an object"));
  EXPECT_THAT(clip_error("{\"keys\": []}"), HasSubstr("clip.json: /keys: found no keys, expected at least one key"));
  EXPECT_THAT(clip_error("{\"keys\": [{}]}"), HasSubstr("/keys/0: found no key \"time\""));
  EXPECT_THAT(clip_error("{\"keys\": [{\"time\": \"0\"}]}"), HasSubstr("/keys/0/time"));
  EXPECT_THAT(clip_error("{\"keys\": [{\"time\": 0}, {\"time\": 1.5}, {\"time\": 1.5}]}"),
              HasSubstr("/keys/2/time: found 1.5 s after 1.5 s of key 1, expected strictly rising times"));
  EXPECT_THAT(clip_error("{\"keys\": [{\"time\": 0}], \"fps\": 30}"), HasSubstr("unknown key \"fps\""));
  EXPECT_THAT(clip_error("{\"keys\": [{\"time\": 0, \"pose\": 1}]}"), HasSubstr("/keys/0/pose"));
  EXPECT_THAT(clip_error("{\"keys\": [{\"time\": 0}], \"extrapolation\": \"mirror\"}"), HasSubstr("loop, clamp"));
  EXPECT_THAT(clip_error("{\"keys\": [{\"time\": 0}], \"interpolation\": \"linear\"}"),
              HasSubstr("nlerp, slerp, cubic"));
  EXPECT_THAT(clip_error("{\"keys\": [{\"time\": 0, \"airborne\": 1}]}"), HasSubstr("/keys/0/airborne"));
  EXPECT_THAT(clip_error(key("\"scale\": 1")), HasSubstr("/keys/0/joints/Hips/scale: found unknown key"));
  EXPECT_THAT(clip_error(key("\"rotation\": [0, 0, 0, 2]")), HasSubstr("/keys/0/joints/Hips/rotation"));
  EXPECT_THAT(clip_error(key("\"rotation\": [0, 0, 0, 0]")), HasSubstr("unit quaternion"));
  EXPECT_THAT(clip_error(key("\"rotation\": [0, 0, 1]")), HasSubstr("an array of 4 numbers"));
  EXPECT_THAT(clip_error(key("\"translation\": [0, 1e999, 1]")), HasSubstr("clip.json"));
  EXPECT_THAT(clip_error(key("\"translation\": [0, null, 1]")), HasSubstr("/keys/0/joints/Hips/translation/1"));
}

/// Hips with a leg of two bones and a spine.
Skeleton small_skeleton() {
  Skeleton skeleton;
  skeleton.names = {"Hips", "LeftUpLeg", "LeftLeg", "Spine"};
  skeleton.parents = {k_no_parent, 0, 1, 0};
  skeleton.rest_local = {{Quat::Identity(), {0, 1, 0}},
                         {Quat::Identity(), {0.1, -0.05, 0}},
                         {Quat::Identity(), {0, -0.45, 0}},
                         {Quat::Identity(), {0, 0.2, 0}}};
  return skeleton;
}

constexpr const char* k_rest_line = "0 1 0  0.1 -0.05 0  0 -0.45 0  0 0.2 0\n";
constexpr const char* k_identity_line = "0 0 0 1 0 0 0 1 0 0 0 1 0 0 0 1\n";

class ThreeTextFiles : public testing::Test {
protected:
  ThreeTextFiles() : folder(test::scratch_folder()) {
    files = {folder / "t.txt", folder / "q.txt", folder / "times.txt", {}};
  }
  ~ThreeTextFiles() override { fs::remove_all(folder); }

  RawClip read(const std::string& translations, const std::string& rotations, const std::string& times,
               const std::string& joints = "") {
    write_file(files.translations, translations);
    write_file(files.rotations, rotations);
    write_file(files.times, times);
    if (!joints.empty()) write_file(*(files.joints = folder / "joints.txt"), joints);
    return read_three_texts(files, small_skeleton(), &notes);
  }
  std::string read_error(const std::string& translations, const std::string& rotations, const std::string& times,
                         const std::string& joints = "") {
    return error_of([&] { read(translations, rotations, times, joints); });
  }

  fs::path folder;
  ThreeTexts files;
  std::vector<std::string> notes;
};

TEST_F(ThreeTextFiles, ReadInSkeletonOrder) {
  const RawClip clip = read("0 1 0 0.1 -0.05 0 0 -0.45 0 0 0.2 0\n\t+0 1.5  0 1e-1 -5E-2 0 0 -0.45 0 0 0.2 0 \r\n\n",
                            std::string(k_identity_line) + "0 0 0.6 0.8 0 0 0 1 0 0 0 1 1 0 0 0", "0 0.5");
  EXPECT_THAT(notes, testing::IsEmpty());
  EXPECT_EQ(clip.name, "t");
  ASSERT_EQ(clip.keys.size(), 2u);
  EXPECT_EQ(clip.keys[1].time, 0.5);
  EXPECT_EQ(clip.keys[1].joints.size(), 4u);
  EXPECT_EQ(clip.keys[1].joints.at("Hips").translation, Vec3(0, 1.5, 0));
  EXPECT_EQ(clip.keys[1].joints.at("Hips").rotation->coeffs(), Eigen::Vector4d(0, 0, 0.6, 0.8));
  EXPECT_EQ(clip.keys[1].joints.at("LeftUpLeg").translation, Vec3(0.1, -0.05, 0));
  EXPECT_EQ(clip.keys[1].joints.at("Spine").rotation->coeffs(), Eigen::Vector4d(1, 0, 0, 0));
}

TEST_F(ThreeTextFiles, TimesMayStandOnePerLine) {
  const std::string t = k_rest_line, q = k_identity_line;
  const RawClip clip = read(t + t + t, q + q + q, "0\n0.25\n\n1\n");
  EXPECT_EQ(clip.keys[2].time, 1.0);
}

TEST_F(ThreeTextFiles, ReadInTheOrderOfAJointList) {
  const RawClip clip = read("0 0.2 0 0 1 0 0.1 -0.05 0\n", "0 0.6 0 0.8 0 0 0 1 0 0 0 1", "0",
                            "0 1 mixamorig:Spine\n1 -1 Hips\n2 1 LeftUpLeg\n");
  EXPECT_EQ(clip.keys[0].joints.size(), 3u);
  EXPECT_EQ(clip.keys[0].joints.at("Spine").translation, Vec3(0, 0.2, 0));
  EXPECT_EQ(clip.keys[0].joints.at("Spine").rotation->y(), 0.6);
  EXPECT_EQ(clip.keys[0].joints.at("Hips").translation, Vec3(0, 1, 0));
}

TEST_F(ThreeTextFiles, RoundTripKeepsEveryBit) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 6; ++round) {
    const Skeleton skeleton = test::random_skeleton(random, 25);
    const RawClip clip = test::random_clip(random, skeleton, 5);
    files.joints = folder / "joints.txt";
    write_three_texts(clip, skeleton, files);
    expect_same_joints(clip, read_three_texts(files, skeleton, &notes));
    EXPECT_THAT(notes, testing::IsEmpty());
    files.joints.reset();
    expect_same_joints(clip, read_three_texts(files, skeleton, nullptr));
  }
}

TEST_F(ThreeTextFiles, WritingFillsWhatIsNotGivenFromRest) {
  RawClip clip;
  clip.keys.push_back({0.25, "", {{"LeftLeg", {{}, Quat(0.8, 0, 0.6, 0)}}}});
  files.joints = folder / "joints.txt";
  write_three_texts(clip, small_skeleton(), files);
  EXPECT_EQ(read_file(files.translations), "0 1 0 0.1 -0.05 0 0 -0.45 0 0 0.2 0\n");
  EXPECT_EQ(read_file(files.rotations), "0 0 0 1 0 0 0 1 0 0.6 0 0.8 0 0 0 1\n");
  EXPECT_EQ(read_file(files.times), "0.25\n");
  EXPECT_EQ(read_file(*files.joints), "0 -1 Hips\n1 0 LeftUpLeg\n2 1 LeftLeg\n3 0 Spine\n");
}

TEST_F(ThreeTextFiles, OtherUnitsAreRecognisedByTheBones) {
  std::mt19937_64 random(2);
  const Skeleton skeleton = test::random_skeleton(random, 20);
  const struct {
    double per_metre;
    const char* name;
  } units[] = {
      {10, "decimetres"}, {100, "centimetres"}, {1000, "millimetres"}, {1 / 0.0254, "inches"}, {1 / 0.3048, "feet"}};
  for (const auto& unit : units) {
    for (const double proportion : {0.93, 1.0, 1.07}) { // bones need not be quite as long as the skeleton's
      RawClip clip = test::random_clip(random, skeleton, 3), scaled = clip;
      for (std::size_t k = 0; k < 3; ++k) {
        for (auto& [name, joint] : clip.keys[k].joints) {
          *joint.translation *= proportion;
          scaled.keys[k].joints[name].translation = *joint.translation * unit.per_metre;
        }
      }
      write_three_texts(scaled, skeleton, files);
      notes.clear();
      const RawClip back = read_three_texts(files, skeleton, &notes);
      EXPECT_THAT(notes, testing::ElementsAre(HasSubstr(unit.name)));
      for (std::size_t k = 0; k < 3; ++k)
        for (const auto& [name, joint] : clip.keys[k].joints)
          EXPECT_LT((*back.keys[k].joints.at(name).translation - *joint.translation).norm(), 1e-14);
    }
  }
}

TEST_F(ThreeTextFiles, TranslationsInNoKnownUnitAreRefused) {
  EXPECT_THAT(read_error("0 5 0 0.5 -0.25 0 0 -2.25 0 0 1 0\n", k_identity_line, "0"),
              HasSubstr("t.txt: found bones 5.000000 times as long as the skeleton's in metres"));
  EXPECT_THAT(read_error("0 1 0 0 0 0 0 0 0 0 0 0\n", k_identity_line, "0"), HasSubstr("found bones 0.000000 times"));
}

TEST_F(ThreeTextFiles, ASkeletonOfRootsTellsNoUnit) {
  Skeleton root;
  root.names = {"Hips"};
  root.parents = {k_no_parent};
  root.rest_local = {{Quat::Identity(), {0, 1, 0}}};
  write_file(files.translations, "0 100 0");
  write_file(files.rotations, "0 0 0 1");
  write_file(files.times, "0");
  EXPECT_EQ(read_three_texts(files, root, &notes).keys[0].joints.at("Hips").translation, Vec3(0, 100, 0));
}

TEST_F(ThreeTextFiles, RotationsOfFewDigitsAreNormalised) {
  const RawClip clip = read(k_rest_line, "0 0 0.70711 0.70711 0 0 0 1.0009 0 0 0 1 0 0 0 1", "0");
  for (const auto& [name, joint] : clip.keys[0].joints) EXPECT_NEAR(joint.rotation->norm(), 1.0, 1e-15);
  EXPECT_THAT(notes, testing::IsEmpty());
}

TEST_F(ThreeTextFiles, RotationsOffUnitLengthAreNormalisedWithOneNote) {
  const std::string t = k_rest_line, q = k_identity_line;
  const RawClip clip = read(t + t, q + "0 0 0.588 0.784 0 0 0 1 0 0 0 1 0 0 0 1", "0 1");
  EXPECT_LT((clip.keys[1].joints.at("Hips").rotation->coeffs() - Eigen::Vector4d(0, 0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_THAT(notes, testing::ElementsAre(files.rotations.string() +
                                          ": 1 of 8 rotations was not of unit length (0.98): normalised"));
  notes.clear();
  read(t, "0 0 0 1.1 0 0 0 0.9 0 0 0 1.05 -1 0 0 0", "0");
  EXPECT_THAT(notes, testing::ElementsAre(HasSubstr("3 of 4 rotations were not of unit length (the farthest ")));
  for (const char* length : {"1.11", "0.89", "1e9"})
    EXPECT_THAT(read_error(t, "0 0 0 1 0 0 0 1 0 0 0 1 0 0 0 " + std::string(length), "0"),
                HasSubstr("for joint Spine, expected a unit quaternion x y z w (up to 10 % off is normalised"))
        << length;
}

TEST(ClipFile, RotationsOffUnitLengthAreNormalisedWithOneNote) {
  const fs::path folder = test::scratch_folder(), file = folder / "clip.json";
  write_file(file, R"({"keys": [{"time": 0, "joints": {"A": {"rotation": [0, 0.588, 0, 0.784]},
                                                       "B": {"rotation": [0, 0, 0, 1]}}}]})");
  std::vector<std::string> notes;
  const RawClip clip = read_clip(file, &notes);
  EXPECT_LT((clip.keys[0].joints.at("A").rotation->coeffs() - Eigen::Vector4d(0, 0.6, 0, 0.8)).norm(), 1e-15);
  EXPECT_THAT(notes,
              testing::ElementsAre(file.string() + ": 1 of 2 rotations was not of unit length (0.98): normalised"));
  check(clip); // as it can be played
  fs::remove_all(folder);
}

TEST_F(ThreeTextFiles, ErrorsTellFileLineFoundAndExpected) {
  const std::string t = k_rest_line, q = k_identity_line;
  EXPECT_THAT(read_error(t + "\n0 1 0", q + q, "0 1"),
              HasSubstr("t.txt: line 3: found 3 numbers, expected 12 (3 numbers for each of 4 joints)"));
  EXPECT_THAT(read_error(t, "0 0 0 1", "0"), HasSubstr("q.txt: line 1: found 4 numbers, expected 16"));
  EXPECT_THAT(read_error(t, "0 0 0 1 0 0 0 1 0 0 0 1 0 0 0 one", "0"), HasSubstr("q.txt: line 1: found \"one\""));
  EXPECT_THAT(read_error(t, "0 0 0 1 0 0 0 1 0 0 0 1 0 0 0 1,0", "0"),
              HasSubstr("found \"1,0\", expected a finite number"));
  EXPECT_THAT(read_error(t, "0 0 0 1 0 0 0 1 0 0 0 1 0 0 0 nan", "0"), HasSubstr("found \"nan\""));
  EXPECT_THAT(read_error(t, "0 0 0 1 0 0 0 1 0 0 0 1 0 0 0 +-1", "0"), HasSubstr("found \"+-1\""));
  EXPECT_THAT(read_error(t, "0 0 0 1 0 0 0 1 0 0 0 1 0 0 0 1e999", "0"), HasSubstr("found \"1e999\""));
  EXPECT_THAT(read_error(t, q, "0 inf"), HasSubstr("times.txt: line 1: found \"inf\""));
  EXPECT_THAT(read_error(t, "0 0 0 1 0 0 0 1 0 0 0 0 0 0 0 1", "0"), HasSubstr("length 0.000000 for joint LeftLeg"));
  EXPECT_THAT(read_error(t, "0 0 0 1 0 0 0 1 0 0 0 1 0 0 1 1", "0"), HasSubstr("for joint Spine"));
  EXPECT_THAT(read_error(t + t, q, "0"), HasSubstr("t.txt: found 2 poses, expected 1, one a time of"));
  EXPECT_THAT(read_error(t, q + q, "0"), HasSubstr("q.txt: found 2 poses, expected 1"));
  EXPECT_THAT(read_error(t + t, q + q, "0\n0"), HasSubstr("times.txt: line 2: found time 0.000000 after 0.000000"));
  EXPECT_THAT(read_error("", q, "0"), HasSubstr("t.txt: found an empty file"));
  EXPECT_THAT(read_error(t, q, " \n"), HasSubstr("times.txt: found an empty file"));
  files.times = folder / "missing.txt";
  EXPECT_THAT(error_of([&] { read_three_texts(files, small_skeleton(), &notes); }),
              HasSubstr("missing.txt: found no such file"));
}

TEST_F(ThreeTextFiles, JointListsThatDoNotFitAreRefused) {
  const auto error = [&](const std::string& joints) { return read_error(k_rest_line, k_identity_line, "0", joints); };
  EXPECT_THAT(error("0 -1 Hips\n1 0 Tail\n"),
              HasSubstr("joints.txt: line 2: found joint Tail, expected a joint of the skeleton"));
  EXPECT_THAT(error("0 -1 Hips\n1 0 hips\n"), HasSubstr("line 2: found joint hips again"));
  EXPECT_THAT(error("0 -1 Hips\n2 0 Spine\n"), HasSubstr("line 2: found index 2, expected 1"));
  EXPECT_THAT(error("0 -1 Hips\n1 7 Spine\n"), HasSubstr("line 2: found parent 7"));
  EXPECT_THAT(error("0 -1 Hips\n1 1 Spine\n"), HasSubstr("line 2: found parent 1"));
  EXPECT_THAT(error("0 -1 Hips\n1 Spine\n"), HasSubstr("line 2: found \"1 Spine\", expected index, parent and name"));
  EXPECT_THAT(error("0 -1 Hips\n1 0\n"), HasSubstr("line 2: found \"1 0\""));
  EXPECT_THAT(error("0 -1 Hips\n1 0 LeftUpLeg\n2 1 Spine\n"),
              HasSubstr("line 3: found parent LeftUpLeg, expected parent Hips, as in the skeleton"));
  EXPECT_THAT(error("0 -1 Hips\n1 -1 Spine\n"), HasSubstr("line 2: found no parent, expected parent Hips"));
  EXPECT_THAT(error("0 1 Hips\n1 -1 Spine\n"), HasSubstr("line 1: found parent Spine, expected no parent"));
  EXPECT_THAT(error("0 -1 Hips\n1 0 Spine\n"), HasSubstr("t.txt: line 1: found 12 numbers, expected 6"));
}

} // namespace
