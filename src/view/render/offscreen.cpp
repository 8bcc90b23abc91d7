#include "src/view/render/offscreen.h"

#include "src/view/render/error_colours.h"
#include "src/view/render/gl_objects.h"
#include "src/view/render/legend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace tutu::app {
namespace {

constexpr int k_largest_side = 8192, k_largest_supersample = 4;

/// Linear light in 16 bits of each sRGB byte, and the byte of each linear value of 14 bits.
struct SrgbTables {
  std::array<std::uint16_t, 256> linear;
  std::array<std::uint8_t, 1 << 14> byte;
};

SrgbTables make_tables() {
  SrgbTables tables{};
  for (std::size_t i = 0; i < tables.linear.size(); ++i) {
    const double s = static_cast<double>(i) / 255.0;
    const double c = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    tables.linear[i] = static_cast<std::uint16_t>(std::lround(c * 65535.0));
  }
  for (std::size_t i = 0; i < tables.byte.size(); ++i) {
    const double c = (static_cast<double>(i) + 0.5) / static_cast<double>(tables.byte.size());
    const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
    tables.byte[i] = static_cast<std::uint8_t>(std::lround(s * 255.0));
  }
  return tables;
}

} // namespace

struct Offscreen::Target {
  Framebuffer framebuffer;
  Renderbuffer colour, depth;
};

Offscreen::Offscreen(const OffscreenOptions& options) : options_(options) {
  const auto in_range = [](int value, int most) { return value >= 1 && value <= most; };
  if (!in_range(options.width, k_largest_side) || !in_range(options.height, k_largest_side) ||
      !in_range(options.supersample, k_largest_supersample))
    throw std::invalid_argument("a picture has 1 to 8192 pixels a side and a supersampling of 1 to 4");
  const int width = options.width * options.supersample, height = options.height * options.supersample;
  target_ = std::make_unique<Target>();
  glBindFramebuffer(GL_FRAMEBUFFER, target_->framebuffer.name());
  glBindRenderbuffer(GL_RENDERBUFFER, target_->colour.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target_->colour.name());
  glBindRenderbuffer(GL_RENDERBUFFER, target_->depth.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, target_->depth.name());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the graphics driver cannot draw pictures of " + std::to_string(width) + " x " +
                             std::to_string(height) + " pixels");
  raw_.resize(std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  renderer_ = std::make_unique<Renderer>();
}

Offscreen::~Offscreen() {
  try {
    context_.make_current();
  } catch (const std::exception&) {
    return; // without the context its objects are gone already
  }
}

Image Offscreen::draw(const FrameView& view, const Camera& camera) {
  Image image;
  draw(view, camera, image);
  return image;
}

void Offscreen::draw(const FrameView& view, const Camera& camera, Image& image) {
  context_.make_current();
  glBindFramebuffer(GL_FRAMEBUFFER, target_->framebuffer.name());
  const int width = options_.width * options_.supersample, height = options_.height * options_.supersample;
  renderer_->draw(view, camera, width, height, static_cast<float>(options_.supersample));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, raw_.data());
  image.width = options_.width;
  image.height = options_.height;
  reduce(raw_, options_.supersample, image);
  if (view.error_scale) draw_error_bar(*view.error_scale, image);
  draw_legend(view.legend, image);
  draw_caption(view.caption, image);
}

void reduce(const std::vector<std::uint8_t>& raw, int factor, Image& image) {
  static const SrgbTables k_tables = make_tables();
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  const auto side = static_cast<std::size_t>(factor), samples = side * side, raw_row = 4 * width * side;
  image.pixels.resize(3 * width * height);
  for (std::size_t y = 0; y < height; ++y) {
    std::uint8_t* out = image.pixels.data() + 3 * width * y;
    const std::uint8_t* block_row = raw.data() + raw_row * side * (height - 1 - y);
    for (std::size_t x = 0; x < width; ++x, out += 3) {
      const std::uint8_t* block = block_row + 4 * side * x;
      if (side == 1) {
        std::copy(block, block + 3, out);
        continue;
      }
      std::array<std::uint32_t, 3> sum{};
      for (std::size_t j = 0; j < side; ++j)
        for (std::size_t i = 0; i < side; ++i)
          for (std::size_t c = 0; c < 3; ++c) sum[c] += k_tables.linear[block[raw_row * j + 4 * i + c]];
      for (std::size_t c = 0; c < 3; ++c) out[c] = k_tables.byte[sum[c] / samples >> 2];
    }
  }
}

} // namespace tutu::app
