// Where in a motion the proxies are the worst.
#pragma once

#include "src/run/scene.h"

#include <functional>
#include <optional>

namespace tutu::app {

/// The frame of the motion in which the skin sticks out of the proxies the most: by the 95th percentile over vertices
/// of how far each does. None without proxies, or when `progress(done, total)` returned false.
std::optional<int> worst_frame(const Scene& scene, const std::function<bool(int, int)>& progress);

} // namespace tutu::app
