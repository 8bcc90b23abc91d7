#include "src/view/window/window_pictures.h"

#include "src/view/render/png.h"

#include <epoxy/gl.h>

#include <fmt/format.h>

namespace tutu::app {

Image read_window(int width, int height) {
  Image image{.width = width, .height = height, .pixels = {}};
  const std::size_t row = std::size_t{3} * static_cast<std::size_t>(width);
  std::vector<std::uint8_t> upside_down(row * static_cast<std::size_t>(height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
  image.pixels.reserve(upside_down.size());
  for (int y = height - 1; y >= 0; --y) {
    const auto from = upside_down.begin() + static_cast<std::ptrdiff_t>(row) * y;
    image.pixels.insert(image.pixels.end(), from, from + static_cast<std::ptrdiff_t>(row));
  }
  return image;
}

std::filesystem::path WindowPictures::free_name(const std::string& stem, const std::string& suffix) const {
  std::filesystem::create_directories(folder_);
  std::filesystem::path name = folder_ / (stem + suffix);
  for (int k = 2; exists(name); ++k) name = folder_ / fmt::format("{}-{}{}", stem, k, suffix);
  return name;
}

std::string WindowPictures::screenshot(const Image& image, int frame) {
  try {
    const std::filesystem::path name = free_name(fmt::format("{}-{:04}", stem_, frame), ".png");
    write_png(name, image);
    return "wrote " + name.string();
  } catch (const std::exception& error) { // a full disk must not end the show
    return error.what();
  }
}

std::string WindowPictures::toggle_film(int width, int height, double frames_per_second) {
  if (filming_) return end_film();
  try {
    count_ = 0;
    width_ = width;
    height_ = height;
    if (ffmpeg_available()) {
      film_ = free_name(stem_, ".mp4");
      video_.emplace(film_, width, height, frames_per_second);
    } else {
      film_ = free_name(stem_ + "-frames", "");
      std::filesystem::create_directories(film_);
    }
    filming_ = true;
    return "filming to " + film_.string();
  } catch (const std::exception& error) {
    video_.reset();
    return error.what();
  }
}

std::string WindowPictures::add(const Image& image) {
  if (image.width != width_ || image.height != height_) return end_film();
  try {
    if (video_) video_->add(image);
    else write_png(film_ / fmt::format("{:04}.png", count_), image);
    return fmt::format("filming to {}: {} frames", film_.string(), ++count_);
  } catch (const std::exception& error) {
    filming_ = false;
    video_.reset();
    return error.what();
  }
}

std::string WindowPictures::end_film() {
  filming_ = false;
  if (count_ == 0) {
    video_.reset();
    return "nothing was filmed";
  }
  try {
    if (video_) video_->finish();
    video_.reset();
    return fmt::format("wrote {}, {} frames", film_.string(), count_);
  } catch (const std::exception& error) {
    video_.reset();
    return error.what();
  }
}

} // namespace tutu::app
