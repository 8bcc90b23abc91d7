// Films on disk, through the ffmpeg program.
#pragma once

#include "src/view/render/image.h"

#include <filesystem>
#include <memory>

namespace tutu::app {

/// Whether a program called ffmpeg is on the PATH.
bool ffmpeg_available();

/// Encodes frames as H.264 (yuv420p, BT.709, index at the front so that it plays while it loads). An odd side gets one
/// row or column of black. The file appears under its name only with finish(); until then, and after a failure or
/// without finish(), there is neither a part of it nor a child process left.
/// The child is in a process group of its own: Ctrl-C in the terminal does not cut it off, the caller decides.
class VideoWriter {
public:
  /// Throws std::runtime_error when ffmpeg is missing or cannot be started, std::invalid_argument for sizes or rates <=
  /// 0.
  VideoWriter(const std::filesystem::path& file, int width, int height, double frames_per_second);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Throws std::invalid_argument for another size than promised, std::runtime_error with ffmpeg's last words when it
  /// has stopped. After a throw the writer is of no more use.
  void add(const Image& image);

  /// Waits for the encoder and puts the file in its place; throws std::runtime_error when either fails. Call once.
  void finish();

private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
  int width_, height_;
};

} // namespace tutu::app
