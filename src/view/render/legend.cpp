#include "src/view/render/legend.h"

#include "src/view/render/image_text.h"

#include <algorithm>
#include <cmath>

namespace tutu::app {

std::array<float, 3> srgb_of(const Colour& linear) {
  std::array<float, 3> result{};
  std::transform(linear.begin(), linear.end(), result.begin(),
                 [](float c) { return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f; });
  return result;
}

namespace {

constexpr std::array<float, 3> k_paper = {1.0f, 1.0f, 1.0f}, k_ink = {0.13f, 0.15f, 0.19f};

bool is_large(const Image& image) { return image.width >= 300 && image.height >= 200; }

int zoom_of(const Image& image) { return std::max(1, std::min(image.width / 640, image.height / 480)); }

} // namespace

void draw_caption(const std::string& caption, Image& image) {
  if (caption.empty() || !is_large(image)) return;
  const int zoom = zoom_of(image), margin = 6 * zoom, height = zoom * k_text_height + margin;
  const int width = text_width(caption, zoom), left = (image.width - width) / 2, top = image.height - margin - height;
  blend_box(image, left - margin, top, width + 2 * margin, height, k_paper, 0.82f);
  draw_text(image, left, top + margin / 2, caption, zoom, k_ink);
}

void draw_legend(std::span<const LegendEntry> legend, Image& image) {
  if (legend.empty() || !is_large(image)) return;
  const int zoom = zoom_of(image);
  const int line = zoom * (k_text_height + 2), margin = 6 * zoom, swatch = 10 * zoom;
  int widest = 0;
  for (const LegendEntry& entry : legend) widest = std::max(widest, text_width(entry.text, zoom));
  blend_box(image, margin, margin, widest + swatch + 3 * margin, static_cast<int>(legend.size()) * line + 2 * margin,
            k_paper, 0.82f);
  int top = 2 * margin;
  for (const LegendEntry& entry : legend) {
    blend_box(image, 2 * margin, top + 2 * zoom, swatch, swatch - zoom, k_ink, 0.6f);
    blend_box(image, 2 * margin + 1, top + 2 * zoom + 1, swatch - 2, swatch - zoom - 2, srgb_of(entry.colour), 1.0f);
    draw_text(image, 3 * margin + swatch, top, entry.text, zoom, k_ink);
    top += line;
  }
}

} // namespace tutu::app
