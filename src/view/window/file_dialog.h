// A file is looked for: a folder's content in a panel of the window.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tutu::app {

struct FolderEntry {
  std::string name;
  bool is_folder = false;
};

/// Folders first, each by name; of files those that end in one of `extensions` (".json", in any case). Nothing hidden.
/// Throws std::filesystem::filesystem_error for a folder that cannot be read.
std::vector<FolderEntry> list_folder(const std::filesystem::path& folder, std::span<const std::string_view> extensions);

class FileDialog {
public:
  /// `folder`: where it opens first. `extensions` must outlive it.
  FileDialog(std::filesystem::path folder, std::span<const std::string_view> extensions);

  void open();
  void close() { open_ = false; }
  bool is_open() const { return open_; }
  /// Between ImGui::NewFrame and Render. The file, once, when one was chosen; that closes it.
  std::optional<std::filesystem::path> draw();

private:
  void go_to(const std::filesystem::path& folder);

  std::filesystem::path folder_;
  std::span<const std::string_view> extensions_;
  std::vector<FolderEntry> entries_;
  std::string trouble_; ///< why the last folder could not be read
  bool open_ = false;
};

} // namespace tutu::app
