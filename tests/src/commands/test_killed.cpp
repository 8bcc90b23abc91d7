// kill -9 at any moment, that of writing among them: files are whole or as they were, and the next start leaves nothing
// of the dead one behind.
#include "rig/clip.h"
#include "rig/io/clip_file.h"
#include "rig/io/file_io.h"
#include "rig/mannequin/mannequin.h"
#include "src/study/chart/results_file.h"
#include "src/view/pose/pose_files.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <thread>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

namespace fs = std::filesystem;

class Killed : public ::testing::Test {
protected:
  Killed() : folder_(scratch_folder()), scene_(write_small_scene(folder_)) { fs::create_directories(folder_ / "out"); }
  ~Killed() override { fs::remove_all(folder_); }

  /// Runs the program until a call of such a function; whether it came to that.
  bool killed_at(const std::vector<std::string>& words, const char* function, int call) const {
    const std::string before = fmt::format("LD_PRELOAD={} KILL_AT={}:{}", quoted(TUTU_KILL_AT), function, call);
    return run_program(words, before).status == 128 + SIGKILL;
  }

  /// Kills it at the first calls of each function by which files are written, with `old` in the file's place and
  /// without, and looks each time; then lets it run, and looks for leftovers. Returns how often it was killed.
  int at_all_moments(const std::vector<std::string>& words, const fs::path& file,
                     const std::function<bool(const std::string&)>& is_whole, int calls = 4) {
    int killed = 0;
    for (const char* old : {"", "old"})
      for (const char* function : {"mkostemps", "write", "fsync", "rename"})
        for (int call = 1; call <= calls; ++call) {
          fs::remove(file);
          if (*old) write_file(file, old);
          if (!killed_at(words, function, call)) break;
          ++killed;
          if (!fs::exists(file)) {
            EXPECT_EQ(*old, 0) << function << ":" << call << " lost what was there";
            continue;
          }
          const std::string text = read_file(file);
          EXPECT_TRUE((*old && text == old) || is_whole(text)) << function << ":" << call << " tore " << file;
        }
    fs::remove(file);
    EXPECT_EQ(run_program(words).status & ~1, 0);
    EXPECT_TRUE(is_whole(read_file(file)));
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      EXPECT_FALSE(entry.path().filename().string().starts_with(".tutu-")) << entry.path() << " is left";
    return killed;
  }

  fs::path folder_;
  std::string scene_;
};

bool is_json(const std::string& text) { return nlohmann::json::accept(text); }

TEST_F(Killed, NothingIsTornAndNothingStays_slow) {
  const std::string out = (folder_ / "out" / "file").string();
  int killed = 0;
  killed += at_all_moments({"drape", scene_, "--seconds", "0.1", "-o", out + ".json"}, out + ".json", is_json);
  killed += at_all_moments({"fit", (folder_ / "body.dae").string(), "--count", "2", "-o", out + ".json"}, out + ".json",
                           is_json);
  killed += at_all_moments({"validate", scene_, "--no-cloth", "--samples", "200", "--json", out + ".json"},
                           out + ".json", is_json);
  killed += at_all_moments({"validate", scene_, "--no-cloth", "--samples", "200", "--html", out + ".html"},
                           out + ".html", [](const std::string& text) { return text.ends_with("</html>\n"); });
  killed += at_all_moments({"play", scene_, "--headless", "--no-pictures", "--frames", "3", "--json", out + ".json"},
                           out + ".json", is_json);
  killed += at_all_moments({"mannequin", "-o", out + ".dae"}, out + ".dae",
                           [](const std::string& text) { return text.ends_with("</COLLADA>\n"); });
  if (std::system("command -v ffmpeg > /dev/null") == 0)
    killed += at_all_moments({"play", scene_, "--headless", "--frames", "4", "--size", "64x48", "-o", out + ".mp4"},
                             out + ".mp4", [](const std::string& text) { return text.find("moov") != text.npos; });
  RecordProperty("killed", killed);
  EXPECT_GT(killed, 50); // with the chart's and the autosave's below a hundred
}

TEST_F(Killed, AChartGoesOnAndItsRowsAreWhole_slow) {
  write_file(folder_ / "settings.json", R"({"settings": [{"substeps": [2, 3]}]})");
  const std::vector<std::string> words = {"chart",
                                          scene_,
                                          "--frames",
                                          "12",
                                          "--settle",
                                          "4",
                                          "--held",
                                          "4",
                                          "--every",
                                          "2",
                                          "--cache",
                                          (folder_ / "cache").string(),
                                          "--repeats",
                                          "1",
                                          "-o",
                                          (folder_ / "out").string(),
                                          "--reference-substeps",
                                          "4,8,16",
                                          "--settings",
                                          (folder_ / "settings.json").string()};
  int killed = 0;
  for (const char* function : {"mkostemps", "rename", "fsync", "pwrite"})
    for (int call = 1; call <= 3; ++call) {
      killed += killed_at(words, function, call);
      EXPECT_NO_THROW((void)read_results(folder_ / "out" / "results.csv"));
    }
  EXPECT_GT(killed, 3);
  const Outcome outcome = run_program(words);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(read_results(folder_ / "out" / "results.csv").rows.size(), 3u);
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".tutu-")) << entry.path();
}

TEST_F(Killed, TheAutosaveIsAlwaysWhole) {
  const rig::Skeleton skeleton = rig::make_mannequin().skeleton;
  const Autosave autosave(folder_ / "steps.json");
  for (int round = 0; round < 40; ++round) {
    const pid_t child = ::fork();
    if (child == 0) { // writes on and on
      EditDocument document(edit_state_at_rest(skeleton, "steps"));
      for (int step = 0;; ++step) {
        EditState next = document.state();
        next.pose[0].translation.x() += 0.01;
        add_next_key(next, 0.5);
        document.change(next);
        autosave.update(document, skeleton);
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(5000 + 1700 * round));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    std::string trouble;
    (void)autosave.found(skeleton, trouble);
    EXPECT_EQ(trouble, "");
  }
  sweep_leftovers(folder_);
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".tutu-")) << entry.path();
}

} // namespace
