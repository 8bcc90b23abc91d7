#include "src/options/program.h"

#include "rig/error.h"
#include "rig/io/file_io.h"
#include "rig/text.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>

namespace tutu::app {
namespace {

int tell(const std::string& what) {
  fmt::print(stderr, "tutu: {}\n", plain_text(what, '?')); // one line, whatever names are in it
  return k_bad_input;
}

/// "PATH: REASON" of what the file system refused.
std::string words_of(const std::filesystem::filesystem_error& error) {
  std::string text;
  for (const std::filesystem::path& path : {error.path1(), error.path2()})
    if (!path.empty()) text += plain_text(path.string(), '?') + ": ";
  return text + error.code().message();
}

int run(CLI::App& app, const std::function<void()>& parse, const int& status) {
  try {
    parse();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? k_ok : k_bad_input;
  } catch (const InputError& error) {
    return tell(error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return tell(words_of(error));
  } catch (const std::bad_alloc&) {
    return tell("not enough memory for this; TUTU_MEMORY_GIB bounds what descriptions may take");
  } catch (const std::exception& error) { // a disk that is full, a driver that is missing
    return tell(error.what());
  }
  return status;
}

} // namespace

int run_program(CLI::App& app, int argc, const char* const* argv, const int& status) {
  return run(
      app, [&] { app.parse(argc, argv); }, status);
}

int run_program_on_file(CLI::App& app, const std::filesystem::path& file, const int& status) {
  return run(
      app,
      [&] {
        const auto json = nlohmann::json::parse(read_file(file)); // written by run_slurm_array
        auto words = json.get<std::vector<std::string>>();
        std::reverse(words.begin(), words.end()); // CLI11 takes them from the end
        app.parse(words);
      },
      status);
}

void print_warning(const std::string& warning) {
  if (warning.empty()) return;
  std::fflush(stdout);
  fmt::print(stderr, "tutu: warning: {}\n", plain_text(warning, '?'));
}

} // namespace tutu::app
