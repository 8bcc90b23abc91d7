// Pictures on disk.
#pragma once

#include "src/render/image.h"

#include <filesystem>

namespace tutu::app {

/// Writes a whole PNG or leaves `file` as it was. Throws std::runtime_error.
void write_png(const std::filesystem::path& file, const Image& image);

} // namespace tutu::app
