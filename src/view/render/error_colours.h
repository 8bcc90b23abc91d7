// Signed errors as colours, and the bar that says which colour is which.
#pragma once

#include "src/view/render/frame_view.h"
#include "src/view/render/image.h"

#include <array>
#include <string>
#include <vector>

namespace tutu::app {

/// Diverging, and told apart by all: white within the tolerance; blue where the proxies stick out of the skin
/// (negative), orange to dark red where the skin sticks out of them (positive). Both sides darken evenly, so that grey
/// print works. `error` in m; beyond `full` the last colour. sRGB, 0..1.
std::array<float, 3> error_srgb(const ErrorScale& scale, double error);

/// The same as a surface's colour.
Colour error_colour(const ErrorScale& scale, double error);

/// Where the bar has a label, m, rising, with the label in mm: "-40", "+10".
std::vector<std::pair<double, std::string>> error_ticks(const ErrorScale& scale);

/// What the bar's left and right half mean.
inline constexpr const char *k_over_caption = "proxies stick out", *k_under_caption = "skin sticks out";

/// Draws the labelled bar along the lower edge of a picture, as large as it can bear; leaves pictures alone that are
/// too small for a legible one.
void draw_error_bar(const ErrorScale& scale, Image& image);

} // namespace tutu::app
