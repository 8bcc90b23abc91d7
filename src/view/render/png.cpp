#include "src/view/render/png.h"

#include "rig/io/file_io.h"

#include <stb_image_write.h>
#include <stdexcept>

namespace tutu::app {

std::string png_bytes(const Image& image) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  if (image.pixels.empty() ||
      stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.pixels.data(), 3 * image.width) == 0)
    throw std::runtime_error("the picture cannot be encoded as PNG");
  return bytes;
}

void write_png(const std::filesystem::path& file, const Image& image) {
  std::string bytes;
  try {
    bytes = png_bytes(image);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  write_file(file, bytes);
}

} // namespace tutu::app
