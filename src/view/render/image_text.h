// Words and boxes in a finished picture, without a graphics card.
#pragma once

#include "src/view/render/image.h"

#include <array>
#include <string_view>

namespace tutu::app {

inline constexpr int k_text_height = 13; ///< px of a line at zoom 1

/// Covers the part of a box that is in the picture with an sRGB colour; `strength` 1 hides what was there.
void blend_box(Image& image, int left, int top, int width, int height, const std::array<float, 3>& srgb,
               float strength);

/// ASCII in Dear ImGui's built-in bitmap font, `zoom` whole pixels a pixel of it; (left, top) of the line. What is
/// outside the picture is cut off.
void draw_text(Image& image, int left, int top, std::string_view text, int zoom, const std::array<float, 3>& srgb);

int text_width(std::string_view text, int zoom); ///< px

} // namespace tutu::app
