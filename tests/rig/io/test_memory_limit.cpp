#include "rig/io/bvh.h"
#include "rig/io/file_io.h"
#include "rig/io/json_file.h"
#include "rig/io/memory_limit.h"
#include "tests/support/paths.h"
#include "tests/support/peak_memory.h"

#include <functional>
#include <gmock/gmock.h>
#include <vector>

using namespace tutu;
using test::Variable;
using ::testing::HasSubstr;

namespace {

constexpr const char* k_variable = "TUTU_MEMORY_GIB";
constexpr double k_gib = 1024.0 * 1024.0 * 1024.0;

template <class Work> InputError error_of(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return {"", "", "", ""};
}

TEST(MemoryLimit, IsTwoGibUnlessTheVariableSaysMoreOrLess) {
  {
    const Variable none(k_variable, nullptr);
    EXPECT_EQ(memory_limit(), 2.0 * k_gib);
  }
  for (const auto& [text, gib] : {std::pair("3", 3.0), {"0.5", 0.5}, {"1e2", 100.0}}) {
    const Variable chosen(k_variable, text);
    EXPECT_EQ(memory_limit(), gib * k_gib) << text;
  }
  for (const char* text : {"", " ", "0", "-1", "nan", "inf", "1e999", "2 GiB", "1,5", "much"}) {
    const Variable chosen(k_variable, text);
    const InputError error = error_of([] { memory_limit(); });
    EXPECT_EQ(error.file(), "$TUTU_MEMORY_GIB") << text;
    EXPECT_EQ(error.found(), '"' + std::string(text) + '"');
    EXPECT_EQ(error.expected(), "a number of GiB above 0");
  }
}

TEST(MemoryLimit, SaysWhatWouldTakeHowMuchAndHowToAllowIt) {
  const Variable none(k_variable, nullptr);
  check_memory(2.0 * k_gib, "f", "/p", "a thing");
  const InputError error = error_of([] { check_memory(9.3 * k_gib, "f.json", "/shape/grid", "a garment"); });
  EXPECT_STREQ(error.what(), "f.json: /shape/grid: found a garment, about 9.3 GiB, expected at most 2 GiB; "
                             "TUTU_MEMORY_GIB=10 raises the limit");
  EXPECT_THAT(error_of([] { check_memory(1e300, "", "", "all"); }).what(), HasSubstr("GiB"));
  EXPECT_EQ(with_commas(0), "0");
  EXPECT_EQ(with_commas(999), "999");
  EXPECT_EQ(with_commas(1000), "1,000");
  EXPECT_EQ(with_commas(16777216), "16,777,216");
}

TEST(MemoryLimit, WhatRunsOutOfItIsToldOfTheFile) {
  EXPECT_EQ(within_memory("f", [] { return 5; }), 5);
  const std::function<void()> thrown[] = {[] { throw std::bad_alloc(); },
                                          [] { std::vector<int>().reserve(~std::size_t{0} / 2); }};
  for (const auto& work : thrown) {
    const InputError error = error_of([&] { within_memory("f.json", work); });
    EXPECT_EQ(error.file(), "f.json");
    EXPECT_THAT(error.found(), HasSubstr("memory"));
  }
  EXPECT_THROW(within_memory("f", [] { throw InputError("g", "", "", ""); }), InputError);
}

std::string repeated(const std::string& first, const std::string& value, int count, const std::string& last) {
  std::string text = first;
  for (int k = 0; k < count; ++k) text += (k > 0 ? "," : "") + value;
  return text + last;
}

TEST(MemoryLimit, JsonIsCountedBeforeItIsParsed) {
  const std::string text = repeated("[", "0", 1000000, "]");
  JsonValue::parse(text, "f.json");
  const Variable small(k_variable, "0.01");
  const InputError error = error_of([&] { JsonValue::parse(text, "f.json"); });
  EXPECT_EQ(error.file(), "f.json");
  EXPECT_THAT(error.found(), HasSubstr("JSON of 1,000,000 values, about 0.0"));
  EXPECT_THAT(error.expected(), HasSubstr("at most 0.01 GiB; TUTU_MEMORY_GIB=1 raises the limit"));
  // Separators in a string are none.
  JsonValue::parse("{\"a\": \"" + std::string(1000000, ',') + "\\\"" + std::string(1000000, '[') + "\"}", "f.json");
}

/// Time that grows with the square of the size would be hours here.
TEST(MemoryLimit, ManyObjectsAreReadInNoMoreTimeThanTheirTextIsWorth) {
  EXPECT_EQ(JsonValue::parse(repeated("[", "{}", 1000000, "]"), "f.json").items().size(), 1000000u);
}

/// What a text of a megabyte or some takes in truth, with a list of its items as readers make it, against the estimate.
TEST(MemoryLimit, TheEstimateOfJsonIsNotBelowTheTruth_slow) {
  std::string members = "{", keyed = "{";
  for (int k = 0; k < 400000; ++k) {
    members += (k > 0 ? ",\"" : "\"") + std::to_string(k) + "\":0";
    keyed += (k > 0 ? ",\"" : "\"") + std::string(30, 'k') + std::to_string(k) + "\":{\"rotation\":[0,0,0,1]}";
  }
  const std::string texts[] = {repeated("[", "0", 4000000, "]"),
                               repeated("[", "0.12345678901234567", 2000000, "]"),
                               repeated("[", "[0,0,0]", 800000, "]"),
                               repeated("[", "[]", 2000000, "]"),
                               repeated("[", "{}", 2000000, "]"),
                               repeated("[", "[[0]]", 800000, "]"),
                               repeated("[", R"({"a":0,"b":[1,2]})", 400000, "]"),
                               repeated("[", '"' + std::string(20, 's') + '"', 2000000, "]"),
                               members + "}",
                               keyed + "}"};
  for (const std::string& text : texts) {
    const double estimate = [&] {
      const Variable least(k_variable, "1e-6");
      const std::string found = error_of([&] { JsonValue::parse(text, "f.json"); }).found();
      return k_gib * std::stod(found.substr(found.find("about ") + 6));
    }();
    const double taken = test::peak_memory_of([&] {
      const JsonValue json = JsonValue::parse(text, "f.json");
      if (!json.is_array()) return (void)json.members();
      const auto items = json.items();
      for (const JsonValue& item : items)
        if (item.is_array()) (void)item.items();
    });
    std::printf("%-24.24s %6.1f MB of text take %7.1f MB, estimated %7.1f\n", text.c_str(),
                1e-6 * static_cast<double>(text.size()), 1e-6 * taken, 1e-6 * estimate);
    EXPECT_LE(taken, 1.05 * estimate) << text.substr(0, 40);
    EXPECT_GE(taken, estimate / 5.0) << text.substr(0, 40);
  }
}

TEST(MemoryLimit, ABvhWhoseFramesCostNothingToWriteIsRefused) {
  const auto folder = test::scratch_folder();
  std::string text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n";
  for (int k = 0; k < 200; ++k) text += "JOINT j" + std::to_string(k) + " { OFFSET 0 1 0 CHANNELS 0 }\n";
  write_file(folder / "a.bvh", text + "}\nMOTION\nFrames: 1000000\nFrame Time: 0.01\n");
  const InputError error = error_of([&] { rig::read_bvh(folder / "a.bvh"); });
  EXPECT_EQ(error.file(), (folder / "a.bvh").string());
  EXPECT_THAT(error.what(), HasSubstr("a skeleton without channels"));
  std::filesystem::remove_all(folder);
}

} // namespace
