// The dialog's list of a folder, and the dialog in the window.
#include "rig/io/file_io.h"
#include "src/view/window/file_dialog.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

std::vector<std::string> names(const std::vector<FolderEntry>& entries) {
  std::vector<std::string> all;
  for (const FolderEntry& entry : entries) all.push_back(entry.name + (entry.is_folder ? "/" : ""));
  return all;
}

TEST(FileDialog, ListsFoldersThenWhatCanBeOpened) {
  const fs::path folder = test::scratch_folder();
  constexpr std::string_view k_extensions[] = {".json", ".dae"};
  for (const char* file : {"walk.json", "Body.DAE", "notes.txt", ".hidden.json", "json"}) write_file(folder / file, "");
  for (const char* inner : {"zebra", "assets", ".git"}) fs::create_directories(folder / inner);
  fs::create_symlink(folder / "nowhere", folder / "broken.json");
  EXPECT_THAT(names(list_folder(folder, k_extensions)),
              ElementsAre("assets/", "zebra/", "Body.DAE", "broken.json", "walk.json"));
  EXPECT_THAT(names(list_folder(folder / "zebra", k_extensions)), ElementsAre());
  EXPECT_THROW(list_folder(folder / "missing", k_extensions), fs::filesystem_error);
  fs::remove_all(folder);
}

} // namespace
} // namespace tutu::app
