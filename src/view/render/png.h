// Pictures on disk.
#pragma once

#include "src/view/render/image.h"

#include <filesystem>
#include <string>

namespace tutu::app {

/// The bytes of a PNG file. Throws std::runtime_error for a picture without pixels.
std::string png_bytes(const Image& image);

/// Writes a whole PNG or leaves `file` as it was. Throws std::runtime_error.
void write_png(const std::filesystem::path& file, const Image& image);

} // namespace tutu::app
