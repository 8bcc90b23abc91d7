#include "src/view/render/error_colours.h"

#include "src/view/render/image_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>

namespace tutu::app {
namespace {

using Rgb = std::array<float, 3>;

struct Stop {
  float at; ///< 0 at the tolerance, 1 at the full error
  Rgb colour;
};

// After ColorBrewer's RdBu, the red shifted towards orange: safe for all three kinds of colour blindness.
constexpr Stop k_under[] = {{0.0f, {0.99f, 0.88f, 0.76f}},
                            {0.35f, {0.96f, 0.60f, 0.30f}},
                            {0.7f, {0.80f, 0.28f, 0.08f}},
                            {1.0f, {0.45f, 0.08f, 0.06f}}};
constexpr Stop k_over[] = {{0.0f, {0.84f, 0.91f, 0.96f}},
                           {0.35f, {0.52f, 0.73f, 0.88f}},
                           {0.7f, {0.16f, 0.45f, 0.71f}},
                           {1.0f, {0.03f, 0.16f, 0.40f}}};
constexpr Rgb k_within = {0.97f, 0.97f, 0.97f};

Rgb along(std::span<const Stop> stops, float at) {
  for (std::size_t k = 1; k < stops.size(); ++k) {
    if (at > stops[k].at) continue;
    const float s = (at - stops[k - 1].at) / (stops[k].at - stops[k - 1].at);
    Rgb result;
    for (std::size_t c = 0; c < 3; ++c) result[c] = (1 - s) * stops[k - 1].colour[c] + s * stops[k].colour[c];
    return result;
  }
  return stops.back().colour;
}

float linear_of(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }

} // namespace

std::array<float, 3> error_srgb(const ErrorScale& scale, double error) {
  const double size = std::abs(error);
  if (!(size > scale.tolerance)) return k_within;
  const double at = (size - scale.tolerance) / (scale.full - scale.tolerance);
  return along(error > 0.0 ? k_under : k_over, static_cast<float>(std::min(1.0, at)));
}

Colour error_colour(const ErrorScale& scale, double error) {
  const Rgb srgb = error_srgb(scale, error);
  return {linear_of(srgb[0]), linear_of(srgb[1]), linear_of(srgb[2])};
}

std::vector<std::pair<double, std::string>> error_ticks(const ErrorScale& scale) {
  std::vector<std::pair<double, std::string>> ticks;
  for (const double value : {-scale.full, -scale.tolerance, 0.0, scale.tolerance, scale.full})
    ticks.emplace_back(value, value == 0.0 ? "0" : fmt::format("{:+.3g}", 1000.0 * value));
  ticks.back().second += " mm";
  return ticks;
}

void draw_error_bar(const ErrorScale& scale, Image& image) {
  constexpr int k_least_width = 300,
                k_least_height = 200; // px: two captions side by side, and something beside the bar
  if (image.width < k_least_width || image.height < k_least_height) return;
  const int zoom = std::max(1, std::min(image.width / 520, image.height / 420));
  const int line = zoom * k_text_height, margin = 8 * zoom, height = 14 * zoom;
  const int width = std::min(image.width - 6 * margin, 460 * zoom);
  const int left = (image.width - width) / 2, top = image.height - margin - line - height;

  const Rgb backing = {1.0f, 1.0f, 1.0f}, ink = {0.13f, 0.15f, 0.19f};
  blend_box(image, left - 2 * margin, top - line - margin, width + 4 * margin, 2 * line + height + 2 * margin, backing,
            0.82f);
  for (int x = 0; x < width; ++x) {
    const double error = scale.full * (2.0 * (x + 0.5) / width - 1.0);
    blend_box(image, left + x, top, 1, height, error_srgb(scale, error), 1.0f);
  }
  blend_box(image, left, top, width, 1, ink, 0.6f);
  blend_box(image, left, top + height - 1, width, 1, ink, 0.6f);
  draw_text(image, left, top - line, k_over_caption, zoom, ink);
  draw_text(image, left + width - text_width(k_under_caption, zoom), top - line, k_under_caption, zoom, ink);
  for (const auto& [value, label] : error_ticks(scale)) {
    const int x = left + static_cast<int>(std::lround(0.5 * (1.0 + value / scale.full) * (width - 1)));
    blend_box(image, x, top, 1, height + 2 * zoom, ink, 0.8f);
    const int wide = text_width(label, zoom), first = left - 2 * margin + zoom;
    const int text = std::clamp(x - wide / 2, first, left + width + 2 * margin - zoom - wide);
    draw_text(image, text, top + height + zoom, label, zoom, ink);
  }
}

} // namespace tutu::app
