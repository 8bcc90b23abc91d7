// Cells as processes of their own, some at a time: what crashes takes nothing else along.
#pragma once

#include "src/base/child_process.h"

#include <functional>

namespace tutu::app {

using OnEnd = std::function<void(std::size_t, const ProcessEnd&)>;

/// Runs this very program once for each list of arguments, `jobs` at a time. `on_end` is called here for each that
/// ends. When `go_on` says no, the running ones are interrupted (SIGINT) and waited for, and no other is started.
void run_processes(const std::vector<std::vector<std::string>>& arguments, int jobs, const OnEnd& on_end,
                   const std::function<bool()>& go_on);

} // namespace tutu::app
