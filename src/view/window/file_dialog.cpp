#include "src/view/window/file_dialog.h"

#include <algorithm>
#include <cctype>
#include <imgui.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

bool ends_in(std::string name, std::span<const std::string_view> extensions) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::any_of(extensions.begin(), extensions.end(), [&](std::string_view e) { return name.ends_with(e); });
}

} // namespace

std::vector<FolderEntry> list_folder(const fs::path& folder, std::span<const std::string_view> extensions) {
  std::vector<FolderEntry> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    std::error_code ignored; // of a link that leads nowhere
    FolderEntry found{entry.path().filename().string(), entry.is_directory(ignored)};
    if (!found.name.starts_with('.') && (found.is_folder || ends_in(found.name, extensions)))
      entries.push_back(std::move(found));
  }
  std::sort(entries.begin(), entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    return a.is_folder != b.is_folder ? a.is_folder : a.name < b.name;
  });
  return entries;
}

FileDialog::FileDialog(fs::path folder, std::span<const std::string_view> extensions)
    : folder_(std::move(folder)), extensions_(extensions) {}

void FileDialog::open() {
  open_ = true;
  go_to(folder_);
}

void FileDialog::go_to(const fs::path& folder) {
  try {
    const fs::path there = fs::canonical(folder);
    entries_ = list_folder(there, extensions_);
    folder_ = there;
    trouble_.clear();
  } catch (const fs::filesystem_error& error) {
    trouble_ = folder.string() + ": " + error.code().message();
  }
}

std::optional<fs::path> FileDialog::draw() {
  if (!open_) return {};
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(40 * em, 0.9f * screen.x), std::min(30 * em, 0.8f * screen.y)});
  ImGui::SetNextWindowBgAlpha(0.97f);
  std::optional<fs::path> chosen, go;
  if (ImGui::Begin("Open a scene or a character", &open_, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize)) {
    ImGui::TextUnformatted(folder_.c_str());
    if (!trouble_.empty()) ImGui::TextColored({0.75f, 0.18f, 0.08f, 1}, "%s", trouble_.c_str());
    ImGui::BeginChild("entries");
    if (folder_.has_relative_path() && ImGui::Selectable("..")) go = folder_.parent_path();
    for (const FolderEntry& entry : entries_) {
      const std::string label = entry.is_folder ? entry.name + "/" : entry.name;
      if (!ImGui::Selectable(label.c_str())) continue;
      (entry.is_folder ? go : chosen) = folder_ / entry.name;
    }
    if (entries_.empty()) ImGui::TextDisabled("nothing here that can be opened");
    ImGui::EndChild();
  }
  ImGui::End();
  if (go) go_to(*go);
  if (chosen) open_ = false;
  return chosen;
}

} // namespace tutu::app
