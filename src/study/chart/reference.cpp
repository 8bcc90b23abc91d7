#include "src/study/chart/reference.h"

#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/content_hash.h"
#include "src/base/progress.h"
#include "src/base/workers.h"
#include "src/run/drape.h"
#include "src/scene/load.h"
#include "src/study/chart/reference_file.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fmt/format.h>
#include <mutex>
#include <numeric>
#include <stdexcept>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

Refinement refinement(const std::vector<cloth::Garment>& garments, const Reference& coarse, const Reference& fine) {
  const RunErrors e = errors_against(garments, fine.trajectory, garments, coarse.trajectory);
  return {coarse.substeps, fine.substeps, e.trajectory_rms, e.trajectory_max, e.drape_rms, e.drape_hausdorff};
}

/// One level's file, as long as the reference is not whole.
fs::path level_path(fs::path reference, int substeps) {
  return reference.replace_extension(fmt::format("level-{}.json", substeps));
}

/// Levels in the making, several at a time, with one bar for all.
class Levels {
public:
  Levels(const LoadedScene& scene, const ReferencePlan& plan, fs::path path, const std::function<bool()>& go_on)
      : scene_(&scene), plan_(&plan), path_(std::move(path)), go_on_(&go_on),
        fingerprint_(reference_fingerprint(scene, plan)), levels_(plan.substeps.size()) {}

  /// What is done already.
  void read() {
    for (std::size_t k = 0; k < levels_.size(); ++k)
      if (const fs::path file = level_path(path_, plan_->substeps[k]); fs::exists(file))
        levels_[k] = reference_from(file, *scene_, *plan_);
  }

  void make(const GarmentPositions& start, int jobs) {
    std::vector<std::size_t> missing;
    int total = 0;
    for (std::size_t k = levels_.size(); k-- > 0;) // the longest first
      if (!levels_[k]) {
        missing.push_back(k);
        total += plan_->substeps[k] * frames();
      }
    Progress bar("reference", total);
    std::atomic<int> done = 0;
    std::mutex drawing;
    Workers workers(std::clamp(jobs, 1, std::max(1, static_cast<int>(missing.size()))));
    workers.for_each(missing.size(), [&](std::size_t m) {
      make_level(missing[m], start, [&, substeps = plan_->substeps[missing[m]]] {
        done += substeps;
        const std::lock_guard lock(drawing);
        bar.tick(done);
        return (*go_on_)();
      });
    });
    bar.finish();
  }

  /// Nothing when a level is missing.
  std::optional<Reference> whole() {
    if (!std::all_of(levels_.begin(), levels_.end(), [](const auto& level) { return level.has_value(); })) return {};
    Reference reference = *levels_.back();
    const LoadedScene scene = with_setting(*scene_, reference_setting(*scene_, *plan_, reference.substeps));
    for (std::size_t k = 0; k + 1 < levels_.size(); ++k)
      reference.refinements.push_back(refinement(scene.garments, *levels_[k], *levels_[k + 1]));
    write_reference(reference, path_);
    for (const int substeps : plan_->substeps) fs::remove(level_path(path_, substeps));
    return reference;
  }

private:
  int frames() const { return plan_->protocol.frames + plan_->protocol.settle + plan_->protocol.held; }

  void make_level(std::size_t k, const GarmentPositions& start, const std::function<bool()>& go_on) {
    if (!go_on()) return;
    const int substeps = plan_->substeps[k];
    const LoadedScene scene = with_setting(*scene_, reference_setting(*scene_, *plan_, substeps));
    CellRun run = run_cell(scene, start_at_resolution(*scene_, start, plan_->resolution), plan_->protocol, false,
                           [&](const CellRun&) { return go_on(); });
    if (run.stopped) return;
    const std::string trouble = run.recoveries > 0 ? fmt::format("{} frames diverged", run.recoveries) : run.failure;
    if (!trouble.empty())
      throw std::runtime_error(
          fmt::format("the reference of {} in {} substeps: {}", scene_->name(), substeps, trouble));
    levels_[k] = Reference{scene_->name(),  fingerprint_, substeps, plan_->resolution,
                           plan_->protocol, start,        {},       std::move(run.trajectory)};
    write_reference(*levels_[k], level_path(path_, substeps));
  }

  const LoadedScene* scene_;
  const ReferencePlan* plan_;
  fs::path path_;
  const std::function<bool()>* go_on_;
  std::string fingerprint_;
  std::vector<std::optional<Reference>> levels_;
};

/// Its poses at the keys and between them, where the law shows.
void add_motion(const LoadedScene& scene, ContentHash& hash) {
  const std::vector<double> keys = rig::key_times(scene.motion);
  std::vector<Transform> pose(scene.character.skeleton.rest_local);
  const auto add = [&](double time) {
    hash.add(time);
    rig::sample(scene.motion, time, pose);
    for (const Transform& t : pose) {
      hash.add(t.translation);
      hash.add(Vec3(t.rotation.x(), t.rotation.y(), t.rotation.z()));
    }
  };
  for (std::size_t k = 0; k < keys.size(); ++k) {
    add(keys[k]);
    if (k + 1 < keys.size()) add(0.5 * (keys[k] + keys[k + 1]));
  }
}

} // namespace

std::string reference_fingerprint(const LoadedScene& scene, const ReferencePlan& plan) {
  ContentHash hash;
  hash.add(std::string_view(TUTU_VERSION));
  hash.add(drape_fingerprint(scene));
  hash.add(scene.settings.uneven_mm);
  hash.add(static_cast<std::uint64_t>(scene.settings.seed));
  const rig::Mesh& mesh = scene.character.mesh;
  for (const Vec3f& p : mesh.positions) hash.add(Vec3(p.cast<double>()));
  for (const rig::Triangle& t : mesh.triangles)
    for (const std::uint32_t corner : t) hash.add(std::uint64_t{corner});
  for (const float weight : scene.character.skin.weights) hash.add(static_cast<double>(weight));
  for (const auto slot : scene.character.skin.slots) hash.add(static_cast<std::uint64_t>(slot));
  add_motion(scene, hash);
  for (const cloth::Garment& garment : scene.garments) hash.add(garment.fabric.damping);
  for (const cloth::Garment& garment : scene.garments)
    for (const auto& t : garment.triangles)
      for (const std::uint32_t corner : t) hash.add(std::uint64_t{corner});
  if (const auto& gusts = scene.wind.gusts) { // of the wind the drape knows the rest
    for (const double number : {gusts->speed, gusts->period}) hash.add(number);
    hash.add(gusts->seed);
  }
  const Protocol& p = plan.protocol;
  for (const int frames : {p.frames, p.settle, p.held, p.every}) hash.add(static_cast<std::uint64_t>(frames));
  for (const int substeps : plan.substeps) hash.add(static_cast<std::uint64_t>(substeps));
  hash.add(plan.resolution);
  return hash.text();
}

Setting reference_setting(const LoadedScene& scene, const ReferencePlan& plan, int substeps) {
  Setting setting = own_setting(scene.settings);
  setting.name = "reference";
  setting.solver = cloth::SolverKind::xpbd;
  setting.backend = proxies::Backend::mesh;
  setting.substeps = substeps;
  setting.adaptive_substeps = false; // the same steps all through, or refinements would not be comparable
  setting.double_precision = true;
  setting.resolution = plan.resolution;
  setting.threads = 1;
  return setting;
}

fs::path default_cache() {
  const char* chosen = std::getenv("XDG_CACHE_HOME");
  if (chosen && *chosen) return fs::path(chosen) / "tutu";
  const char* home = std::getenv("HOME");
  return fs::path(home ? home : ".") / ".cache" / "tutu";
}

fs::path reference_path(const fs::path& cache, const LoadedScene& scene, const ReferencePlan& plan) {
  return cache / fmt::format("{}-{}.json", scene.name(), reference_fingerprint(scene, plan));
}

Reference reference_from(const fs::path& file, const LoadedScene& scene, const ReferencePlan& plan) {
  Reference reference = read_reference(file, scene.name(), reference_fingerprint(scene, plan));
  // A checksum tells damage; a file that was made up has one that fits.
  const auto check = [&](const char* place, const GarmentPositions& positions,
                         const std::vector<cloth::Garment>& garments) {
    const auto is_of = [](const std::vector<Vec3>& of, const cloth::Garment& garment) {
      return of.size() == garment.rest_positions.size();
    };
    if (!std::equal(positions.begin(), positions.end(), garments.begin(), garments.end(), is_of))
      throw InputError(file.string(), place, "positions of other garments", "those of " + scene.name());
  };
  check("/start", reference.start, scene.garments);
  const Setting setting = reference_setting(scene, plan, reference.substeps);
  check("/drape_um", reference.trajectory.drape, with_setting(scene, setting).garments);
  return reference;
}

std::optional<Reference> obtain_reference(const LoadedScene& scene, const ReferencePlan& plan, const fs::path& cache,
                                          int jobs, const std::function<std::optional<GarmentPositions>()>& start,
                                          const std::function<bool()>& go_on) {
  const fs::path path = reference_path(cache, scene, plan);
  sweep_leftovers(cache);
  if (fs::exists(path)) return reference_from(path, scene, plan);
  fs::create_directories(cache);
  Levels levels(scene, plan, path, go_on);
  levels.read();
  if (auto reference = levels.whole()) return reference;
  const auto positions = start();
  if (!positions) return {};
  levels.make(*positions, jobs);
  return levels.whole();
}

std::string convergence_text(const Reference& reference) {
  std::string text;
  for (const Refinement& r : reference.refinements)
    text += fmt::format("reference, {:>4} to {:>4} substeps: first second {:.3f} mm RMS, {:.2f} at most; drape {:.3f} "
                        "RMS, {:.2f} Hausdorff\n",
                        r.from, r.to, 1e3 * r.trajectory_rms, 1e3 * r.trajectory_max, 1e3 * r.drape_rms,
                        1e3 * r.drape_hausdorff);
  return text;
}

} // namespace tutu::app
