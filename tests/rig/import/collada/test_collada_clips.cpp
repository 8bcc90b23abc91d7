// Which channels of a Collada file become which clip, and which node they move.
#include "rig/error.h"
#include "tests/rig/import/collada/collada_text.h"

#include <gmock/gmock.h>
#include <random>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::rig::import_detail;
using namespace tutu::test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace {

const std::string k_nodes =
    "<node id='root' name='Root'><node id='n1' sid='hips' name='Joint'>"
    "<translate sid='t'>0 1 0</translate><node sid='left.arm'><translate sid='t'>1 0 0</translate>"
    "</node></node><node id='n2' name='Joint'><translate sid='t.x'>2 0 0</translate></node></node>";
const std::map<std::string, int> k_node_of = {{"root", 0}, {"n1", 1}, {"left.arm", 2}, {"n2", 3}};

std::string moving(const std::string& target, const std::string& id, double from = 0.0, double to = 1.0) {
  return animation_text({target, {from, to}, {0, 1}}, id);
}
std::vector<FileAnimation> clips_of(const std::string& animations, const std::string& clips = {}) {
  return import_detail::animations(ColladaDocument("test.dae", motion_text(k_nodes, animations, clips)), k_node_of);
}
std::vector<int> moved_nodes(const FileAnimation& clip) {
  std::vector<int> nodes;
  for (const NodeMotion& motion : clip.nodes) nodes.push_back(motion.node);
  return nodes;
}

TEST(ColladaClips, TargetsAreIdsAndWaysOfSids) {
  EXPECT_THAT(moved_nodes(clips_of(moving("n2/t.x.X", "a"))[0]), ElementsAre(3));
  EXPECT_THAT(moved_nodes(clips_of(moving("root/hips/t.X", "a"))[0]), ElementsAre(1));
  EXPECT_THAT(moved_nodes(clips_of(moving("root/hips/left.arm/t.X", "a"))[0]), ElementsAre(2));
  EXPECT_THAT(moved_nodes(clips_of(moving("n1/left.arm/t(0)", "a"))[0]), ElementsAre(2));
}

TEST(ColladaClips, WhatIsNotThereIsNoted) {
  const auto clips = clips_of(moving("Joint/t.X", "a") + moving("n1/none.X", "b") + moving("n1/t.W", "c") +
                              moving("n1/t(3)", "d") + moving("n1/t.X", "e") + moving("n1", "f"));
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_THAT(moved_nodes(clips[0]), ElementsAre(1));
  EXPECT_THAT(
      clips[0].notes,
      ElementsAre("1 channel whose target is not in the file left out: Joint/t.X",
                  "4 channels on other things than a node's transform left out: n1/none.X, n1/t.W, n1/t(3), n1"));
}

TEST(ColladaClips, AnimationsInAnimationsAreOneClipWithoutMore) {
  const std::string nested = "<animation id='outer' name='Walk'>" + moving("n1/t.X", "a") + "<animation>" +
                             moving("n2/t.x.X", "b", 0.5, 3.0) + "</animation></animation>";
  auto clips = clips_of(nested);
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_EQ(clips[0].name, "Walk");
  EXPECT_THAT(moved_nodes(clips[0]), ElementsAre(1, 3));
  EXPECT_EQ(clips[0].end, 3.0);
  clips = clips_of(nested + moving("root/hips/left.arm/t.X", "c"));
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_EQ(clips[0].name, "");
  EXPECT_THAT(moved_nodes(clips[0]), ElementsAre(1, 2, 3));
  EXPECT_THAT(clips_of(""), IsEmpty());
}

TEST(ColladaClips, AnimationClipsAreClipsWithTheirNamesAndRanges) {
  const std::string animations = "<animation id='outer'>" + moving("n1/t.X", "a") + "</animation>" +
                                 moving("n2/t.x.X", "b", 0, 4) + moving("root/hips/left.arm/t.X", "c");
  const auto clips =
      clips_of(animations, "<library_animation_clips>"
                           "<animation_clip id='i' name='wave' start='0.5' end='2'>"
                           "<instance_animation url='#outer'/><instance_animation url='#b'/></animation_clip>"
                           "<animation_clip id='drop'><instance_animation url='#b'/>"
                           "<instance_animation url='#none'/></animation_clip>"
                           "<animation_clip id='late' start='5' end='1'><instance_animation url='#b'/>"
                           "</animation_clip></library_animation_clips>");
  ASSERT_EQ(clips.size(), 3u);
  EXPECT_EQ(clips[0].name, "wave");
  EXPECT_EQ(clips[0].start, 0.5);
  EXPECT_EQ(clips[0].end, 2.0);
  EXPECT_THAT(moved_nodes(clips[0]), ElementsAre(1, 3));
  EXPECT_THAT(clips[0].notes, IsEmpty());
  EXPECT_EQ(clips[1].name, "drop");
  EXPECT_EQ(clips[1].start, 0.0);
  EXPECT_EQ(clips[1].end, 4.0);
  EXPECT_THAT(clips[1].notes, ElementsAre("instance_animation #none is not in the file"));
  EXPECT_EQ(clips[2].start, 5.0);
  EXPECT_EQ(clips[2].end, 5.0);
  EXPECT_THAT(clips[2].notes, ElementsAre("the clip ends before it starts: read up to its last key",
                                          "1 channel in no clip left out: root/hips/left.arm/t.X"));
}

TEST(ColladaClips, SourcesAreSharedAndAccessorsHaveStridesAndOffsets) {
  const std::string shared = array_source("t", "float_array", "9 0 9 1 9 2", 3, 2, 1) +
                             array_source("v", "float_array", "0 5 7 9 6 7 9 8 7 9", 3, 3, 1);
  const auto sampler = [](const std::string& id, const std::string& target) {
    return "<sampler id='" + id + "'><input semantic='INPUT' source='#t'/><input semantic='OUTPUT' source='#v'/>" +
           "</sampler><channel source='#" + id + "' target='" + target + "'/>";
  };
  const auto clips = clips_of("<animation>" + shared + sampler("s1", "n1/t") + "</animation><animation>" +
                              sampler("s2", "n2/t.x.Y") + "</animation>");
  ASSERT_EQ(clips[0].nodes.size(), 2u);
  // A stride beyond the array's end gives the keys that are whole: refused, since the times are three.
  EXPECT_NEAR(value_at(clips[0].nodes[0].translation, 0.5).x(), 5.5, 1e-15);
  EXPECT_NEAR(value_at(clips[0].nodes[1].translation, 1.0).y(), 6.0, 1e-15);
}

TEST(ColladaClips, KeysThatAreNoneAreRefused) {
  const auto message = [](const TestChannel& channel) -> std::string {
    try {
      clips_of(animation_text(channel, "a"));
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message({"n1/t", {0, 1}, {0, 0, 0, 1, 1, 1}}), "");
  EXPECT_EQ(message({"n1/t", {0, 1}, {0, 0, 0, 1}}),
            "test.dae: channel n1/t: found 2 keys of 2 at 2 times, expected a key of 3 at each time");
  EXPECT_THAT(message({"n1/t.X", {1, 0}, {0, 1}}), HasSubstr("key times that fall"));
  EXPECT_THAT(message({"n1/t.X", {0, 1}, {0, std::nan("")}}), HasSubstr("found key nan, expected finite numbers"));
  EXPECT_THAT(message({"n1/t.X", {0, 1}, {0, 1e300}}), HasSubstr("found key 1"));
  EXPECT_THAT(message({"n1/t.X", {0, INFINITY}, {0, 1}}), HasSubstr("found key time inf"));
  EXPECT_THAT(message({"n1/t.X", {0, 1}, {0, 1}, {"BEZIER"}, {0, std::nan("")}, {std::nan(""), 0}}), ""); // never used
}

TEST(ColladaClips, NamesForPeople) {
  const ColladaDocument document("test.dae", motion_text(k_nodes + "<node name='nobody'/>", ""));
  EXPECT_THAT(display_names(document), ElementsAre(std::pair("left.arm", "left.arm"), std::pair("n1", "Joint"),
                                                   std::pair("n2", "Joint"), std::pair("root", "Root")));
}

TEST(ColladaDocuments, OtherTextIsRefusedWithALine) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      const ColladaDocument document("test.dae", text);
      display_names(document);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(message("<COLLADA>\n<a>\n</b></COLLADA>"),
              HasSubstr("test.dae: line 3: found a file that cannot be read"));
  EXPECT_THAT(message(""), HasSubstr("line 1: found"));
  EXPECT_EQ(message("<?xml version='1.0'?><!DOCTYPE x [<!ENTITY a 'b'><!ENTITY c SYSTEM '/etc/passwd'>]>"
                    "<COLLADA><a b='&c;'>&a;</a></COLLADA>"),
            "");
  EXPECT_EQ(message("<x/>"), "");
  std::string deep, text;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_THAT(message("<COLLADA>" + deep), HasSubstr("cannot be read"));
  text = "<COLLADA>" + deep;
  for (int i = 0; i < 100'000; ++i) text += "</a>";
  EXPECT_THAT(message(text + "</COLLADA>"), HasSubstr("more than 1000 deep"));
}

TEST(ColladaDocuments, NumbersGoOnBehindAComment) {
  std::string text = motion_text(k_nodes, moving("n1/t.X", "a"));
  const std::size_t at = text.find(">0 1</float_array>", text.find("a-v-a"));
  text.replace(at, 4, ">0<!-- and --> <![CDATA[5]]>");
  const auto clips = import_detail::animations(ColladaDocument("test.dae", text), k_node_of);
  EXPECT_EQ(value_at(clips.at(0).nodes.at(0).translation, 1).x(), 5);
}

TEST(ColladaDocuments, AnArrayOfASkinIsThereOnce) {
  const auto message = [](const std::string& more) -> std::string {
    const std::string weights = "<float_array id='wa'>1 0.5</float_array>";
    try {
      check_skins(
          ColladaDocument("test.dae", "<COLLADA><controller><skin source='#body'><source id='j'><Name_array "
                                      "id='ja'>a b</Name_array></source><source id='w'>" +
                                          weights +
                                          "<technique_common><accessor source='#wa' count='2'/></technique_common>"
                                          "</source><vertex_weights><input semantic='JOINT' source='#j' "
                                          "offset='0'/><input semantic='WEIGHT' source='#w' offset='1'/><v>0 0 1 "
                                          "1</v></vertex_weights></skin></controller>" +
                                          more + "</COLLADA>"));
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message(""), "");
  EXPECT_EQ(message("<float_array id='wa'>1 -0.5</float_array>"),
            "test.dae: skin of #body: found two elements of the id wa, expected ids of their own");
}

TEST(ColladaDocuments, DamagedAnywhereTheyAreReadOrRefused) {
  const std::string whole = motion_text(
      k_nodes,
      animation_text({"n1/t", {0, 1}, {0, 0, 0, 1, 1, 1}, {"BEZIER"}, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1}}, "a") +
          moving("n2/t.x.X", "b"),
      "<library_animation_clips><animation_clip id='c' end='1'><instance_animation url='#a'/>"
      "</animation_clip></library_animation_clips>");
  ASSERT_TRUE(whole.ends_with(">\n"));
  int read = 0, refused = 0;
  const auto attempt = [&](const std::string& text) {
    try {
      const ColladaDocument document("test.dae", text);
      import_detail::animations(document, k_node_of);
      ++read;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++refused;
    }
  };
  for (std::size_t size = 0; size + 1 < whole.size(); size += 7) attempt(whole.substr(0, size));
  EXPECT_EQ(read, 0);
  refused = 0;
  std::mt19937_64 random(7);
  for (int i = 0; i < 3000; ++i) {
    std::string text = whole;
    for (int flips = 1 + i % 3; flips > 0; --flips) {
      char& byte = text[random() % text.size()];
      byte = static_cast<char>(byte ^ static_cast<char>(1 + random() % 127));
    }
    attempt(text);
  }
  EXPECT_GT(read, 300); // the flips do damage, but not only
  EXPECT_GT(refused, 300);
}

} // namespace
