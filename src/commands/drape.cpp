#include "src/run/drape.h"
#include "cloth/garment/drape_file.h"
#include "cloth/state/tolerances.h"
#include "src/base/interrupt.h"
#include "src/base/outputs.h"
#include "src/base/progress.h"
#include "src/commands/commands.h"
#include "src/options/scene_options.h"
#include "src/run/session.h"
#include "src/scene/load.h"

#include <fmt/format.h>

namespace tutu::app {
namespace {

struct Options {
  SceneOptions scene;
  std::string out;
  double seconds = 10.0;
};

int run(const Options& options) {
  catch_interrupt();
  const LoadedScene scene = options.scene.load();
  const std::filesystem::path file = options.out.empty() ? scene.files.drape : std::filesystem::path(options.out);
  check_outputs({{options.out.empty() ? "the scene's drape" : "--out", file}}, inputs_of(scene.files));
  const int frames = static_cast<int>(options.seconds * scene.settings.frames_per_second);
  Progress bar("draping " + scene.name(), frames);
  const DrapeResult result = drape(
      scene, options.seconds,
      [&](int done, int) {
        bar.tick(done);
        return !interrupted();
      },
      &interrupt_flag());
  bar.finish();
  if (result.failure) {
    fmt::print(stderr, "tutu: {}\n", result.failure->message());
    return k_not_met;
  }
  if (interrupted()) {
    fmt::print(stderr, "tutu: interrupted; nothing written\n");
    return k_not_met;
  }
  cloth::Drape saved;
  saved.fingerprint = drape_fingerprint(scene);
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    saved.garments.push_back({scene.garments[g].name, result.positions[g]});
  cloth::write_drape(saved, file);
  const bool settled = result.fastest < cloth::k_settled_speed;
  fmt::print("{}: {} after {:.1f} s, the fastest particle at {:.1f} mm/s\n", file.string(),
             settled ? "settled" : "not quite settled", result.seconds, 1000.0 * result.fastest);
  return k_ok;
}

} // namespace

void add_drape(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("drape", "Settle a scene's garments on the still body and save them");
  auto options = std::make_shared<Options>();
  options->scene.add_to(*command);
  command->add_option("-o,--out", options->out, "File to write, in place of the scene's own (SCENE.drape.json)");
  command->add_option("--seconds", options->seconds, "Longest simulated time")
      ->check(finite_number())
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  command->callback([options, &status] { status = run(*options); });
}

} // namespace tutu::app
