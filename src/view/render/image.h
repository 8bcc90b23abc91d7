// A picture in memory.
#pragma once

#include <cstdint>
#include <vector>

namespace tutu::app {

/// RGB, 8 bits, sRGB, top row first, rows without gaps: pixels.size() == 3 * width * height.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  const std::uint8_t* at(int x, int y) const {
    return pixels.data() +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

} // namespace tutu::app
