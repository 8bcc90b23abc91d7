// What the colours of a picture's overlays mean.
#pragma once

#include "src/view/render/frame_view.h"
#include "src/view/render/image.h"

#include <span>

namespace tutu::app {

std::array<float, 3> srgb_of(const Colour& linear);

/// Draws the entries as lines of a swatch and its text in the picture's upper left corner; leaves pictures alone that
/// are too small for a legible list.
void draw_legend(std::span<const LegendEntry> legend, Image& image);

/// In the middle of the picture's lower edge; leaves pictures alone that are too small.
void draw_caption(const std::string& caption, Image& image);

} // namespace tutu::app
