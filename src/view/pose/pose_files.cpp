#include "src/view/pose/pose_files.h"

#include "rig/io/clip_file.h"

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_unsaved_pose = "unsaved pose";

fs::path beside(const fs::path& clip_file, const char* ending) {
  return clip_file.parent_path() / (clip_file.stem().string() + ending);
}

/// "x.autosave.json" -> "x.autosave.damaged-1.json", or the first after it that is not taken.
fs::path free_name(const fs::path& file) {
  std::error_code error;
  for (int n = 1;; ++n) {
    const fs::path name = fs::path(file).replace_extension(".damaged-" + std::to_string(n) + ".json");
    if (!fs::exists(name, error)) return name;
  }
}

} // namespace

std::vector<fs::path> three_text_paths(const fs::path& clip_file) {
  return {beside(clip_file, ".translations.txt"), beside(clip_file, ".rotations.txt"), beside(clip_file, ".times.txt")};
}

void write_pose_files(const EditState& state, const rig::Skeleton& skeleton, const fs::path& clip_file) {
  const rig::RawClip clip = raw_clip(state, skeleton);
  (void)rig::build_clip(clip, skeleton); // what cannot be played is not written
  const auto texts = three_text_paths(clip_file);
  rig::write_clip(clip, clip_file);
  rig::write_three_texts(clip, skeleton, {texts[0], texts[1], texts[2], std::nullopt});
}

Autosave::Autosave(const fs::path& clip_file) : file_(beside(clip_file, ".autosave.json")) {}

std::optional<EditState> Autosave::found(const rig::Skeleton& skeleton, std::string& trouble) const {
  std::error_code error;
  if (!fs::exists(file_, error)) return std::nullopt;
  EditState state;
  try {
    state = edit_state(rig::read_clip(file_), skeleton);
  } catch (const std::runtime_error& problem) {
    const fs::path aside = free_name(file_);
    fs::rename(file_, aside, error);
    trouble = std::string(problem.what()) + (error ? "; it stays where it is" : "; put aside as " + aside.string());
    return std::nullopt;
  }
  if (state.keys.back().name != k_unsaved_pose) return state;
  state.pose = *state.keys.back().pose;
  state.loose = true;
  state.keys.pop_back();
  state.time = state.keys.empty() ? 0.0 : state.keys.back().time;
  return state;
}

void Autosave::update(const EditDocument& document, const rig::Skeleton& skeleton) const {
  if (!document.dirty()) return remove();
  EditState state = document.state();
  if (state.loose) {
    const double time = state.keys.empty() ? 0.0 : state.keys.back().time + 1.0;
    state.keys.push_back({time, k_unsaved_pose, false, std::make_shared<const Pose>(state.pose)});
  }
  if (state.keys.empty()) return remove(); // all that is unsaved is that the keys are gone
  rig::write_clip(raw_clip(state, skeleton), file_);
}

void Autosave::remove() const {
  std::error_code ignored;
  fs::remove(file_, ignored);
}

} // namespace tutu::app
