#include "src/study/chart/slurm_array.h"

#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/json_text.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

constexpr auto k_look_again = std::chrono::milliseconds(500);
constexpr std::size_t k_longest_array = 1000; // Slurm's own default allows indices up to 1000
constexpr int k_tries = 3;
constexpr int k_looks_until_lost = 10; // a file of another machine may take seconds to be seen here

/// The same for every chart: what is run, and where, comes as arguments, and a call's words as a file of their own that
/// no shell reads. $1: folder to run in; $2: the program; $3: folder of the calls.
constexpr const char* k_script = R"(#!/bin/sh
# A cell of tutu chart: the call that the job's index in the array names. Its end is told by a file.
#SBATCH --job-name=tutu-cell
#SBATCH --ntasks=1
cd "$1" || exit 1
n=$SLURM_ARRAY_TASK_ID
"$2" --arguments "$3/call-$n.json" > /dev/null 2> "$3/log-$n"
echo $? > "$3/end-$n.new" && mv "$3/end-$n.new" "$3/end-$n"
)";

/// tutu-cell beside this program.
fs::path cell_program() {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "tutu-cell";
  if (!fs::exists(program))
    throw InputError(program.string(), "", "no such program", "tutu-cell beside tutu, which the jobs of --slurm run");
  return program;
}

/// One submission: some of the calls, each with its line and its files.
class Submission {
public:
  Submission(const std::vector<std::vector<std::string>>& arguments, std::vector<std::size_t> which, fs::path folder)
      : which_(std::move(which)), folder_(std::move(folder)) {
    fs::create_directories(folder_);
    for (std::size_t line = 1; line <= which_.size(); ++line)
      write_file(folder_ / fmt::format("call-{}.json", line), json_text(arguments[which_[line - 1]]));
    write_file(folder_ / "array.sh", k_script);
    const ProcessEnd end = run_command({"sbatch", "--parsable", fmt::format("--array=1-{}", which_.size()),
                                        "--output=/dev/null", (folder_ / "array.sh").string(),
                                        fs::current_path().string(), cell_program().string(), folder_.string()});
    if (!end.good()) throw std::runtime_error("sbatch: " + end.last_message());
    job_ = end.output.substr(0, end.output.find_first_of(";\n")); // "id" or "id;cluster"
    for (std::size_t line = 1; line <= which_.size(); ++line) open_.insert(line);
  }

  bool done() const { return open_.empty(); }

  /// Tells of those that have ended since.
  void collect(const OnEnd& on_end) {
    for (auto line = open_.begin(); line != open_.end();) {
      const std::optional<ProcessEnd> end = end_of(*line);
      if (end) on_end(which_[*line - 1], *end);
      line = end ? open_.erase(line) : std::next(line);
    }
  }

  /// Slurm knows nothing of it any more, and that for a while.
  bool gone() {
    const ProcessEnd end = run_command({"squeue", "--noheader", "--jobs", job_});
    const bool unknown = end.messages.find("Invalid job id") != std::string::npos;
    const bool empty = end.good() && end.output.find_first_not_of(" \n") == std::string::npos;
    looks_without_ = unknown || empty ? looks_without_ + 1 : 0;
    return looks_without_ > k_looks_until_lost;
  }

  std::vector<std::size_t> lost() const {
    std::vector<std::size_t> calls;
    for (const std::size_t line : open_) calls.push_back(which_[line - 1]);
    return calls;
  }

  void cancel() const { run_command({"scancel", job_}); }

private:
  std::optional<ProcessEnd> end_of(std::size_t line) const {
    const fs::path file = folder_ / fmt::format("end-{}", line);
    if (!fs::exists(file)) return {};
    ProcessEnd end;
    const int status = std::atoi(read_file(file).c_str());
    if (status > 128) end.signal = status - 128; // as the shell tells of a signal
    else end.status = status;
    if (const fs::path log = folder_ / fmt::format("log-{}", line); fs::exists(log)) end.messages = read_file(log);
    return end;
  }

  std::vector<std::size_t> which_;
  fs::path folder_;
  std::string job_;
  std::set<std::size_t> open_; // lines without an end so far
  int looks_without_ = 0;
};

/// "1", "2" ...: the first that is not there.
fs::path new_folder(const fs::path& parent) {
  for (int n = 1;; ++n)
    if (fs::path folder = parent / std::to_string(n); !fs::exists(folder)) return folder;
}

/// All that is still missing, in arrays that Slurm takes.
std::vector<Submission> submit(const std::vector<std::vector<std::string>>& arguments,
                               const std::vector<std::size_t>& missing, const fs::path& folder) {
  std::vector<Submission> submissions;
  for (std::size_t begin = 0; begin < missing.size(); begin += k_longest_array) {
    const auto from = missing.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = missing.begin() + static_cast<std::ptrdiff_t>(std::min(missing.size(), begin + k_longest_array));
    submissions.emplace_back(arguments, std::vector<std::size_t>(from, to), new_folder(folder));
  }
  return submissions;
}

/// Until all have ended or are lost; these are returned.
std::vector<std::size_t> wait_for(std::vector<Submission>& submissions, const OnEnd& on_end,
                                  const std::function<bool()>& go_on) {
  std::vector<std::size_t> lost;
  while (!submissions.empty() && go_on()) {
    std::this_thread::sleep_for(k_look_again);
    for (auto submission = submissions.begin(); submission != submissions.end();) {
      submission->collect(on_end);
      const bool over = submission->done() || submission->gone();
      if (over) {
        submission->collect(on_end); // what came in meanwhile
        const auto rest = submission->lost();
        lost.insert(lost.end(), rest.begin(), rest.end());
      }
      submission = over ? submissions.erase(submission) : std::next(submission);
    }
  }
  return lost;
}

} // namespace

void require_slurm() {
  try {
    if (run_command({"sbatch", "--help"}).good()) return;
  } catch (const std::runtime_error&) {
  }
  throw InputError("", "--slurm", "no sbatch here",
                   "Slurm's commands (Debian: slurm-client) on a machine of a cluster");
}

void run_slurm_array(const std::vector<std::vector<std::string>>& arguments, const fs::path& folder,
                     const OnEnd& on_end, const std::function<bool()>& go_on) {
  std::vector<std::size_t> missing(arguments.size());
  for (std::size_t k = 0; k < missing.size(); ++k) missing[k] = k;
  for (int attempt = 0; attempt < k_tries && !missing.empty() && go_on(); ++attempt) {
    std::vector<Submission> submissions = submit(arguments, missing, folder);
    missing = wait_for(submissions, on_end, go_on);
    for (const Submission& submission : submissions) submission.cancel(); // interrupted
  }
  if (!go_on()) return;
  for (const std::size_t k : missing) {
    ProcessEnd end;
    end.status = 255;
    end.messages = fmt::format("lost by Slurm {} times", k_tries);
    on_end(k, end);
  }
}

} // namespace tutu::app
