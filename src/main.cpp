// tutu: garments on animated characters. Here is only the way from the command line to a command.
#include "src/commands/commands.h"

#include <fmt/format.h>

namespace {

constexpr const char* k_what_to_do = R"(tutu simulates garments on animated, skinned characters.

  tutu play              the dance, at once, in a window; ? there shows all keys
  tutu play SCENE.json   a scene of your own; or drop it, or a character, on the window
  tutu inspect FILE      what is understood of a character file
  tutu --help            all commands
)";

} // namespace

int main(int argc, char** argv) {
  using namespace tutu::app;
  CLI::App app{"tutu simulates garments on animated, skinned characters."};
  app.set_version_flag("--version", "tutu " TUTU_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  if (argc == 1) {
    fmt::print(stderr, "{}", k_what_to_do);
    return k_bad_input;
  }
  int status = k_ok;
  add_play(app, status);
  add_pose(app, status);
  add_drape(app, status);
  add_fit(app, status);
  add_inspect(app, status);
  add_validate(app, status);
  add_stability(app, status);
  add_mannequin(app, status);
  add_bench(app, status);
  add_cell(app, status);
  add_chart(app, status);
  add_plan(app, status);
  return run_program(app, argc, argv, status);
}
