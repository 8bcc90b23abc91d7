// Measures planned models of one scene: how wrong, over the motion and against the reference, and how dear.
#pragma once

#include "src/scene/load.h"
#include "src/study/chart/reference.h"
#include "src/study/plan/plan_proxies.h"

namespace tutu::app {

/// Which error a plan has to meet.
enum class PlanError { body, trajectory, drape, all };
inline constexpr std::array<std::string_view, 4> k_plan_error_names = {"body", "trajectory", "drape", "all"};

struct PlanGoal {
  PlanError error = PlanError::all;
  double most = 0.0;         ///< m, of that error
  double most_longer = 0.05; ///< strain of 99 % of the threads
  int frames = 0;            ///< of the motion
  int starts = 3;            ///< that verifying takes, uneven, each with another seed
  bool compares_bad = false; ///< what is not good is measured to its end, too: a budget may call for it
};

struct PlanErrors {
  double body = 0.0;       ///< m: the deepest that free cloth is inside of the true body, over the motion
  double trajectory = 0.0; ///< m RMS off the reference in the first second, mean of the starts
  double drape = 0.0;      ///< m RMS off its settled shape, mean of the starts
  double longer_p99 = 0.0; ///< of free threads (cloth/metrics.h), over the motion
  double longer_max = 0.0; ///< of any of them in any frame; told, and not limited
  std::string trouble;     ///< it diverged, or a frame had to be taken again; empty when neither
};

/// What is allowed, m: nothing where it does not count.
struct PlanLimits {
  std::optional<double> body, trajectory, drape;
  double longer_p99 = 0.0;
};

/// ms a frame, this thread's own time.
struct PlanCost {
  double median = 0.0, p99 = 0.0;
};

/// The worst error over what is allowed of it; infinity where there was trouble.
double excess_of(const PlanErrors& errors, const PlanLimits& limits);
/// Which error that is, in words: "2.40 mm in the body (2.00 allowed)".
std::string worst_of(const PlanErrors& errors, const PlanLimits& limits);

/// The scene must outlive it.
class PlanBench {
public:
  /// `reference` is there where trajectory or drape count, with its plan; `start` is of the scene's own resolution.
  PlanBench(const LoadedScene& scene, const PlanGoal& goal, const ReferencePlan& plan,
            std::optional<Reference> reference, GarmentPositions start, std::function<bool()> go_on);

  /// The scene's own model: its errors, which the limits of trajectory and drape are made from.
  const PlanErrors& own() const { return own_; }
  const PlanLimits& limits() const { return limits_; }

  LoadedScene scene_of(const PlanModel& model);
  GarmentPositions start_of(const PlanModel& model);

  struct Measured {
    PlanErrors errors;
    PlanCost cost;
  };
  /// One start, some frames measured against the body, and so its depth taken for a tenth more. What is worse than
  /// the scene's own is not run to its end.
  Measured measure(const PlanModel& model);
  /// All starts, side by side, all frames.
  PlanErrors verify(const PlanModel& model);

  struct Pair {
    PlanCost first, second;
    double ratio = 0.0; ///< first over second: median of the pairs
  };
  /// `pairs` times one after the other, through the motion.
  Pair compare(const PlanModel& first, const PlanModel& second, int pairs);

  PlanProxies& proxies() { return *proxies_; }
  double skinning_ms() const; ///< of the body's vertices, once, median

private:
  void add_guard(const LoadedScene& scene, const PlanModel& model, PlanErrors& errors);
  std::vector<CellRun> run_starts(const LoadedScene& scene, const PlanModel& model);
  static void add_body(const CellRun& run, PlanErrors& errors);

  const LoadedScene* scene_;
  PlanGoal goal_;
  Protocol guard_;
  std::optional<Reference> reference_;
  std::vector<cloth::Garment> reference_garments_;
  GarmentPositions start_;
  std::map<double, GarmentPositions> starts_; ///< by resolution
  std::function<bool()> go_on_;
  std::vector<Trajectory> own_runs_;
  std::optional<PlanProxies> proxies_;
  PlanErrors own_;
  PlanLimits limits_;
  double hopeless_; ///< excess from which on nothing more is measured
};

} // namespace tutu::app
