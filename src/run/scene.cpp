#include "src/run/scene.h"

#include "rig/error.h"

#include <cmath>
#include <fmt/format.h>

namespace tutu::app {

int frames_of(const Scene& scene) {
  const double frames = std::round(scene.motion.duration() * scene.settings.frames_per_second);
  if (!(frames <= k_most_frames))
    throw InputError(scene.file, "/motion", fmt::format("{:.6g} frames", frames),
                     fmt::format("at most {}", k_most_frames));
  return std::max(1, static_cast<int>(frames));
}

} // namespace tutu::app
