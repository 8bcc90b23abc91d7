// Films, progress lines and Ctrl-C.
#include "rig/io/file_io.h"
#include "src/base/interrupt.h"
#include "src/base/progress.h"
#include "src/view/render/video.h"
#include "tests/support/paths.h"

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <gmock/gmock.h>
#include <memory>
#include <sys/wait.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

Image plain(int width, int height, int shade) {
  const auto size = static_cast<std::size_t>(3 * width * height);
  return {
      .width = width, .height = height, .pixels = std::vector<std::uint8_t>(size, static_cast<std::uint8_t>(shade))};
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "r"), &::pclose);
  std::string text;
  std::array<char, 256> part{};
  while (pipe && std::fgets(part.data(), static_cast<int>(part.size()), pipe.get())) text += part.data();
  return text;
}

bool has_children() { return !(::waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD); }

/// PATH for as long as it lives.
class ScopedPath {
public:
  explicit ScopedPath(const std::string& path) : before_(std::getenv("PATH")) { ::setenv("PATH", path.c_str(), 1); }
  ~ScopedPath() { ::setenv("PATH", before_.c_str(), 1); }
  ScopedPath(const ScopedPath&) = delete;
  ScopedPath& operator=(const ScopedPath&) = delete;

private:
  std::string before_;
};

/// A folder with a program `ffmpeg` that does what the script says.
fs::path fake_ffmpeg(const fs::path& folder, const std::string& script) {
  fs::create_directories(folder / "bin");
  const fs::path program = folder / "bin" / "ffmpeg";
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(program.c_str(), "w"), &std::fclose);
  std::fputs(("#!/bin/sh\n" + script).c_str(), file.get());
  file.reset();
  fs::permissions(program, fs::perms::owner_all);
  return folder / "bin";
}

std::string error_of(const auto& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Video, IsPlayable) {
  if (!ffmpeg_available()) GTEST_SKIP() << "no ffmpeg here";
  const fs::path folder = test::scratch_folder(), file = folder / "it's a: film.mp4";
  {
    VideoWriter film(file, 65, 48, 25); // an odd side
    for (int i = 0; i < 12; ++i) film.add(plain(65, 48, 20 * i));
    EXPECT_FALSE(fs::exists(file));
    film.finish();
  }
  EXPECT_TRUE(fs::exists(file));
  EXPECT_FALSE(has_children());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
  const std::string facts =
      output_of("cd '" + folder.string() +
                "' && mv *.mp4 film.mp4 && ffprobe -v error -count_frames "
                "-show_entries stream=codec_name,pix_fmt,width,height,nb_read_frames,r_frame_rate "
                "-of default=nw=1 film.mp4 2>&1");
  for (const char* fact :
       {"codec_name=h264", "pix_fmt=yuv420p", "width=66", "height=48", "nb_read_frames=12", "r_frame_rate=25/1"})
    EXPECT_THAT(facts, ::testing::HasSubstr(fact));
  fs::remove_all(folder);
}

TEST(Video, RatesOfTelevisionAreTakenForWhatTheyAre) {
  const fs::path folder = test::scratch_folder();
  const ScopedPath path(
      fake_ffmpeg(folder, "echo \"$@\" > '" + (folder / "words").string() + "'; /bin/cat > /dev/null\n"));
  for (const auto& [rate, text] : {std::pair{29.97, "30000/1001"},
                                   {23.976, "24000/1001"},
                                   {59.94, "60000/1001"},
                                   {30000.0 / 1001.0, "30000/1001"},
                                   {60.0, "60.000000"},
                                   {12.5, "12.500000"},
                                   {1000.0, "1000.000000"}}) {
    VideoWriter film(folder / "a.mp4", 64, 48, rate);
    film.add(plain(64, 48, 9));
    error_of([&] { film.finish(); }); // of a film that nobody wrote
    EXPECT_THAT(read_file(folder / "words"), ::testing::HasSubstr(std::string("-framerate ") + text + " ")) << rate;
  }
  fs::remove_all(folder);
}

TEST(Video, WithoutFinishLeavesNothing) {
  if (!ffmpeg_available()) GTEST_SKIP() << "no ffmpeg here";
  const fs::path folder = test::scratch_folder();
  {
    VideoWriter film(folder / "a.mp4", 64, 48, 25);
    for (int i = 0; i < 5; ++i) film.add(plain(64, 48, 9));
  }
  EXPECT_FALSE(has_children());
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

TEST(Video, SaysWhyFfmpegFailed) {
  if (!ffmpeg_available()) GTEST_SKIP() << "no ffmpeg here";
  const fs::path folder = test::scratch_folder();
  const std::string error = error_of([&] {
    VideoWriter film(folder / "no" / "such" / "folder" / "a.mp4", 640, 480, 25);
    for (int i = 0; i < 100; ++i) film.add(plain(640, 480, 9)); // SIGPIPE would end the test program here
    film.finish();
  });
  EXPECT_THAT(error, ::testing::AllOf(::testing::HasSubstr("a.mp4"), ::testing::HasSubstr("no folder")));
  EXPECT_FALSE(has_children());
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

TEST(Video, AChildThatDiesMidwayIsAnErrorWithItsLastLine) {
  const fs::path folder = test::scratch_folder();
  const ScopedPath path(fake_ffmpeg(folder, "echo first >&2; echo 'the disk is full' >&2; exit 3\n").string());
  const std::string error = error_of([&] {
    VideoWriter film(folder / "a.mp4", 640, 480, 25);
    for (int i = 0; i < 100; ++i) film.add(plain(640, 480, 9));
    film.finish();
  });
  EXPECT_THAT(error, ::testing::EndsWith("the disk is full"));
  EXPECT_FALSE(has_children());
  fs::remove_all(folder);
}

TEST(Video, NeedsFfmpegAndFrames) {
  const fs::path folder = test::scratch_folder();
  {
    const ScopedPath path((folder / "empty").string());
    EXPECT_FALSE(ffmpeg_available());
    EXPECT_THAT(error_of([&] { VideoWriter film(folder / "a.mp4", 64, 48, 25); }),
                ::testing::HasSubstr("not installed"));
  }
  const ScopedPath path(fake_ffmpeg(folder, "while read -r line; do :; done\n").string());
  EXPECT_TRUE(ffmpeg_available());
  VideoWriter film(folder / "a.mp4", 64, 48, 25);
  EXPECT_THROW(film.add(plain(64, 50, 0)), std::invalid_argument);
  EXPECT_THROW(film.finish(), std::runtime_error);
  EXPECT_THROW(VideoWriter(folder / "b.mp4", 64, 48, 0), std::invalid_argument);
  fs::remove_all(folder);
}

TEST(ProgressLine, SaysWhereTheWorkStands) {
  EXPECT_EQ(progress_line("dance", 50, 200, 2, 8), "dance  [##......]   50/200  25.0/s  6 s left");
  EXPECT_EQ(progress_line("dance", 0, 200, 0, 0), "dance    0/200");
  EXPECT_EQ(progress_line("dance", 200, 200, 90, 4), "dance  [####]  200/200  2.2/s  1:30 min");
  EXPECT_EQ(progress_line("dance", 300, 200, 90, 4), "dance  [####]  200/200  2.2/s  1:30 min");
}

TEST(ProgressLine, OutsideATerminalIsOneLineEachTenth) {
  ::testing::internal::CaptureStderr();
  {
    Progress progress("work", 1000);
    for (int i = 1; i <= 1000; ++i) progress.tick(i);
    progress.finish();
    progress.tick(1000);
    Progress none("nothing", 0);
    none.tick(0);
  }
  const std::string text = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("\r")));
}

TEST(InterruptDeathTest, TheFirstIsRememberedAndTheSecondEndsTheProgram) {
  catch_interrupt();
  EXPECT_FALSE(interrupted());
  ::raise(SIGINT);
  EXPECT_TRUE(interrupted());
  EXPECT_EXIT(::raise(SIGINT), ::testing::KilledBySignal(SIGINT), "");
  catch_interrupt();
  EXPECT_FALSE(interrupted());
  ::signal(SIGINT, SIG_DFL);
  ::signal(SIGTERM, SIG_DFL);
}

} // namespace
} // namespace tutu::app
