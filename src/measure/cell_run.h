// One run of a scene, measured: the motion, then its last pose held.
//
//   frames of motion --> `settle` frames in the last pose, with the drag of a drape --> `held` frames without it
//
// The motion gives times, depths, stretch, contacts and the trajectory; the settled shape is the drape that is
// compared; what still moves while nobody moves it is jitter, and energy that grows then is drift.
#pragma once

#include "src/measure/run_end.h"
#include "src/run/session.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// How long and how often, in frames of the scene's own rate. A setting of another rate runs as long.
struct Protocol {
  int frames = 120;
  int settle = 60, held = 60;
  int every = 3; ///< frames from one that is recorded and measured against the body to the next

  bool operator==(const Protocol&) const = default;
};

/// The same spans of time at another rate. Throws InputError where they are no whole frames.
Protocol at_rate(const Protocol& protocol, double scene_rate, double rate);

/// What two runs of one scene are compared by.
struct Trajectory {
  struct Moment {
    double time = 0.0; ///< s
    GarmentPositions positions;
    std::vector<std::vector<std::uint8_t>> touching; ///< [garment][particle]: nearer than touching_distance()
  };
  std::vector<Moment> moments; ///< each `every` frames of the motion
  GarmentPositions drape;      ///< at the end of `settle`
};

/// m: a particle that is nearer to what it collides with counts as touching. More than the contact offset by
/// k_contact_slack, for contacts of triangles keep particles that much farther off at most.
double touching_distance(const cloth::Garment& garment);
inline constexpr double k_contact_slack = 0.003; ///< m

struct CellRun {
  Trajectory trajectory;
  std::string failure; ///< why it ended early; empty when it did not
  bool stopped = false;
  int recoveries = 0; ///< frames of garments that were taken again
  int most_substeps = 0;
  std::vector<FrameTimes> stages; ///< ms, of each frame of the motion
  std::vector<double> ms;         ///< of the same frames: the thread's own time with one thread, else all that passes
  cloth::Spread in_proxies, in_body; ///< m, depth of free particles; in_body of the recorded frames
  double surface_in_proxies = 0.0;   ///< m, the deepest sample of a triangle,
  double surface_in_body = 0.0;      ///< of the recorded frames
  double share_in_body = 0.0;        ///< of free particles of the recorded frames
  cloth::ThreadStrains strains;
  RunEnd end;               ///< after the last frame, held ones among them
  double jitter = 0.0;      ///< m/s2, mean, while held
  double energy_rise = 0.0; ///< J, the most above the least before, while held
  std::uint64_t state_hash = 0;
};

/// `scene` is as the setting has it, seed and all; `start` as it was draped; `protocol` in its own frames. Without
/// `measured` only the recording, the times, the failure and the substeps are there, and the run is as fast as it can
/// be. `go_on` is asked after each frame, and sees what has been measured so far (of the spreads nothing). Throws
/// InputError for a body without sides where it is measured.
CellRun run_cell(const Scene& scene, const GarmentPositions& start, const Protocol& protocol, bool measured,
                 const std::function<bool(const CellRun&)>& go_on);

} // namespace tutu::app
