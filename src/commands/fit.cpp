// tutu fit: proxies for a character, and what they cost in error.
#include "proxies/fit/fit.h"
#include "proxies/body/body_mesh.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/proxy_file.h"
#include "rig/error.h"
#include "rig/import/import.h"
#include "rig/io/clip_file.h"
#include "rig/io/file_io.h"
#include "rig/io/json_file.h"
#include "rig/strong_poses.h"
#include "src/base/interrupt.h"
#include "src/base/json_text.h"
#include "src/base/outputs.h"
#include "src/base/progress.h"
#include "src/commands/commands.h"
#include "src/options/import_options.h"
#include "src/options/scene_options.h"
#include "src/run/garment_reach.h"
#include "src/scene/load.h"
#include "src/study/report/gnuplot_chart.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

using nlohmann::ordered_json;
using Poses = std::vector<std::vector<Transform>>;

constexpr int k_clip_poses = 240; // sampled of a clip, at most; the fit takes the most different of them
constexpr int k_clip_rate = 30;   // 1/s, at most
constexpr int k_measured_poses = 60;
constexpr double k_default_cover = 3.0; // mm
constexpr double k_cost_points = 1000;  // points that ask, for the cost of a query

struct Options {
  std::string character, out, json, curve, region = "garment", kind = "capsule";
  std::optional<std::string> motion, garment;
  int count = 28;
  std::optional<double> max_error_mm, cover_mm;
  double under_weight = 1.0;
  bool no_symmetry = false;
  rig::ImportOptions import;
};

Poses poses_of(const rig::Clip& clip, const rig::Skeleton& skeleton) {
  const int count = std::clamp(static_cast<int>(std::ceil(clip.duration() * k_clip_rate)) + 1, 1, k_clip_poses);
  Poses poses;
  std::vector<Transform> local(skeleton.rest_local);
  for (int i = 0; i < count; ++i) {
    const double share = count > 1 ? static_cast<double>(i) / count : 0.0;
    rig::pose_at(clip, skeleton, share * clip.duration(), local, poses.emplace_back(skeleton.names.size()));
  }
  return poses;
}

/// The poses to fit, by what the user named: a clip's, a scene's, or the built-in ones.
Poses poses_for(const Options& options, const rig::Import& import, std::string& motion) {
  const rig::Skeleton& skeleton = import.character.skeleton;
  if (options.motion) {
    motion = std::filesystem::path(*options.motion).filename().string();
    std::vector<std::string> notes;
    const rig::RawClip clip = rig::read_clip(*options.motion, &notes);
    for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
    return poses_of(rig::build_clip(clip, skeleton), skeleton);
  }
  motion = "strong poses";
  Poses poses;
  for (const rig::NamedPose& pose : rig::strong_poses(skeleton)) poses.push_back(pose.model);
  if (poses.size() == 1)
    throw InputError(options.character, "", "no joint with the name of a leg or an arm",
                     "such names for the built-in poses, or --motion CLIP");
  return poses;
}

struct Garments {
  std::vector<cloth::Garment> garments;
  std::vector<std::vector<int>> joints; ///< [garment][attachment]
};

/// Of a scene file, or one garment file.
Garments garments_for(const Options& options, const rig::Character& character) {
  const std::filesystem::path file = *options.garment;
  Garments result;
  std::vector<GarmentEntry> entries = {{file, Vec3::Ones(), Vec3::Zero()}};
  if (JsonValue::read(file).has("character")) entries = read_scene(file).garments;
  if (entries.empty()) throw InputError(file.string(), "/garments", "none", "at least one garment");
  for (const GarmentEntry& entry : entries) {
    WornGarment worn = put_on(entry, character);
    result.garments.push_back(std::move(worn.garment));
    result.joints.push_back(std::move(worn.joints));
  }
  return result;
}

/// Drops what cannot be met, and says how far each of those is out of reach.
void leave_out(const Options& options, const rig::Character& character, const Poses& poses,
               std::vector<proxies::Proxy>& proxies, ordered_json& json) {
  const Garments garments = garments_for(options, character);
  const auto clearance = garment_clearance(character, garments.garments, garments.joints, poses, proxies);
  std::vector<proxies::Proxy> kept;
  json = ordered_json::array();
  for (std::size_t i = 0; i < proxies.size(); ++i) {
    if (!clearance[i]) {
      fmt::print("a garment hangs on no pin and may be anywhere: no proxy is left out\n");
      return;
    }
    json.push_back({{"name", proxies[i].name}, {"clearance_mm", 1e3 * *clearance[i]}, {"kept", *clearance[i] <= 0.0}});
    if (*clearance[i] <= 0.0) kept.push_back(proxies[i]);
    else fmt::print("left out: {}, {:.0f} mm beyond the reach of any cloth\n", proxies[i].name, 1e3 * *clearance[i]);
  }
  if (kept.empty())
    throw InputError(*options.garment, "", "a garment that reaches no part of the body", "one that does");
  fmt::print("{} of {} proxies can be met by {}\n", kept.size(), proxies.size(),
             std::filesystem::path(*options.garment).filename().string());
  proxies = std::move(kept);
}

/// Microseconds for k_cost_points points to ask one capsule, closed form, one thread: the least of some tries.
double query_us(const std::vector<proxies::Proxy>& proxies, const std::vector<Transform>& pose) {
  std::vector<proxies::Capsule> capsules;
  for (const proxies::Proxy& proxy : proxies)
    capsules.push_back({proxy.a.place(pose), proxy.b.place(pose), proxy.radius, proxy.taper});
  double least = 1e9, sum = 0.0;
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < static_cast<int>(k_cost_points); ++i)
      for (const proxies::Capsule& capsule : capsules)
        sum += proxies::signed_distance(Vec3(0.001 * i, 1.0, 0.3), capsule).distance;
    least =
        std::min(least, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
  }
  return sum < -1e9 ? 0.0 : least / static_cast<double>(capsules.size()); // the sum is looked at, so that it is made
}

ordered_json json_of(const proxies::FitSpread& s) {
  return {{"mean", 1e3 * s.mean}, {"rms", 1e3 * s.rms}, {"p95", 1e3 * s.p95},
          {"p99", 1e3 * s.p99},   {"max", 1e3 * s.max}, {"bound", 1e3 * s.bound}};
}

void print_side(const char* name, const proxies::FitSpread& s) {
  fmt::print("  {:<36} mean {:5.2f}  rms {:5.2f}  p95 {:5.2f}  p99 {:5.2f}  max {:5.1f}  nowhere above {:5.1f}\n", name,
             1e3 * s.mean, 1e3 * s.rms, 1e3 * s.p95, 1e3 * s.p99, 1e3 * s.max, 1e3 * s.bound);
}

/// One line for each count that is worth a look.
void print_curve(const std::vector<proxies::FitCurvePoint>& curve, double us) {
  fmt::print("\n  proxies   under p95/max, mm   over p95/max, mm   {:.0f} points ask all, us\n", k_cost_points);
  int last = 0;
  for (const proxies::FitCurvePoint& p : curve) {
    if (p.count < curve.back().count && p.count < last + std::max(2, last / 8)) continue;
    last = p.count;
    fmt::print("  {:7}   {:8.1f} / {:5.0f}    {:8.1f} / {:5.0f}   {:10.0f}\n", p.count, 1e3 * p.under_p95,
               1e3 * p.under_max, 1e3 * p.over_p95, 1e3 * p.over_max, us * p.count);
  }
}

Chart chart_of(const std::vector<proxies::FitCurvePoint>& curve, double us, const std::string& title) {
  Chart chart{title,
              "proxies",
              "error p95, mm",
              "1000 points ask all proxies, us",
              {{"under: skin sticks out", {}}, {"over: proxies stick out", {}}, {"query cost", {}, true}}};
  for (const proxies::FitCurvePoint& p : curve) {
    chart.lines[0].points.emplace_back(p.count, 1e3 * p.under_p95);
    chart.lines[1].points.emplace_back(p.count, 1e3 * p.over_p95);
    chart.lines[2].points.emplace_back(p.count, us * p.count);
  }
  return chart;
}

/// Every so many of the poses, the first among them.
Poses thinned(const Poses& poses, std::size_t most) {
  Poses result;
  const std::size_t count = std::min(most, poses.size());
  for (std::size_t i = 0; i < count; ++i) result.push_back(poses[i * poses.size() / count]);
  return result;
}

proxies::FitNote::Side side_of(const proxies::FitSpread& s) { return {1e3 * s.p95, 1e3 * s.max, 1e3 * s.bound}; }

int run(const Options& options) {
  catch_interrupt();
  if (!options.curve.empty()) require_chart(options.curve);
  std::vector<std::filesystem::path> inputs = {options.character};
  if (options.motion) inputs.emplace_back(*options.motion);
  if (options.garment) inputs.emplace_back(*options.garment);
  check_outputs({{"--out", options.out}, {"--curve", options.curve}, {"--json", options.json}}, inputs);
  rig::Import import = rig::import_character(options.character, options.import);
  rig::Character& character = import.character;
  std::string motion;
  const Poses poses = poses_for(options, import, motion);
  // What is wrong with garment and body is said before the work.
  if (options.garment) garments_for(options, character);
  const proxies::BodyMesh body = body_of(character);
  if (const auto note = proxies::note_of(body.census())) {
    fmt::print(stderr, "note: {}: {}\n", std::filesystem::path(options.character).filename().string(), *note);
    character.mesh.triangles.assign(body.triangles().begin(), body.triangles().end());
  }
  const auto region = options.region == "body" ? proxies::FitRegion::body : proxies::FitRegion::garment;
  proxies::FitOptions fit;
  fit.count = options.max_error_mm && options.count == Options{}.count ? 128 : options.count;
  if (options.max_error_mm) fit.max_error = 1e-3 * *options.max_error_mm;
  if (options.cover_mm) fit.cover = 1e-3 * *options.cover_mm;
  fit.under_weight = options.under_weight;
  fit.region = region;
  fit.tapered = options.kind == "tapered";
  fit.symmetric = !options.no_symmetry;

  const auto start = std::chrono::steady_clock::now();
  proxies::FitResult result;
  proxies::FitError error;
  ordered_json reach;
  try {
    Progress bar("fitting", 100);
    result = proxies::fit_proxies(character, poses, fit, [&](double share) {
      bar.tick(static_cast<int>(100.0 * share));
      return !interrupted();
    });
    bar.tick(100);
  } catch (const std::invalid_argument& problem) {
    throw InputError(options.character, "", problem.what(), "a character that can be fitted");
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (result.interrupted) fmt::print(stderr, "tutu: interrupted; this is the best so far\n");
  catch_interrupt(); // a second Ctrl-C ends the measuring
  if (options.garment) leave_out(options, character, poses, result.proxies, reach);
  const Poses measured = thinned(poses, k_measured_poses);
  {
    Progress bar("measuring", 100);
    error = proxies::measure_fit(character, measured, result.proxies, region, 3000, [&](double share) {
      bar.tick(static_cast<int>(100.0 * share));
      return !interrupted();
    });
  }

  fmt::print("{} proxies in {:.1f} s; {}; {}{}\n", result.proxies.size(), seconds,
             region == proxies::FitRegion::garment ? "the body without head, hands and toes" : "the whole body", motion,
             result.symmetric ? "; left and right alike" : "");
  fmt::print("error in mm, at points of its own in {} poses of linear blend skinning:\n", error.poses);
  print_side("under (skin sticks out of proxies)", error.under);
  print_side("over (proxies stick out of skin)", error.over);
  const double us = query_us(result.proxies, poses.front());
  print_curve(result.curve, us);
  if (!options.curve.empty())
    write_chart(
        chart_of(result.curve, us, std::filesystem::path(options.character).filename().string() + ", " + motion),
        options.curve);
  if (!options.out.empty()) {
    const proxies::FitNote note{std::filesystem::path(options.character).filename().string(),
                                motion,
                                options.region,
                                error.poses,
                                side_of(error.under),
                                side_of(error.over)};
    proxies::write_proxies(options.out, result.proxies, character.skeleton, note);
    fmt::print("\n{}: {} proxies\n", options.out, result.proxies.size());
  }
  if (!options.json.empty()) {
    ordered_json json = {{"character", options.character},   {"motion", motion},
                         {"region", options.region},         {"kind", options.kind},
                         {"count", result.proxies.size()},   {"poses", error.poses},
                         {"symmetric", result.symmetric},    {"interrupted", result.interrupted},
                         {"under_mm", json_of(error.under)}, {"over_mm", json_of(error.over)}};
    json["curve"] = ordered_json::array();
    for (const proxies::FitCurvePoint& p : result.curve)
      json["curve"].push_back({{"count", p.count},
                               {"under_mm", {{"p95", 1e3 * p.under_p95}, {"max", 1e3 * p.under_max}}},
                               {"over_mm", {{"p95", 1e3 * p.over_p95}, {"max", 1e3 * p.over_max}}},
                               {"query_us", us * p.count}});
    json["bound_mm"] = 1e3 * std::max(error.under.bound, error.over.bound);
    if (options.garment) json["reach"] = reach;
    json["seconds"] = seconds;
    write_file(options.json, json_text(json));
  }
  if (!result.met) fmt::print(stderr, "tutu: the tolerance is not met with {} proxies\n", result.proxies.size());
  return result.met && !result.interrupted ? k_ok : k_not_met;
}

} // namespace

void add_fit(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("fit", "Make proxies for a character and say how far they are from its skin");
  auto options = std::make_shared<Options>();
  command->add_option("CHARACTER", options->character, "Rigged character: .dae .gltf .glb .vrm .fbx .x")->required();
  command->add_option("--motion", options->motion, "Clip (.json) whose poses count; else some 40 strong poses");
  command->add_option("--count", options->count, "How many proxies; with --max-error-mm, the most (128 there)")
      ->check(CLI::Range(1, proxies::k_most_fit_shapes))
      ->capture_default_str();
  command
      ->add_option("--kind", options->kind,
                   "capsule: one radius; tapered: a radius at each end. Spheres where both ends meet")
      ->check(CLI::IsMember({"capsule", "tapered"}))
      ->capture_default_str();
  command
      ->add_option("--max-error-mm", options->max_error_mm,
                   "Add proxies until 95 % of skin and proxies are nearer than this")
      ->check(finite_number())
      ->check(CLI::PositiveNumber);
  command->add_option("--cover", options->cover_mm, "No skin sticks out by more than so many mm; proxies do the more")
      ->expected(0, 1)
      ->default_str(fmt::format("{:g}", k_default_cover))
      ->check(finite_number())
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--under-weight", options->under_weight,
                   "How much worse skin outside the proxies is than proxies outside the skin, squared")
      ->check(finite_number())
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  command->add_option("--for", options->garment, "Scene or garment (.json): leave out what its cloth can never reach");
  command->add_option("--region", options->region, "garment: without head, hands and toes; body: all of it")
      ->check(CLI::IsMember({"garment", "body"}))
      ->capture_default_str();
  command->add_flag("--no-symmetry", options->no_symmetry, "Fit left and right apart");
  command->add_option("-o,--out", options->out, "Proxies file to write (.json)");
  command->add_option("--json", options->json, "Write the figures for machines");
  command->add_option("--curve", options->curve, "Draw proxies : error : query cost (.svg or .png, by gnuplot)");
  add_import_options(*command, options->import);
  command->callback([options, &status] { status = run(*options); });
}

} // namespace tutu::app
