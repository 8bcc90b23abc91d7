// Seeds of the fuzz targets through the targets themselves: neither may rot, and no clang is needed.
#include "rig/error.h"
#include "tests/fuzz/target.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <vector>

namespace fs = std::filesystem;
using namespace tutu;
using namespace tutu::fuzz;

namespace {

struct Target {
  const char* name;
  void (*run)(std::string_view input);
};

const std::vector<Target> k_targets = {
    {"answer", fuzz_answer},
    {"autosave", fuzz_autosave},
    {"bvh", fuzz_bvh},
    {"clip", fuzz_clip},
    {"collada", fuzz_collada},
    {"drape", fuzz_drape},
    {"fbx", fuzz_fbx},
    {"garment", fuzz_garment},
    {"gltf", fuzz_gltf},
    {"joint_limits", fuzz_joint_limits},
    {"proxies", fuzz_proxies},
    {"reference", fuzz_reference},
    {"results", fuzz_results},
    {"scene", fuzz_scene},
    {"settings", fuzz_settings},
    {"three_texts", fuzz_three_texts},
};

/// Of one target, in the order of their names.
std::vector<fs::path> seeds_of(const std::string& target) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::source_file("tests/fuzz/seeds/" + target)))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class FuzzSeeds : public ::testing::TestWithParam<Target> {};

TEST_P(FuzzSeeds, AreReadOrRefusedAsTheirNamesSay) {
  int read = 0;
  for (const fs::path& seed : seeds_of(GetParam().name)) {
    SCOPED_TRACE(seed);
    const bool is_bad = seed.filename().string().starts_with("bad-");
    try {
      GetParam().run(text_of(seed));
      read += !is_bad;
      EXPECT_FALSE(is_bad) << "it is read";
    } catch (const InputError& error) {
      EXPECT_TRUE(is_bad) << error.what();
    }
  }
  EXPECT_GT(read, 0);
}

TEST_P(FuzzSeeds, CutAnywhereTheyAreReadOrRefused) {
  for (const fs::path& seed : seeds_of(GetParam().name)) {
    const std::string whole = text_of(seed);
    const std::size_t step = 1 + whole.size() / 100;
    for (std::size_t size = 0; size < whole.size(); size += step) try {
        GetParam().run(whole.substr(0, size));
      } catch (const InputError&) {
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzSeeds, ::testing::ValuesIn(k_targets),
                         [](const auto& target) { return std::string(target.param.name); });

TEST(FuzzTargets, EveryFolderOfSeedsHasOne) {
  std::vector<std::string> folders, names;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::source_file("tests/fuzz/seeds")))
    folders.push_back(entry.path().filename().string());
  for (const Target& target : k_targets) names.emplace_back(target.name);
  EXPECT_THAT(folders, ::testing::UnorderedElementsAreArray(names));
}

} // namespace
