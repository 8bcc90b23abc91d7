// A chart whose cells are jobs of Slurm: on a stand-in for its commands, and on a cluster of this one machine.
#include "rig/io/file_io.h"
#include "src/study/chart/results_file.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"

#include <atomic>
#include <cstdlib>
#include <gmock/gmock.h>
#include <thread>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

namespace fs = std::filesystem;

class Slurm : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = scratch_folder();
    scene_ = write_small_scene(folder_);
    write_file(folder_ / "settings.json", R"({"settings": [{"substeps": [2, 3]}]})");
  }
  void TearDown() override { fs::remove_all(folder_); }

  Outcome chart(const std::string& before, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"chart",
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
                                      "2",
                                      "-o",
                                      (folder_ / "out").string(),
                                      "--slurm",
                                      "--reference-substeps",
                                      "4,8,16",
                                      "--settings",
                                      (folder_ / "settings.json").string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, before);
  }

  /// Commands of these names, of these shell texts, before all others.
  std::string with_commands(const std::map<std::string, std::string>& scripts) const {
    const fs::path programs = folder_ / "programs";
    fs::create_directories(programs);
    for (const auto& [name, text] : scripts) {
      write_file(programs / name, "#!/bin/sh\ncd " + quoted(folder_.string()) + "\n" + text);
      fs::permissions(programs / name, fs::perms::owner_all);
    }
    return "PATH=" + quoted(programs.string()) + ":$PATH";
  }

  std::vector<Row> rows() const { return read_results(folder_ / "out" / "results.csv").rows; }

  fs::path folder_;
  std::string scene_;
};

constexpr const char* k_runs_all_but = R"(
case "$*" in *--help*) exit 0 ;; esac
echo "$*" >> submissions
round=$(wc -l < submissions)
while [ $# -gt 0 ]; do
  case $1 in --array=1-*) last=${1#--array=1-} ;; *.sh) script=$1; shift; break ;; esac
  shift
done
for n in $(seq "$last"); do
  case " $LOST " in *" $round:$n "*) continue ;; esac
  SLURM_ARRAY_TASK_ID=$n sh "$script" "$@"
done
echo "$round;here"
)";
constexpr const char* k_forgets = "echo 'slurm_load_jobs error: Invalid job id specified' >&2\nexit 1\n";

TEST_F(Slurm, RunsEveryCellAndAgainThoseThatWereLost) {
  const std::string before =
      "LOST='1:2 1:6 2:1' " +
      with_commands({{"sbatch", k_runs_all_but}, {"squeue", k_forgets}, {"scancel", "touch cancelled"}});
  const Outcome outcome = chart(before);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(rows().size(), 6u);
  for (const Row& row : rows()) EXPECT_EQ(row.text("outcome"), "ok");
  const std::string submissions = read_file(folder_ / "submissions");
  EXPECT_THAT(submissions, AllOf(HasSubstr("--array=1-6 "), HasSubstr("--array=1-2 "), HasSubstr("--array=1-1 ")));
  EXPECT_FALSE(fs::exists(folder_ / "out" / "slurm")); // nothing is left but the rows
  EXPECT_FALSE(fs::exists(folder_ / "cancelled"));
}

TEST_F(Slurm, WhatIsLostThreeTimesIsARowThatSaysSo) {
  const std::map<std::string, std::string> commands = {{"sbatch", k_runs_all_but}, {"squeue", k_forgets}};
  const Outcome outcome = chart("LOST='1:4 2:1 3:1' " + with_commands(commands));
  EXPECT_THAT(outcome.output, HasSubstr("lost by Slurm 3 times"));
  EXPECT_EQ(rows().size(), 6u);
  const auto all = rows();
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](const Row& r) { return r.text("outcome") == k_crashed; }), 1);
  EXPECT_TRUE(fs::exists(folder_ / "out" / "slurm"));  // its logs are kept
  EXPECT_EQ(chart(with_commands(commands)).status, 0); // and the next chart runs what is missing
  EXPECT_THAT(rows(), ::testing::Each(::testing::ResultOf([](const Row& r) { return r.text("outcome"); }, "ok")));
}

TEST_F(Slurm, RowsOfJobsThatOutlivedTheirChartAreTaken) {
  const std::string before = with_commands({{"sbatch", k_runs_all_but}, {"squeue", k_forgets}});
  ASSERT_EQ(chart(before).status, 0);
  const std::vector<Row> all = rows();
  fs::create_directories(folder_ / "out" / "slurm");
  fs::remove(folder_ / "out" / "results.csv");
  for (const Row& row : all) add_row(folder_ / "out" / "slurm" / (row.text("key") + ".csv"), row);
  const Outcome again = chart(before);
  EXPECT_THAT(again.output, HasSubstr("6 of 6 runs are in "));
  EXPECT_EQ(rows().size(), 6u);
}

TEST_F(Slurm, WhatSbatchSaysIsToldAndNothingIsLost) {
  const Outcome refused = chart(with_commands(
      {{"sbatch", "case $1 in --help) exit 0 ;; esac\necho 'sbatch: error: Invalid partition' >&2\nexit 1\n"}}));
  EXPECT_NE(refused.status, 0);
  EXPECT_THAT(refused.output, HasSubstr("Invalid partition"));
  EXPECT_TRUE(rows().empty());
  fs::create_directories(folder_ / "bare");
  fs::create_symlink("/usr/bin/gnuplot", folder_ / "bare" / "gnuplot");
  const Outcome none = chart("PATH=" + quoted((folder_ / "bare").string()));
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.output, HasSubstr("--slurm: found no sbatch here, expected Slurm's commands"));
}

TEST_F(Slurm, MergesRowsOfOtherMachines) {
  const std::string before = with_commands({{"sbatch", k_runs_all_but}, {"squeue", k_forgets}});
  ASSERT_EQ(chart(before).status, 0);
  const std::string all = read_file(folder_ / "out" / "results.csv");
  fs::rename(folder_ / "out" / "results.csv", folder_ / "theirs.csv");
  const Outcome merged = chart(before, {"--merge", (folder_ / "theirs.csv").string()});
  EXPECT_THAT(merged.output, AllOf(HasSubstr("6 rows of "), HasSubstr("6 of 6 runs are in ")));
  EXPECT_EQ(read_file(folder_ / "out" / "results.csv"), all);
  const Outcome missing = chart(before, {"--merge", (folder_ / "none.csv").string()});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.output, AllOf(HasSubstr("none.csv"), HasSubstr("no such file")));
}

/// slurmctld and slurmd of this machine, for as long as it lives.
class LocalCluster {
public:
  explicit LocalCluster(fs::path folder) : folder_(std::move(folder)) {
    const fs::path said = folder_.string() + ".said";
    const int status = std::system((call("start") + " > " + quoted(said.string())).c_str());
    said_ = read_file(said);
    said_.erase(said_.find_last_not_of('\n') + 1);
    runs_ = status == 0;
  }
  ~LocalCluster() { std::system(call("stop").c_str()); }
  LocalCluster(const LocalCluster&) = delete;
  LocalCluster& operator=(const LocalCluster&) = delete;

  bool runs() const { return runs_; }
  const std::string& said() const { return said_; } ///< its configuration, or why it does not run

private:
  std::string call(const char* what) const {
    return "sh " + quoted((source_file("tests/support/local_slurm.sh")).string()) + " " + what + " " +
           quoted(folder_.string());
  }

  fs::path folder_;
  std::string said_;
  bool runs_ = false;
};

TEST_F(Slurm, OnAClusterOfThisMachine_slow) {
  const LocalCluster cluster(folder_ / "cluster");
  if (!cluster.runs()) GTEST_SKIP() << "no local cluster: " << cluster.said();
  const std::string before = "SLURM_CONF=" + quoted(cluster.said());
  // Somebody cancels the first array as soon as it waits.
  std::atomic<bool> over = false;
  std::atomic<int> cancelled = 0;
  std::thread vandal([&] {
    while (!over && cancelled == 0)
      if (std::system((before + " squeue --noheader --states=PENDING | grep -q . && " + before +
                       " scancel --state=PENDING --user=root")
                          .c_str()) == 0)
        ++cancelled;
  });
  const Outcome outcome = chart(before);
  over = true;
  vandal.join();
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(cancelled, 1);
  EXPECT_EQ(rows().size(), 6u);
  for (const Row& row : rows()) EXPECT_EQ(row.text("outcome"), "ok");
}

} // namespace
