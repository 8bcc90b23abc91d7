// What a run measured, frame by frame, and how it is reported.
#pragma once

#include "cloth/metrics.h"
#include "src/run/session.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tutu::app {

/// A particle counts as inside a proxy when it is deeper than this, m: above the rounding of a projection (1e-15),
/// below any depth that could be seen.
inline constexpr double k_inside_depth = 1e-6;

/// Collects after each frame; measures outside the timings. Its memory does not grow with the run beyond the first
/// cloth::PercentileGatherer::k_exact frames.
class RunStats {
public:
  explicit RunStats(const Scene& scene) : scene_(&scene) {}

  void add(const Session& session);

  /// What `play --json` writes. Lengths in mm where the name says so.
  nlohmann::json json(const Session& session) const;
  /// The same for a person, some lines.
  std::string text(const Session& session) const;

private:
  /// Largest and 99th percentile of the lengthening, mean of the change either way.
  cloth::Spread stretch() const;
  nlohmann::json substeps_json(const Session& session) const;
  struct Stage {
    const char* name;
    cloth::PercentileGatherer ms; ///< a sample a frame
  };
  struct History { ///< of one garment: the last two frames' positions
    std::vector<Vec3> last, before_last;
  };

  const Scene* scene_;
  std::vector<Stage> stages_ = {{"pose", {}},    {"proxies", {}}, {"broad", {}}, {"cloth", {}},
                                {"contact", {}}, {"skin", {}},    {"total", {}}};
  cloth::SpreadGatherer depths_mm_, jitters_;
  cloth::SpreadGatherer stretches_, strains_; ///< of threads that are longer than at rest; of all, either way
  std::int64_t inside_ = 0;                   ///< samples deeper than k_inside_depth
  std::vector<History> history_;
  int frames_ = 0;
};

} // namespace tutu::app
