// A character in motion and what it wears: everything of a scene that does not change while it plays, in memory.
#pragma once

#include "rig/motion.h"
#include "rig/text.h"
#include "src/run/wearer.h"

#include <filesystem>
#include <string>

namespace tutu::app {

struct Scene : Wearer {
  std::string file; ///< what messages call it; its stem is its name
  rig::Motion motion;

  /// For people, titles and files that are named after it; without control characters, whatever the file is called.
  std::string name() const { return plain_text(std::filesystem::path(file).stem().string()); }
};

/// Frames of once through the motion: 0 to this, which is the first pose again where it loops. Throws InputError for
/// more than k_most_frames.
int frames_of(const Scene& scene);

inline constexpr int k_most_frames = 10'000'000; // 46 hours of dance

} // namespace tutu::app
