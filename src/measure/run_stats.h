// What a run measured, frame by frame, and how it is reported.
#pragma once

#include "src/measure/run_end.h"
#include "src/run/session.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tutu::app {

/// Collects after each frame; measures outside the timings. Its memory does not grow with the run beyond the first
/// cloth::PercentileGatherer::k_exact frames.
class RunStats {
public:
  explicit RunStats(const Scene& scene);

  void add(const Session& session);

  /// How the garments are left: in what they collide with, and in the body where it has sides, which the session has
  /// skinned in this frame (Runtime::skin_body).
  RunEnd end(const Session& session);

  /// What `play --json` writes. Lengths in mm, strains in per cent where the name says so. `end` is in it.
  nlohmann::json json(const Session& session, const RunEnd& end) const;
  /// The same for a person, some lines.
  std::string text(const Session& session) const;

private:
  nlohmann::json substeps_json(const Session& session) const;
  struct Stage {
    const char* name;
    cloth::PercentileGatherer ms; ///< a sample a frame
  };
  struct History { ///< of one garment: the last two frames' positions
    std::vector<Vec3> last, before_last;
  };

  /// The session's skin as it is now.
  const proxies::BodyMesh& posed_body(const Session& session);

  const Scene* scene_;
  std::vector<Stage> stages_ = {{"pose", {}},    {"proxies", {}}, {"broad", {}}, {"cloth", {}},
                                {"contact", {}}, {"skin", {}},    {"total", {}}};
  std::vector<ClothProbe> probes_;        ///< [garment]
  ClothDepths depths_;                    ///< of one garment in one frame
  std::optional<proxies::BodyMesh> body_; ///< once it was asked for
  cloth::SpreadGatherer particles_mm_;    ///< a sample a free particle and frame
  cloth::SpreadGatherer surface_mm_;      ///< a sample a frame: the deepest of all garments
  cloth::SpreadGatherer jitters_;
  cloth::ThreadStrainGatherer strains_;
  std::int64_t inside_ = 0; ///< particles deeper than k_inside_depth
  std::vector<History> history_;
  int frames_ = 0;
};

} // namespace tutu::app
