// The colours of the overlays.
#pragma once

#include "src/view/render/frame_view.h"

namespace tutu::app {

// Colour-blind safe [Okabe and Ito 2008], in linear RGB.
inline constexpr Colour k_black = {0.0f, 0.0f, 0.0f};
inline constexpr Colour k_grey = {0.4f, 0.4f, 0.4f};
inline constexpr Colour k_orange = {0.791f, 0.347f, 0.0f};
inline constexpr Colour k_sky = {0.093f, 0.457f, 0.815f};
inline constexpr Colour k_green = {0.0f, 0.342f, 0.171f};
inline constexpr Colour k_yellow = {0.871f, 0.776f, 0.054f};
inline constexpr Colour k_blue = {0.0f, 0.168f, 0.445f};
inline constexpr Colour k_vermilion = {0.665f, 0.112f, 0.0f};
inline constexpr Colour k_purple = {0.604f, 0.191f, 0.386f};

} // namespace tutu::app
