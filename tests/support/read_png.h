// Pictures back from disk, and how much of them differs.
#pragma once

#include "rig/io/file_io.h"
#include "src/view/render/image.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stb/stb_image.h>

namespace tutu::test {

inline std::optional<app::Image> read_png(const std::filesystem::path& file) {
  if (!exists(file)) return std::nullopt;
  const std::string bytes = read_file(file);
  int width = 0, height = 0, channels = 0;
  stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                          static_cast<int>(bytes.size()), &width, &height, &channels, 3);
  if (!pixels) return std::nullopt;
  app::Image image{.width = width, .height = height, .pixels = {}};
  image.pixels.assign(pixels, pixels + std::ptrdiff_t{3} * width * height);
  stbi_image_free(pixels);
  return image;
}

/// Share of the pixels whose channels differ by more than `seen` together. Pictures of one size.
inline double share_changed(const app::Image& a, const app::Image& b, int seen = 12) {
  int changed = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      int difference = 0;
      for (int c = 0; c < 3; ++c) difference += std::abs(a.at(x, y)[c] - b.at(x, y)[c]);
      changed += difference > seen;
    }
  return static_cast<double>(changed) / (a.width * a.height);
}

} // namespace tutu::test
