#include "src/options/program.h"

#include "rig/error.h"

#include <fmt/format.h>

namespace tutu::app {

int run_program(CLI::App& app, int argc, const char* const* argv, const int& status) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? k_ok : k_bad_input;
  } catch (const InputError& error) {
    fmt::print(stderr, "tutu: {}\n", error.what());
    return k_bad_input;
  } catch (const std::exception& error) { // a disk that is full, a driver that is missing
    fmt::print(stderr, "tutu: {}\n", error.what());
    return k_bad_input;
  }
  return status;
}

} // namespace tutu::app
