// What the formats that assimp reads say of time and names, from the file to the character.
#include "rig/error.h"
#include "rig/import/import.h"
#include "tests/rig/import/tiny_collada.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::test;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size(), ++found)
    text.replace(at, what.size(), by);
  EXPECT_GT(found, 0u) << what;
  return text;
}

Quat rotation_at(const Import& import, std::size_t clip, double time, const std::string& joint) {
  std::vector<Transform> local(import.character.skeleton.rest_local);
  sample(import.clips.at(clip), time, local);
  return local.at(static_cast<std::size_t>(*import.character.skeleton.find(joint))).rotation;
}
double turned_by(const Import& import, std::size_t clip, double time, const std::string& joint) {
  return rotation_at(import, clip, time, joint)
      .angularDistance(
          import.character.skeleton.rest_local.at(static_cast<std::size_t>(*import.character.skeleton.find(joint)))
              .rotation);
}

/// The head turns by 0, 0.6 and 1.2 at 0, 1 and 2 s, from where it rests.
TinyFile nodding() {
  TinyFile file = upright();
  const Matrix4 head = file.nodes[0].children[0].children[0].matrix;
  file.tracks = {{"Head-2", {0, 1, 2}, {head, head * turned(0.6, Vec3::UnitX()), head * turned(1.2, Vec3::UnitX())}}};
  return file;
}

TEST(ImportCollada, NodesWithoutANameGoByTheirId) {
  std::string text = collada_text(nodding());
  for (const char* name : {"Hips", "Head", "HeadTop_End"})
    text = replaced(text, "name=\"" + std::string(name) + "\" type=\"JOINT\"", "type=\"JOINT\"");
  const Import import = import_character(write_text("tiny.dae", text));
  EXPECT_THAT(import.character.skeleton.names, ElementsAre("Hips-1", "Head-2", "HeadTop_End-3"));
  ASSERT_EQ(import.clips.size(), 1u);
  EXPECT_NEAR(import.clips[0].duration(), 2.0, 1e-6);
  EXPECT_NEAR(turned_by(import, 0, 0.5, "Head-2"), 0.3, 1e-5);
}

TEST(ImportCollada, ATargetIsANodeNotAName) {
  const std::string text =
      replaced(collada_text(nodding()), "name=\"Hips\" type=\"JOINT\"", "name=\"Head\" type=\"JOINT\"");
  const Import import = import_character(write_text("tiny.dae", text));
  EXPECT_THAT(import.character.skeleton.names, ElementsAre("Head", "Head_2", "HeadTop_End"));
  ASSERT_EQ(import.clips.size(), 1u);
  EXPECT_NEAR(turned_by(import, 0, 0.5, "Head"), 0.0, 1e-6);
  EXPECT_NEAR(turned_by(import, 0, 0.5, "Head_2"), 0.3, 1e-5);
}

TEST(ImportCollada, StepsAreHeld) {
  const std::string text = replaced(collada_text(nodding()), "LINEAR LINEAR LINEAR", "STEP STEP STEP");
  const Import import = import_character(write_text("tiny.dae", text));
  EXPECT_NEAR(turned_by(import, 0, 0.9, "Head"), 0.0, 1e-6);
  EXPECT_NEAR(turned_by(import, 0, 1.9, "Head"), 0.6, 1e-5);
}

TEST(ImportCollada, ClipsAreCutWhereTheFileSays) {
  const std::string text = replaced(collada_text(nodding()), "<library_visual_scenes>",
                                    R"(<library_animation_clips><animation_clip id="a" name="down" start="0" end="1.5">
<instance_animation url="#anim-Head-2"/></animation_clip><animation_clip id="up" start="1.5" end="2">
<instance_animation url="#anim-Head-2"/></animation_clip></library_animation_clips><library_visual_scenes>)");
  const Import import = import_character(write_text("tiny.dae", text));
  ASSERT_EQ(import.clips.size(), 2u);
  EXPECT_EQ(import.clips[0].name, "down");
  EXPECT_EQ(import.clips[1].name, "up");
  EXPECT_NEAR(import.clips[0].duration(), 1.5, 1e-6);
  EXPECT_NEAR(import.clips[1].duration(), 0.5, 1e-6);
  EXPECT_NEAR(turned_by(import, 1, import.clips[1].start + 0.25, "Head"), 1.05, 1e-5);
}

TEST(ImportCollada, AFirstKeyThatIsLateWaits) {
  TinyFile file = nodding();
  file.tracks[0].times = {1.25, 2, 2.25};
  const Import import = import_tiny(file);
  EXPECT_NEAR(import.clips.at(0).duration(), 2.25, 1e-6);
  EXPECT_NEAR(turned_by(import, 0, 1.0, "Head"), 0.0, 1e-6);
}

/// A strip on two frames, of which the head turns from 0 to 90 degrees in 9600 ticks. (assimp reads "1,0" as 1.0.)
std::string tiny_x(const std::string& ticks) {
  const auto matrix = [](const std::string& y) {
    return "1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0," + y + ",0.0,1.0;; }\n";
  };
  const auto frame = [&](const std::string& name, const std::string& y) {
    return "Frame " + name + " {\nFrameTransformMatrix { " + matrix(y);
  };
  const auto weights = [&](const std::string& joint, const std::string& vertices, const std::string& down) {
    return "SkinWeights { \"" + joint + "\"; 2; " + vertices + "; 1.0,1.0; " + matrix(down);
  };
  return "xof 0303txt 0032\n" + ticks + frame("Root", "0.0") + frame("Hips", "1.0") + frame("Head", "0.5") + "} }\n" +
         frame("Body", "0.0") +
         "Mesh {\n4;\n-0.2;0.0;0.0;,\n0.2;0.0;0.0;,\n-0.2;1.7;0.0;,\n0.2;1.7;0.0;;\n2;\n3;0,2,1;,\n3;2,3,1;;\n"
         "XSkinMeshHeader { 1; 1; 2; }\n" +
         weights("Hips", "0,1", "-1.0") + weights("Head", "2,3", "-1.5") +
         "}\n} }\nAnimationSet Nod {\nAnimation {\n{Head}\nAnimationKey { 0; 2; "
         "0;4;1.0,0.0,0.0,0.0;;,9600;4;0.70710678,0.0,0.0,0.70710678;;; }\n}\n}\n";
}

TEST(ImportDirectX, WithoutTicksThereAre4800ASecond) {
  const Import import = import_character(write_text("tiny.x", tiny_x("")));
  ASSERT_EQ(import.clips.size(), 1u);
  EXPECT_EQ(import.clips[0].name, "Nod");
  EXPECT_NEAR(import.clips[0].duration(), 2.0, 1e-9);
  EXPECT_THAT(import.report.notes, Contains(HasSubstr("4800 ticks a second")));
  EXPECT_NEAR(turned_by(import, 0, 1.0, "Head"), 0.25 * 3.14159265, 1e-5);
}

TEST(ImportDirectX, WithTicksThereAreSoMany) {
  const Import import = import_character(write_text("tiny.x", tiny_x("AnimTicksPerSecond { 9600; }\n")));
  EXPECT_NEAR(import.clips.at(0).duration(), 1.0, 1e-9);
  EXPECT_THAT(import.report.notes, Not(Contains(HasSubstr("ticks"))));
}

} // namespace
