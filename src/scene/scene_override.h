// One setting of a scene changed by a word: "substeps=4".
#pragma once

#include "src/scene/scene_file.h"

#include <string>

namespace tutu::app {

/// KEY=VALUE with the keys of a scene's solver and collision (name of the solver: "solver"), or proxies=FILE, or
/// proxies=none. Throws InputError, naming `option`, for any other key and for values that do not fit.
void override_setting(SceneDescription& description, const std::string& assignment, const std::string& option);

} // namespace tutu::app
