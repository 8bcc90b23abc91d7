// Nothing that is read is overwritten, and what cannot be written is told before the work.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/outputs.h"
#include "tests/support/child_program.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;
using ::testing::HasSubstr;

namespace {

namespace fs = std::filesystem;

class Outputs : public ::testing::Test {
protected:
  Outputs() : folder_(scratch_folder()), scene_(write_small_scene(folder_)) {}
  ~Outputs() override { fs::remove_all(folder_); }

  std::vector<std::string> listing() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) names.push_back(entry.path().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  fs::path folder_;
  std::string scene_;
};

TEST_F(Outputs, AnInputIsNeverAnOutputByWhateverName) {
  const fs::path input = folder_ / "input.json", soft = folder_ / "soft.json", hard = folder_ / "hard.json";
  write_file(input, "x");
  fs::create_symlink(input, soft);
  fs::create_hard_link(input, hard);
  for (const fs::path& output :
       {input, soft, hard, folder_ / "." / "input.json", folder_ / ".." / folder_.filename() / "input.json"}) {
    EXPECT_THROW(check_outputs({{"--out", output}}, {input}), InputError) << output;
    EXPECT_THROW(check_outputs({{"--out", input}}, {output}), InputError) << output;
  }
  EXPECT_NO_THROW(check_outputs({{"--out", folder_ / "other.json"}}, {input}));
  EXPECT_THROW(check_outputs({{"--out", folder_ / "a"}, {"--json", folder_ / "." / "a"}}, {}), InputError);
  EXPECT_NO_THROW(check_outputs({{"--out", "/dev/null"}, {"--json", "/dev/null"}}, {}));
  EXPECT_EQ(read_file(input), "x");
}

TEST_F(Outputs, NoCommandOverwritesWhatItReads) {
  const std::string garment = (folder_ / "cloth.json").string(), before = read_file(scene_);
  const std::vector<std::vector<std::string>> calls = {
      {"play", scene_, "--headless", "--no-pictures", "--frames", "2", "--json", scene_},
      {"drape", scene_, "--seconds", "0.2", "--out", scene_},
      {"validate", scene_, "--json", scene_},
      {"validate", scene_, "--html", scene_},
      {"stability", scene_, "--quick", "--no-pictures", "-o", (folder_ / "maps").string(), "--json", scene_},
      {"plan", scene_, "--error-mm", "2", "-o", scene_}};
  for (const auto& call : calls) {
    const Outcome outcome = run_program(call);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("it would be overwritten")) << call.front();
    EXPECT_EQ(read_file(scene_), before) << call.front();
  }
  const std::string character = source_file("assets/characters/dancer.dae").string();
  const fs::path copy = folder_ / "copy.dae";
  fs::copy_file(character, copy);
  for (const auto& call :
       std::vector<std::vector<std::string>>{{"inspect", copy, "--json", copy},
                                             {"fit", copy, "--out", copy},
                                             {"pose", copy, "--out", folder_ / "p.json", "--json", copy}}) {
    const Outcome outcome = run_program(call);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_EQ(fs::file_size(copy), fs::file_size(character)) << call.front();
  }
}

TEST_F(Outputs, WhatCannotBeWrittenIsToldBeforeTheWork) {
  write_file(folder_ / "file", "");
  const auto seconds = [](const std::function<void()>& f) {
    rusage before{}, after{};
    ::getrusage(RUSAGE_CHILDREN, &before);
    f();
    ::getrusage(RUSAGE_CHILDREN, &after);
    return static_cast<double>(after.ru_utime.tv_sec - before.ru_utime.tv_sec);
  };
  const std::string long_name(300, 'n');
  for (const std::string& wrong : {(folder_ / "none" / "f.json").string(), (folder_ / "file" / "f.json").string(),
                                   (folder_ / long_name).string(), folder_.string(), std::string("/proc/f.json")}) {
    Outcome outcome;
    EXPECT_LT(
        seconds([&] {
          outcome = run_program({"play", scene_, "--headless", "--no-pictures", "--frames", "100000", "--json", wrong});
        }),
        20.0);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("--json")) << wrong;
  }
  const Outcome folder = run_program({"play", scene_, "--at", "0", "-o", (folder_ / "file").string()});
  EXPECT_EQ(folder.status, 2);
  EXPECT_THAT(folder.output, HasSubstr("expected a folder"));
}

TEST_F(Outputs, ASceneWhoseDrapeCouldHaveNoNameIsToldSo) {
  const fs::path scene = folder_ / (std::string(248, 's') + ".json"); // 253 bytes: SCENE.drape.json is too long
  fs::copy_file(scene_, scene);
  EXPECT_EQ(run_program({"play", scene, "--headless", "--no-pictures", "--frames", "2"}).status, 0);
  const Outcome outcome = run_program({"drape", scene, "--seconds", "0.2"});
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("expected at most 255"));
}

TEST_F(Outputs, APlantedLinkAtTheTemporaryNameIsNotFollowed) {
  // The name is not to be known: a hundred files written, and no two temporaries alike nor any that was there before.
  std::set<fs::path> names;
  for (int n = 0; n < 100; ++n) EXPECT_TRUE(names.insert(PendingFile(folder_ / "f").temporary()).second);
  const fs::path victim = folder_ / "victim";
  write_file(victim, "mine");
  fs::create_symlink(victim, folder_ / "link");
  write_file(folder_ / "link", "new"); // a link as output is followed
  EXPECT_EQ(read_file(victim), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  fs::create_symlink(folder_ / "loop", folder_ / "loop");
  EXPECT_THROW(write_file(folder_ / "loop", "x"), std::runtime_error);
}

TEST_F(Outputs, PartsOfDeadProcessesAreSwept) {
  // A child makes a temporary and is killed.
  fs::path part;
  const pid_t child = ::fork();
  if (child == 0) {
    const auto* pending = new PendingFile(folder_ / "film.mp4");
    (void)pending;
    ::raise(SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  const PendingFile mine(folder_ / "mine");
  ASSERT_EQ(listing().size(), 7u) << "the scene's five files, and two parts";
  check_outputs({{"--out", folder_ / "film.mp4"}}, {});
  EXPECT_EQ(listing().size(), 6u);
  EXPECT_TRUE(fs::exists(mine.temporary())) << "this process lives";
}

TEST_F(Outputs, AFolderIsWorkedInByOneChartAtATime) {
  const FolderLock lock(folder_, "tutu chart");
  EXPECT_THROW(FolderLock(folder_, "tutu chart"), InputError);
  const Outcome outcome = run_program({"chart", scene_, "--quick", "-o", folder_.string()});
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("another tutu chart at work in it"));
}

} // namespace
