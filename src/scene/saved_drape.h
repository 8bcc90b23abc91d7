// The drape that is kept beside a scene.
#pragma once

#include "src/scene/load.h"

namespace tutu::app {

/// The scene's drape file when it is there and fits; nothing otherwise (a file of another scene state is `stale`).
/// Throws InputError on a broken file.
std::optional<GarmentPositions> saved_drape(const LoadedScene& scene, bool* stale);

} // namespace tutu::app
