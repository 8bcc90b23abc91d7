#include "src/view/render/image_text.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace tutu::app {
namespace {

/// The font's glyphs in grey, made once: a font atlas needs no context and no card.
struct Font {
  Font() {
    font = atlas.AddFontDefault();
    atlas.GetTexDataAsAlpha8(&pixels, &width, &height);
  }

  ImFontAtlas atlas;
  ImFont* font = nullptr;
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
};

const Font& the_font() {
  static const Font k_font;
  return k_font;
}

const ImFontGlyph& glyph_of(char c) { return *the_font().font->FindGlyph(static_cast<ImWchar>(c)); }

void blend(Image& image, int x, int y, const std::array<float, 3>& srgb, float strength) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::uint8_t* pixel = image.pixels.data() + (image.at(x, y) - image.pixels.data());
  for (std::size_t c = 0; c < 3; ++c)
    pixel[c] = static_cast<std::uint8_t>(std::lround((1 - strength) * pixel[c] + strength * 255.0f * srgb[c]));
}

} // namespace

void blend_box(Image& image, int left, int top, int width, int height, const std::array<float, 3>& srgb,
               float strength) {
  for (int y = std::max(0, top); y < std::min(image.height, top + height); ++y)
    for (int x = std::max(0, left); x < std::min(image.width, left + width); ++x) blend(image, x, y, srgb, strength);
}

void draw_text(Image& image, int left, int top, std::string_view text, int zoom, const std::array<float, 3>& srgb) {
  const Font& font = the_font();
  for (const char c : text) {
    const ImFontGlyph& glyph = glyph_of(c);
    const int u = static_cast<int>(std::lround(glyph.U0 * static_cast<float>(font.width)));
    const int v = static_cast<int>(std::lround(glyph.V0 * static_cast<float>(font.height)));
    const int wide = static_cast<int>(std::lround(glyph.X1 - glyph.X0));
    const int high = static_cast<int>(std::lround(glyph.Y1 - glyph.Y0));
    const int x0 = left + zoom * static_cast<int>(std::lround(glyph.X0));
    const int y0 = top + zoom * static_cast<int>(std::lround(glyph.Y0));
    for (int y = 0; y < high * zoom; ++y)
      for (int x = 0; x < wide * zoom; ++x)
        if (const unsigned char grey = font.pixels[(v + y / zoom) * font.width + u + x / zoom])
          blend(image, x0 + x, y0 + y, srgb, static_cast<float>(grey) / 255.0f);
    left += zoom * static_cast<int>(std::lround(glyph.AdvanceX));
  }
}

int text_width(std::string_view text, int zoom) {
  int width = 0;
  for (const char c : text) width += zoom * static_cast<int>(std::lround(glyph_of(c).AdvanceX));
  return width;
}

} // namespace tutu::app
