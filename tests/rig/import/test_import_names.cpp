// Names of a foreign file: nothing behind the importer sees a control character or bytes that are not UTF-8.
#include "rig/import/import.h"
#include "rig/text.h"
#include "tests/rig/import/tiny_collada.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::test;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

namespace {

/// upright() with a clip, its joints and mesh called otherwise. The names are XML.
Import import_with(const std::string& hips, const std::string& head, const std::string& mesh = "body") {
  TinyFile file = upright();
  file.tracks = {{"Hips-1", {0, 1}, {moved(0, 1, 0), moved(1, 1, 0)}}, {"Head-2", {0, 1}, {moved(0, 1, 0), scaled(1)}}};
  std::string text = collada_text(file);
  const auto replace = [&](const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
      text.replace(at, what.size(), by);
  };
  replace("name=\"Hips\"", "name=\"" + hips + '"');
  replace("name=\"Head\"", "name=\"" + head + '"');
  replace("name=\"body\"", "name=\"" + mesh + '"');
  replace("<animation id=\"", "<animation name=\"" + mesh + "\" id=\"");
  return import_character(write_text("tiny.dae", text));
}

std::vector<std::string> texts_of(const Import& import) {
  std::vector<std::string> texts = import.character.skeleton.names;
  for (const MeshPart& part : import.character.mesh.parts) texts.push_back(part.name);
  for (const ChannelClip& clip : import.clips) texts.push_back(clip.name);
  texts.insert(texts.end(), import.report.notes.begin(), import.report.notes.end());
  texts.push_back(import.report.format);
  return texts;
}

TEST(ImportNames, PlainOnesStay) {
  const Import import = import_with("Hüfte", "頭 1");
  EXPECT_THAT(import.character.skeleton.names, ElementsAre("Hüfte", "頭 1", "HeadTop_End"));
  EXPECT_THAT(import.report.notes, IsEmpty());
}

TEST(ImportNames, OthersAreMadePlainAndNoted) {
  const Import import = import_with("a&#10;b", "caf\xe9", "bo&#27;dy");
  EXPECT_THAT(import.character.skeleton.names, ElementsAre("a_b", "caf_", "HeadTop_End"));
  ASSERT_EQ(import.clips.size(), 1u);
  EXPECT_EQ(import.clips[0].joints.size(), 2u);
  EXPECT_EQ(import.character.mesh.parts[0].name, "bo_dy");
  EXPECT_THAT(import.report.notes, Contains("4 names of joints, meshes or clips with control characters or bytes that "
                                            "are not UTF-8 got '_' in their place: a_b, caf_, bo_dy, bo_dy"));
}

TEST(ImportNames, WhatWasDifferentStaysDifferent) {
  EXPECT_THAT(import_with("x&#1;", "x&#2;").character.skeleton.names, ElementsAre("x_", "x__2", "HeadTop_End"));
  EXPECT_THAT(import_with("x&#1;", "x_").character.skeleton.names, ElementsAre("x__2", "x_", "HeadTop_End"));
  EXPECT_THAT(import_with("HeadTop_End", "HeadTop&#x7f;End").character.skeleton.names,
              Contains(::testing::StartsWith("HeadTop_End_")));
}

TEST(ImportNames, EveryByteInAName) {
  for (int byte = 1; byte < 256; ++byte) {
    if (byte == '"' || byte == '<' || byte == '&') continue; // XML's own
    const std::string name = "n" + std::string(1, static_cast<char>(byte)) + "m";
    const Import import = import_with(name, "Head");
    for (const std::string& text : texts_of(import)) EXPECT_TRUE(is_plain_text(text)) << byte << ' ' << text;
  }
}

} // namespace
