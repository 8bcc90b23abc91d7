// The truth that settings are measured against: the same scene in double precision, in tiny steps, colliding with the
// true body; refined twice, so that what it still owes is known. Made once, then kept.
#pragma once

#include "src/scene/load.h"
#include "src/study/chart/compare.h"
#include "src/study/chart/setting.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// How the truth is made. The last of `substeps` (a frame, rising) is the reference, the others show that it converged.
struct ReferencePlan {
  std::vector<int> substeps = {24, 48, 96};
  double resolution = 1.0; ///< times the scene's own cells
  Protocol protocol;
};

/// How far one level is from the next finer one, m.
struct Refinement {
  int from = 0, to = 0; ///< substeps
  double trajectory_rms = 0.0, trajectory_max = 0.0, drape_rms = 0.0, drape_hausdorff = 0.0;
};

struct Reference {
  std::string scene;       ///< its name, for people
  std::string fingerprint; ///< of reference_fingerprint
  int substeps = 0;
  double resolution = 1.0;
  Protocol protocol;
  GarmentPositions start; ///< of the scene's own resolution: where every run begins
  std::vector<Refinement> refinements;
  Trajectory trajectory;
};

/// Hash of all that a reference depends on: body, motion, garments, ground, the drape all runs start from, how
/// uneven its own start is, and the plan.
std::string reference_fingerprint(const LoadedScene& scene, const ReferencePlan& plan);

/// The setting that makes level `substeps` of the truth.
Setting reference_setting(const LoadedScene& scene, const ReferencePlan& plan, int substeps);

/// `$XDG_CACHE_HOME/tutu`, or `~/.cache/tutu`.
std::filesystem::path default_cache();
std::filesystem::path reference_path(const std::filesystem::path& cache, const LoadedScene& scene,
                                     const ReferencePlan& plan);

/// What the file has, as a truth of this scene and plan. Throws InputError as read_reference, and where its garments
/// are not the scene's.
Reference reference_from(const std::filesystem::path& file, const LoadedScene& scene, const ReferencePlan& plan);

/// From the cache, or made and put there. Levels that are done are kept beside it until the last one is, so that an
/// interrupted call goes on where it stopped. `jobs` levels are made side by side. `start` is asked for only where
/// something has to be made; nothing when it gives nothing or after an interrupt (whose flag `go_on` reads). Throws
/// InputError on a damaged file of the cache, std::runtime_error when a level diverges.
std::optional<Reference> obtain_reference(const LoadedScene& scene, const ReferencePlan& plan,
                                          const std::filesystem::path& cache, int jobs,
                                          const std::function<std::optional<GarmentPositions>()>& start,
                                          const std::function<bool()>& go_on);

/// One line a refinement.
std::string convergence_text(const Reference& reference);

} // namespace tutu::app
