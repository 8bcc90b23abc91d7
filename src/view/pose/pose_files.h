// What the editor leaves on disk: the clip, its three texts, and the autosave of work that is in neither.
#pragma once

#include "src/view/pose/edit_document.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// "dance.json" -> dance.translations.txt, dance.rotations.txt, dance.times.txt beside it.
std::vector<std::filesystem::path> three_text_paths(const std::filesystem::path& clip_file);

/// Writes clip and texts (rig/io/clip_file.h). Throws InputError on a jump that cannot be, std::runtime_error when a file
/// cannot be written.
void write_pose_files(const EditState& state, const rig::Skeleton& skeleton, const std::filesystem::path& clip_file);

/// Work that is not in the files, kept beside them while there is any: a clip like any other, whose last key, called
/// "unsaved pose", is the pose in hand if that is in no key. Written whole or not at all (rig/io/file_io.h).
class Autosave {
public:
  explicit Autosave(const std::filesystem::path& clip_file);

  const std::filesystem::path& file() const { return file_; }
  /// What an earlier session left. One that cannot be read, or does not fit the skeleton, is put aside under a name of
  /// its own, which `trouble` tells with the reason: no work is locked out by it, and nothing of it is lost.
  std::optional<EditState> found(const rig::Skeleton& skeleton, std::string& trouble) const;
  /// Brings the file up to date with the document: written when dirty, else removed.
  void update(const EditDocument& document, const rig::Skeleton& skeleton) const;
  void remove() const;

private:
  std::filesystem::path file_;
};

} // namespace tutu::app
