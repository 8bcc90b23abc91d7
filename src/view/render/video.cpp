#include "src/view/render/video.h"

#include "rig/io/file_io.h"
#include "src/base/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <span>
#include <spawn.h>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

extern char** environ; // POSIX declares it nowhere

namespace tutu::app {
namespace {

/// Closes itself; -1 when there is none.
class Descriptor {
public:
  ~Descriptor() { reset(-1); }
  Descriptor() = default;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void reset(int number) {
    if (number_ >= 0) ::close(number_);
    number_ = number;
  }

private:
  int number_ = -1;
};

std::string last_line(int descriptor) {
  std::array<char, 4096> tail{};
  const off_t size = ::lseek(descriptor, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(tail.size()));
  const ssize_t count = ::pread(descriptor, tail.data(), tail.size(), from);
  std::string text(tail.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  const std::size_t end = text.find_last_not_of("\r\n ");
  if (end == std::string::npos) return "";
  text.resize(end + 1);
  const std::size_t start = text.find_last_of("\r\n");
  return start == std::string::npos ? text : text.substr(start + 1);
}

/// A rate as ffmpeg takes it. 23.976, 29.97 and 59.94 are short for 1000/1001 of 24, 30 and 60 [SMPTE 12M]: a film at
/// the decimals would drift, and players would not know it.
std::string rate_text(double rate) {
  constexpr double k_rounding = 5e-4; // of what people write
  const double of_television = std::round(rate * 1.001);
  const bool is_short = rate != std::round(rate) && std::abs(of_television / 1.001 - rate) < k_rounding;
  return is_short ? fmt::format("{:.0f}/1001", 1000.0 * of_television) : fmt::format("{:.6f}", rate);
}

} // namespace

struct VideoWriter::Encoder {
  explicit Encoder(const std::filesystem::path& file) : target(file), pending(file) {}
  ~Encoder() {
    if (child == 0) return;
    ::kill(child, SIGKILL);
    reap();
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  void start(int width, int height, double frames_per_second);
  void send(std::span<const std::uint8_t> bytes);
  /// Waits for the child's end; its status as waitpid gives it.
  int reap();
  /// "FILE: WHAT", with ffmpeg's last words if it said any.
  std::runtime_error error(const std::string& what) const;

  std::filesystem::path target;
  PendingFile pending; ///< outlives the child that writes to it
  pid_t child = 0;     ///< 0 when there is none
  /// Frames go through a socket, not a pipe: writing to a dead child is then an error of that call, without SIGPIPE.
  Descriptor frames;
  /// The child's stderr goes to memory, so that it never waits for somebody to read it.
  Descriptor words;
  bool has_frames = false;
};

bool ffmpeg_available() { return on_path("ffmpeg"); }

void VideoWriter::Encoder::start(int width, int height, double frames_per_second) {
  const std::vector<std::string> words_of_command = {
      "ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-y",
      // What comes in
      "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", fmt::format("{}x{}", width, height), "-framerate",
      rate_text(frames_per_second), "-i", "pipe:0",
      // What goes out
      "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-c:v",
      "libx264", "-preset", "veryfast", "-crf", "17", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc",
      "iec61966-2-1", "-movflags", "+faststart", "-f", "mp4", "file:" + pending.temporary().string()};
  std::vector<char*> arguments;
  for (const std::string& word : words_of_command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()) != 0)
    throw error(std::string("no socket to ffmpeg: ") + std::strerror(errno));
  frames.reset(pair[0]);
  Descriptor input;
  input.reset(pair[1]);
  words.reset(::memfd_create("ffmpeg-stderr", MFD_CLOEXEC));
  if (words.number() < 0) throw error(std::string("no memory file for ffmpeg: ") + std::strerror(errno));

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.number(), STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, words.number(), STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int failure = ::posix_spawnp(&child, "ffmpeg", &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failure != 0) {
    child = 0;
    throw error(failure == ENOENT ? "films need the program ffmpeg, which is not installed"
                                  : std::string("ffmpeg cannot be started: ") + std::strerror(failure));
  }
}

void VideoWriter::Encoder::send(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(frames.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      reap();
      throw error("ffmpeg stopped");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

int VideoWriter::Encoder::reap() {
  int status = 0;
  frames.reset(-1); // the end of its input
  while (child != 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  child = 0;
  return status;
}

std::runtime_error VideoWriter::Encoder::error(const std::string& what) const {
  const std::string said = words.number() >= 0 ? last_line(words.number()) : "";
  return std::runtime_error(target.string() + ": " + what + (said.empty() ? "" : ": " + said));
}

VideoWriter::VideoWriter(const std::filesystem::path& file, int width, int height, double frames_per_second)
    : width_(width), height_(height) {
  if (width <= 0 || height <= 0 || !(frames_per_second > 0))
    throw std::invalid_argument("a film needs a size and a frame rate above 0");
  encoder_ = std::make_unique<Encoder>(file);
  encoder_->start(width, height, frames_per_second);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Image& image) {
  if (image.width != width_ || image.height != height_)
    throw std::invalid_argument("a film's frames all have the size it began with");
  encoder_->send(image.pixels);
  encoder_->has_frames = true;
}

void VideoWriter::finish() {
  if (!encoder_->has_frames) throw encoder_->error("a film needs at least one frame");
  const int status = encoder_->reap();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw encoder_->error("ffmpeg failed");
  encoder_->pending.commit();
}

} // namespace tutu::app
