#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/interrupt.h"
#include "src/base/json_text.h"
#include "src/base/outputs.h"
#include "src/base/progress.h"
#include "src/commands/commands.h"
#include "src/measure/frame_metrics.h"
#include "src/measure/uneven_json.h"
#include "src/options/setting_options.h"
#include "src/run/session.h"
#include "src/study/bench/dancer_skirt.h"
#include "src/study/bench/stability_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

using nlohmann::json;

constexpr const char* k_dancer_skirt = "dancer-skirt";
/// The first second starts the motion softly and lets the cloth fall; it is not measured.
constexpr int k_first_measured = 60;

struct Options {
  std::string name = k_dancer_skirt, json;
  int n = 30, frames = k_dancer_frames, runs = k_stability_runs;
  std::vector<SettingChange> changes;
  bool still = false;
};

/// Gives `settings` what was asked for, where cloth in rows and columns, as all of these scenes wear, honours it.
void take_changes(const std::vector<SettingChange>& changes, RunSettings& settings) {
  for (const SettingChange& change : changes) change.row->set(settings, change.value);
  if (settings.backend == proxies::Backend::mesh)
    throw InputError("", "--backend", "mesh", "a backend of proxies: these scenes have no body");
  const cloth::Garment woven = dancer_skirt(8);
  for (const SettingChange& change : changes)
    if (const auto wrong = unhonoured(*change.row, settings, {&woven, 1}))
      throw InputError("", change.by, wrong->found, wrong->expected);
}

struct Run {
  std::vector<FrameMetrics> metrics; ///< of the measured frames
  std::vector<double> ms;
  std::optional<RunFailure> failure;
  RunEnd end;
};

Run run_scene(DancerSkirt& scene, int frames) {
  Run run;
  const double frame_seconds = 1.0 / k_dancer_frames_per_second;
  const ClothProbe probe(scene.skirt());
  std::vector<Vec3> last = scene.particles().positions, before_last = last;
  Progress bar(fmt::format("{} {}", k_dancer_skirt, scene.setup().n), frames);
  while (scene.frame() < frames && !interrupted()) {
    const int frame = scene.frame();
    before_last.swap(last);
    last = scene.particles().positions;
    if (const auto divergence = scene.advance()) {
      const double moment = scene.time() + frame_seconds * (divergence->substep + 1) / scene.setup().substeps;
      run.failure = RunFailure{scene.skirt().name, *divergence, frame, moment};
      break;
    }
    if (frame >= k_first_measured) {
      run.metrics.push_back(
          measure_frame(probe, scene.particles().positions, last, before_last, scene.proxies(), frame_seconds));
      run.ms.push_back(scene.cpu_ms());
    }
    bar.tick(scene.frame());
  }
  bar.finish();
  ClothDepths depths;
  probe.measure(scene.proxies(), std::nullopt, scene.particles().positions, depths);
  run.end.garments.push_back(
      {scene.skirt().name, cloth::longest_thread(probe.parts(), scene.particles().positions), deepest_of(depths), {}});
  return run;
}

std::string_view backend_of(const DancerSkirt& scene) {
  return proxies::k_backend_names[static_cast<std::size_t>(scene.setup().backend)];
}

double ns_per_particle_substep(const RunMetrics& m, const DancerSkirtSetup& setup) {
  return 1e6 * m.ms_median / (static_cast<double>(setup.n) * setup.n * setup.substeps);
}

/// Figures that were never measured (a run that diverged early) are null.
json json_of(const Options& options, const DancerSkirt& scene, const RunMetrics& m, const Run& run) {
  const auto figure = [&](double value) { return m.frames > 0 ? json(value) : json(nullptr); };
  const auto mm = [&](double metres) { return figure(1000.0 * metres); };
  const auto percent = [&](double share) { return figure(100.0 * share); };
  const auto strains = [&](const StrainOverFrames& s) {
    return json{{"max", percent(s.worst.max)},
                {"median", percent(s.worst.median)},
                {"p99", percent(s.p99)},
                {"mean", percent(s.mean)}};
  };
  json result = {{"name", options.name},
                 {"n", options.n},
                 {"solver", cloth::name_of(scene.setup().solver)},
                 {"substeps", scene.setup().substeps},
                 {"backend", backend_of(scene)},
                 {"still", options.still},
                 {"offset_mm", 1000.0 * scene.skirt().fabric.contact_offset()},
                 {"friction", scene.setup().solver == cloth::SolverKind::xpbd ? k_dancer_friction : 0.0},
                 {"threads", 1},
                 {"frames", scene.frame()},
                 {"measured_frames", m.frames},
                 {"pen_mm",
                  {{"max", mm(m.pen.max)},
                   {"median", mm(m.pen.median)},
                   {"mean", mm(m.pen_mean)},
                   {"share_over_1mm", figure(m.pen_share)}}},
                 {"cen_mm", {{"max", mm(m.cen.max)}, {"median", mm(m.cen.median)}, {"mean", mm(m.cen_mean)}}},
                 {"surface_mm", {{"max", mm(m.surface.max)}, {"median", mm(m.surface.median)}}},
                 {"longer_pct", strains(m.longer)},
                 {"shorter_pct", strains(m.shorter)},
                 {"held_longer_pct", strains(m.held_longer)},
                 {"jitter", figure(m.jitter)},
                 {"hem_y", figure(m.hem_y)},
                 {"ms", {{"median", figure(m.ms_median)}, {"p99", figure(m.ms_p99)}}},
                 {"ns_per_particle_substep", figure(ns_per_particle_substep(m, scene.setup()))},
                 {"diverged", run.failure.has_value()},
                 {"end", run.end.json()},
                 {"state_hash", fmt::format("{:016x}", cloth::state_hash(scene.particles()))}};
  result.update(uneven_json(scene.setup()));
  if (run.failure) result["failure"] = run.failure->message();
  return result;
}

std::string text_of(const Options& options, const DancerSkirt& scene, const RunMetrics& m) {
  std::string text =
      fmt::format("{}{}: {} x {} particles, {} proxies, {} ({}), {} substeps a frame, contact offset {:.1f} mm, start "
                  "uneven by {:g} mm (seed {})\n",
                  options.name, options.still ? " (still)" : "", options.n, options.n, k_dancer_proxies,
                  cloth::name_of(scene.setup().solver), backend_of(scene), scene.setup().substeps,
                  1000.0 * scene.skirt().fabric.contact_offset(), scene.setup().uneven_mm, scene.setup().seed);
  if (m.frames == 0)
    return text + fmt::format("diverged or stopped before frame {}: nothing measured\n", k_first_measured);
  const auto row = [&](const char* what, const char* unit, const OverFrames& worst, double scale,
                       const std::string& more) {
    text +=
        fmt::format("{:<22}{:<5}{:>10.3f}{:>10.3f}   {}\n", what, unit, scale * worst.max, scale * worst.median, more);
  };
  text += fmt::format("{:<27}{:>10}{:>10}   (of a frame's worst, frames {} to {})\n", "", "max", "median",
                      k_first_measured, k_first_measured + m.frames - 1);
  row("particles in proxies", "mm", m.pen, 1e3,
      fmt::format("mean {:.4f}, {:.2f} % deeper than 1 mm", 1e3 * m.pen_mean, 1e2 * m.pen_share));
  row("centroids in proxies", "mm", m.cen, 1e3, fmt::format("mean {:.4f}", 1e3 * m.cen_mean));
  row("surface in proxies", "mm", m.surface, 1e3, fmt::format("{} samples a triangle", k_surface_samples));
  const auto strains = [&](const char* what, const StrainOverFrames& s) {
    row(what, "%", s.worst, 1e2, fmt::format("p99 {:.2f}, mean {:.2f}", 1e2 * s.p99, 1e2 * s.mean));
  };
  strains("threads longer", m.longer);
  strains("threads shorter", m.shorter);
  strains("held threads longer", m.held_longer);
  text += fmt::format("jitter {:.2f} m/s2, hem at {:.3f} m\n{:.3f} ms a frame (p99 {:.3f}), {:.1f} ns a particle and "
                      "substep\nstate hash {:016x}\n",
                      m.jitter, m.hem_y, m.ms_median, m.ms_p99, ns_per_particle_substep(m, scene.setup()),
                      cloth::state_hash(scene.particles()));
  return text;
}

int run_dancer_skirt(const Options& options) {
  DancerSkirtSetup setup;
  setup.n = options.n;
  setup.substeps = 0;
  take_changes(options.changes, setup);
  if (setup.substeps == 0) setup.substeps = default_substeps(setup.solver, setup.n);
  setup.motion = options.still ? DancerMotion::still : DancerMotion::dance;
  DancerSkirt scene(setup);
  const Run done = run_scene(scene, options.frames);
  const RunMetrics metrics = summarise(done.metrics, done.ms);
  if (!options.json.empty()) write_file(options.json, json_text(json_of(options, scene, metrics, done)));
  fmt::print("{}", text_of(options, scene, metrics));
  if (done.failure) fmt::print(stderr, "tutu: {}\n", done.failure->message());
  if (interrupted()) fmt::print(stderr, "tutu: interrupted after {} of {} frames\n", scene.frame(), options.frames);
  print_warning(done.end.warning());
  return done.failure || interrupted() ? k_not_met : k_ok;
}

int run_stability_family(const Options& options) {
  RunSettings setup;
  take_changes(options.changes, setup);
  const StabilityReport report = report_stability(options.name, setup, options.runs, [] { return !interrupted(); });
  if (!options.json.empty()) write_file(options.json, json_text(report.json));
  fmt::print("{}", report.text);
  if (interrupted()) fmt::print(stderr, "tutu: interrupted\n");
  print_warning(report.end.warning());
  return report.passed ? k_ok : k_not_met;
}

/// Options that mean nothing for the scene are refused: `of_skirt` were given that belong to the one, `of_others` to
/// the others.
void refuse_foreign(const std::string& name, const std::vector<CLI::Option*>& of_skirt,
                    const std::vector<CLI::Option*>& of_others) {
  const bool skirt = name == k_dancer_skirt;
  for (const CLI::Option* option : skirt ? of_others : of_skirt)
    if (option->count() > 0)
      throw InputError("", option->get_name(), "it with " + name,
                       std::string("it with ") + (skirt ? "a scene of stability" : k_dancer_skirt) + " only");
}

} // namespace

void add_bench(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("bench", "Run a standard scene and measure speed and accuracy together");
  auto options = std::make_shared<Options>();
  std::vector<std::string> names = stability_names();
  names.insert(names.begin(), k_dancer_skirt);
  command->add_option("name", options->name, "The scene")->required()->check(CLI::IsMember(names));
  add_setting_options(
      *command, options->changes,
      {"solver", "backend", "substeps", "features", "swept", "passes", "double_precision", "self_collision"});
  command->add_option("--json", options->json, "Write the figures to this file");

  const std::string group = k_dancer_skirt;
  std::vector<CLI::Option*> of_skirt = {
      command->add_option("--n", options->n, "Particles along each side of the cloth")
          ->check(CLI::Range(8, 1024))
          ->capture_default_str()
          ->group(group),
      command->add_option("--frames", options->frames, "Frames to run; the first 60 are not measured")
          ->check(CLI::Range(k_first_measured + 1, 1000000))
          ->capture_default_str()
          ->group(group),
      command->add_flag("--still", options->still, "The dancer stands still")->group(group)};
  for (CLI::Option* option : add_setting_options(*command, options->changes, {"uneven_mm", "seed"}))
    of_skirt.push_back(option);
  std::vector<CLI::Option*> of_others = add_setting_options(*command, options->changes, {"adaptive_substeps"});
  of_others.push_back(command->add_option("--runs", options->runs, "Uneven starts of each variant")
                          ->check(CLI::Range(1, 1000))
                          ->capture_default_str()
                          ->group("scenes of stability"));
  command->callback([options, of_skirt, of_others, &status] {
    refuse_foreign(options->name, of_skirt, of_others);
    check_outputs({{"--json", options->json}}, {});
    catch_interrupt();
    status = options->name == k_dancer_skirt ? run_dancer_skirt(*options) : run_stability_family(*options);
  });
}

} // namespace tutu::app
