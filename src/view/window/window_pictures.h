// Pictures and films of what the window shows.
#pragma once

#include "src/view/render/image.h"
#include "src/view/render/video.h"

#include <filesystem>
#include <optional>
#include <string>

namespace tutu::app {

/// What the bound framebuffer holds.
Image read_window(int width, int height);

/// Writes screenshots and films into one folder, each under a name that is not taken yet.
class WindowPictures {
public:
  WindowPictures(std::filesystem::path folder, std::string stem) : folder_(std::move(folder)), stem_(std::move(stem)) {}

  /// STEM-NNNN.png of that frame. Returns what to tell the user; so do all.
  std::string screenshot(const Image& image, int frame);

  bool filming() const { return filming_; }
  /// Begins or ends a film: STEM.mp4, or where there is no ffmpeg the folder STEM-frames.
  std::string toggle_film(int width, int height, double frames_per_second);
  /// While filming: one picture more. A window that has changed its size ends the film.
  std::string add(const Image& image);

private:
  std::filesystem::path free_name(const std::string& stem, const std::string& suffix) const;
  std::string end_film();

  std::filesystem::path folder_;
  std::string stem_;
  bool filming_ = false;
  std::optional<VideoWriter> video_;
  std::filesystem::path film_;
  int count_ = 0, width_ = 0, height_ = 0;
};

} // namespace tutu::app
