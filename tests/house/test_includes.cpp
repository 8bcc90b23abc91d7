// The house's rules about who may include whom.
#include "tests/support/paths.h"

#include <fstream>
#include <gmock/gmock.h>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using tutu::test::source_file;

namespace {

/// Folders in the data's own order; a file may include from its own folder and from those before it.
const std::vector<std::string> k_order = {"rig", "proxies", "cloth", "src"};

struct Include {
  fs::path file; ///< relative to the root
  std::string target;
};

std::vector<Include> includes_below(const std::string& folder) {
  static const std::regex k_include("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
  std::vector<Include> all;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source_file(folder))) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream in(entry.path());
    std::smatch match;
    for (std::string line; std::getline(in, line);)
      if (std::regex_search(line, match, k_include))
        all.push_back({fs::relative(entry.path(), source_file("")), match[1]});
  }
  return all;
}

/// "file includes target" for each include that runs against the order.
std::vector<std::string> against_order(const std::vector<Include>& includes, std::size_t rank) {
  std::vector<std::string> wrong;
  for (const Include& include : includes)
    for (std::size_t later = rank + 1; later < k_order.size(); ++later)
      if (include.target.starts_with(k_order[later] + "/"))
        wrong.push_back(include.file.string() + " includes " + include.target);
  return wrong;
}

TEST(House, NoIncludeRunsAgainstTheOrder) {
  for (std::size_t rank = 0; rank < k_order.size(); ++rank) {
    const auto includes = includes_below(k_order[rank]);
    EXPECT_FALSE(includes.empty()) << k_order[rank];
    EXPECT_THAT(against_order(includes, rank), ::testing::IsEmpty());
  }
}

TEST(House, TheOrderCheckSeesAWrongInclude) {
  EXPECT_THAT(against_order({{"rig/skin.cpp", "cloth/particles.h"}}, 0), ::testing::SizeIs(1));
  EXPECT_THAT(against_order({{"cloth/drape.cpp", "rig/math.h"}}, 2), ::testing::IsEmpty());
}

TEST(House, FclStaysBehindItsAdapter) {
  const std::set<std::string> adapter = {"proxies/broad_phase.cpp", "proxies/mesh_tree.cpp",
                                         "proxies/narrow_phase.cpp"};
  std::set<std::string> users;
  for (const std::string& folder : k_order)
    for (const Include& include : includes_below(folder))
      if (include.target.starts_with("fcl/") || include.target.starts_with("ccd/")) users.insert(include.file.string());
  EXPECT_EQ(users, adapter);
}

TEST(House, AssimpStaysBehindTheImporter) {
  for (const std::string& folder : k_order)
    for (const Include& include : includes_below(folder))
      if (include.target.starts_with("assimp/")) {
        EXPECT_THAT(include.file.string(), ::testing::StartsWith("rig/import")) << include.target;
      }
}

TEST(House, IncludesStartAtTheRoot) {
  for (const std::string& folder : k_order)
    for (const Include& include : includes_below(folder))
      EXPECT_FALSE(include.target.starts_with("..")) << include.file << " includes " << include.target;
}

} // namespace
