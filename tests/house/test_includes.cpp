// The house's rules: who may include whom, what is whose own, and that a name says one thing.
#include "tests/support/paths.h"

#include <algorithm>
#include <fstream>
#include <gmock/gmock.h>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using tutu::test::source_file;

namespace {

/// Every folder of the house from the ground up; those of one row stand beside each other. A file may include from its
/// own folder and from those of rows below.
const std::vector<std::vector<std::string>> k_rows = {
    {"rig/detail"},
    {"rig"},
    {"rig/io/detail"},
    {"rig/io"},
    {"rig/import/detail", "rig/mannequin/detail"},
    {"rig/import/curves"},
    {"rig/import/gltf", "rig/import/collada", "rig/import/fbx"},
    {"rig/import/assimp"},
    {"rig/import", "rig/mannequin"},
    {"proxies/detail"},
    {"proxies"},
    {"proxies/distance"},
    {"proxies/motion"},
    {"proxies/crossing/detail"},
    {"proxies/crossing"},
    {"proxies/body/detail"},
    {"proxies/body"},
    {"proxies/query/detail"},
    {"proxies/query", "proxies/validate"},
    {"proxies/fit/detail"},
    {"proxies/fit"},
    {"cloth/state"},
    {"cloth/garment/detail"},
    {"cloth/garment"},
    {"cloth/contact", "cloth/air"},
    {"cloth/woven"},
    {"cloth/detail"},
    {"cloth"},
    {"src/base"},
    {"src/run"},
    {"src/scene"},
    {"src/measure"},
    {"src/study/report", "src/view/render"},
    {"src/study/bench", "src/study/chart", "src/view/show"},
    {"src/study/stability", "src/study/plan", "src/view/window"},
    {"src/view/play", "src/view/pose"},
    {"src/view/proxy_edit"},
    {"src/options"},
    {"src/commands"},
    {"src"},
};

/// A folder that is its parent's own: named `detail`, or the kernels of woven cloth. Only what is below the parent may
/// include from it, and the two may include each other.
bool is_private(const std::string& folder) { return folder.ends_with("/detail") || folder == "cloth/woven"; }

/// The row of a folder; -1 for none.
int row_of(const std::string& folder) {
  for (std::size_t row = 0; row < k_rows.size(); ++row)
    if (std::count(k_rows[row].begin(), k_rows[row].end(), folder)) return static_cast<int>(row);
  return -1;
}

std::string parent_of(const std::string& path) { return fs::path(path).parent_path().string(); }

/// The header that explains a library on one page; it names all of the library, and nothing of the house reads it.
bool is_umbrella(const std::string& file) {
  return file == "rig/rig.h" || file == "proxies/proxies.h" || file == "cloth/cloth.h";
}

struct Include {
  std::string file; ///< from the root
  std::string target;
};

std::vector<std::string> sources() {
  std::vector<std::string> files;
  for (const char* top : {"rig", "proxies", "cloth", "src"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source_file(top)))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
        files.push_back(fs::relative(entry.path(), source_file("")).generic_string());
  std::sort(files.begin(), files.end());
  return files;
}

std::string text_of(const std::string& file) {
  std::ifstream in(source_file(file));
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

const std::vector<Include>& includes() {
  static const std::vector<Include> all = [] {
    const std::regex include("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
    std::vector<Include> found;
    for (const std::string& file : sources()) {
      std::ifstream in(source_file(file));
      std::smatch match;
      for (std::string line; std::getline(in, line);)
        if (std::regex_search(line, match, include)) found.push_back({file, match[1]});
    }
    return found;
  }();
  return all;
}

/// What is wrong with an include inside the house; "" for nothing.
std::string fault_of(const Include& include) {
  if (row_of(parent_of(include.target)) < 0 || is_umbrella(include.file)) return "";
  const std::string from = parent_of(include.file), to = parent_of(include.target);
  const std::string told = include.file + " includes " + include.target;
  if (is_private(to) && !(from + "/").starts_with(parent_of(to) + "/"))
    return told + ", which is private to " + parent_of(to);
  const bool family =
      from == to || (is_private(from) && parent_of(from) == to) || (is_private(to) && parent_of(to) == from);
  if (family || row_of(to) < row_of(from)) return "";
  return told + ", which is " + (row_of(to) == row_of(from) ? "beside it" : "above it");
}

TEST(House, EveryFolderHasAFloor) {
  std::set<std::string> unknown;
  for (const std::string& file : sources())
    if (row_of(parent_of(file)) < 0) unknown.insert(parent_of(file));
  EXPECT_THAT(unknown, ::testing::IsEmpty());
}

TEST(House, NoIncludeRunsUpOrAround) {
  std::vector<std::string> faults;
  int inside = 0;
  for (const Include& include : includes()) {
    inside += row_of(parent_of(include.target)) >= 0;
    if (const std::string fault = fault_of(include); !fault.empty()) faults.push_back(fault);
  }
  EXPECT_GT(inside, 500);
  EXPECT_THAT(faults, ::testing::IsEmpty());
}

TEST(House, TheFloorCheckSeesAWrongInclude) {
  EXPECT_THAT(fault_of({"rig/skin.cpp", "cloth/solver.h"}), ::testing::HasSubstr("above"));
  EXPECT_THAT(fault_of({"src/study/chart/row.cpp", "src/view/show/why.h"}), ::testing::HasSubstr("beside"));
  EXPECT_THAT(fault_of({"src/run/session.cpp", "src/scene/load.h"}), ::testing::HasSubstr("above"));
  EXPECT_THAT(fault_of({"src/run/session.cpp", "cloth/woven/sheet.h"}), ::testing::HasSubstr("private"));
  EXPECT_THAT(fault_of({"cloth/solver.cpp", "proxies/fit/detail/model.h"}), ::testing::HasSubstr("private"));
  EXPECT_EQ(fault_of({"cloth/solver.cpp", "rig/math.h"}), "");
  EXPECT_EQ(fault_of({"proxies/fit/detail/model.cpp", "proxies/fit/fit.h"}), "");
  EXPECT_EQ(fault_of({"proxies/fit/fit.cpp", "proxies/fit/detail/model.h"}), "");
}

TEST(House, NobodyInsideReadsAnUmbrella) {
  for (const Include& include : includes()) EXPECT_FALSE(is_umbrella(include.target)) << include.file;
}

TEST(House, IncludesStartAtTheRoot) {
  for (const Include& include : includes())
    EXPECT_FALSE(include.target.starts_with("..")) << include.file << " includes " << include.target;
}

TEST(House, FclStaysBehindItsAdapter) {
  const std::set<std::string> adapter = {"proxies/body/detail/mesh_tree.cpp", "proxies/query/detail/broad_phase.cpp",
                                         "proxies/query/detail/narrow_phase.cpp"};
  std::set<std::string> users;
  for (const Include& include : includes())
    if (include.target.starts_with("fcl/") || include.target.starts_with("ccd/")) users.insert(include.file);
  EXPECT_EQ(users, adapter);
}

TEST(House, AssimpStaysBehindTheImporter) {
  for (const Include& include : includes())
    if (include.target.starts_with("assimp/")) {
      EXPECT_THAT(include.file, ::testing::StartsWith("rig/import/"));
    }
}

TEST(House, OpenGlAndWindowsStayInTheView) {
  for (const Include& include : includes())
    for (const char* drawing : {"epoxy/", "GLFW/", "EGL/", "imgui", "backends/imgui"})
      if (include.target.starts_with(drawing)) {
        EXPECT_THAT(include.file, ::testing::StartsWith("src/view/")) << include.target;
      }
}

// ---- a name says one thing

/// Types that a file defines at the level of its namespaces, as "namespace::Name"; what is in a nameless namespace is
/// the file's own and left out. Good for this house's layout: definitions that begin a line at column 0.
std::vector<std::string> types_defined(const std::string& text) {
  static const std::regex opens("^namespace ([A-Za-z_:]*) ?\\{"), closes("^\\} // namespace"),
      type("^(?:struct|class|enum class|enum|union) ([A-Za-z_]\\w*)(?: final)?(?: :[^;]*)? ?\\{");
  std::vector<std::string> spaces, found;
  std::istringstream in(text);
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_search(line, match, opens)) spaces.push_back(match[1]);
    else if (std::regex_search(line, closes) && !spaces.empty()) spaces.pop_back();
    else if (std::regex_search(line, match, type)) {
      if (std::count(spaces.begin(), spaces.end(), "")) continue;
      std::string name;
      for (const std::string& space : spaces) name += space + "::";
      found.push_back(name + match[1].str());
    }
  }
  return found;
}

TEST(House, NoTwoTypesOfOneName) {
  std::map<std::string, std::vector<std::string>> files_of;
  for (const std::string& file : sources())
    for (const std::string& type : types_defined(text_of(file))) files_of[type].push_back(file);
  EXPECT_GT(files_of.size(), 200u);
  for (const auto& [type, files] : files_of)
    EXPECT_EQ(files.size(), 1u) << type << " in " << ::testing::PrintToString(files);
}

TEST(House, TheNameCheckSeesTypes) {
  EXPECT_THAT(types_defined("namespace tutu::app {\nstruct A {\n  struct B {};\n};\nenum class C : int {\n"
                            "namespace {\nclass D {\n} // namespace\nclass E final : public A {\nstruct F;\n}"),
              ::testing::ElementsAre("tutu::app::A", "tutu::app::C", "tutu::app::E"));
}

} // namespace
