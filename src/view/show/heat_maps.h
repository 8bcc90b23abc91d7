// Pictures of the skin in the colours of its error, for reports.
#pragma once

#include "src/measure/heat_map.h"
#include "src/run/scene.h"
#include "src/view/render/frame_view.h"

#include <functional>
#include <string>
#include <vector>

namespace tutu::app {

/// The body in each of these frames, from the front and from the back of where it faces at rest, without garments; each
/// picture with its colour bar. Empty, and `why` says why, where nothing can be drawn. `go_on()` false stops after the
/// picture at hand.
std::vector<HeatMap> heat_maps(const Scene& scene, const std::vector<int>& frames, const ErrorScale& scale,
                               const std::function<bool()>& go_on, std::string& why);

} // namespace tutu::app
