// tutu-cell: what `tutu cell` does, as a program that links nothing that draws.
#include "src/commands/commands.h"

int main(int argc, char** argv) {
  using namespace tutu::app;
  CLI::App app{"tutu-cell cell: one setting of a scene, measured; the command of tutu for machines without a screen."};
  app.set_version_flag("--version", "tutu-cell " TUTU_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  int status = k_ok;
  add_cell(app, status);
  // Words from a file, for who starts it where a shell would read them (the jobs of tutu chart --slurm).
  if (argc == 3 && std::string_view(argv[1]) == "--arguments") return run_program_on_file(app, argv[2], status);
  return run_program(app, argc, argv, status);
}
