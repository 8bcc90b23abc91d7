// Cells as a job array of Slurm: as run_processes, on as many machines as the cluster gives.
#pragma once

#include "src/study/chart/cell_processes.h"

#include <filesystem>

namespace tutu::app {

/// Throws InputError when Slurm's commands are not here.
void require_slurm();

/// Writes the commands and a script into a new folder of `folder`, which all machines must see under this name, as they
/// must this program; submits them, and waits. A job that is gone without having told its end (its machine was lost) is
/// submitted again, three times in all. When `go_on` says no, what waits or runs is cancelled. Throws
/// std::runtime_error with sbatch's words when nothing can be submitted.
void run_slurm_array(const std::vector<std::vector<std::string>>& arguments, const std::filesystem::path& folder,
                     const OnEnd& on_end, const std::function<bool()>& go_on);

} // namespace tutu::app
