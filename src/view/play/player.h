// What the window plays. The scene side implements it, the window only calls it.
#pragma once

#include "src/view/render/frame_view.h"
#include "src/view/show/layers.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// Milliseconds of one stage in the frame that is shown.
struct StageTime {
  const char* name;
  double ms;
};

/// Of the frame that is shown.
struct Figures {
  int frame = 0, particles = 0, contacts = 0;
  int substeps = 0;   ///< of the garment with the most
  int recoveries = 0; ///< since the start
  double ms = 0;      ///< of the simulation
  double deepest = 0; ///< m that a particle is inside a proxy
  std::uint64_t state_hash = 0;
};

class Player {
public:
  virtual ~Player() = default;

  virtual void rewind() = 0;          ///< to time 0 and the draped start
  virtual void go(int frames) = 0;    ///< further on, or back: as far as the motion and what is recorded go
  virtual void seek(double time) = 0; ///< s; outside of what is recorded garments are carried along and settle again
  virtual bool behind() const { return false; } ///< what was asked for is not there yet: an earlier frame is shown
  virtual bool at_end() const = 0;              ///< nothing comes after what is shown: see message()
  virtual double frame_seconds() const = 0;     ///< s from frame to frame
  virtual double time() const = 0;              ///< s since the start, of what is shown
  virtual double duration() const = 0;          ///< s of the motion, for the slider
  virtual std::string title() const = 0;
  virtual std::string message() const = 0;            ///< "" or one sentence for the user
  virtual std::string recorded() const { return ""; } ///< what one can go back to, in words
  virtual std::vector<StageTime> stage_times() const = 0;
  virtual std::vector<float> history() const { return {}; } ///< ms a frame, of the last ones up to that shown
  virtual std::vector<Figures> figures() { return {}; }     ///< of each view
  /// s; where the skin sticks out of the proxies the most. May take seconds the first time. None without proxies.
  virtual std::optional<double> worst_time() { return std::nullopt; }
  /// What there is to see, side by side. Spans stay good until the next call of any function.
  virtual std::vector<FrameView> views(const Layers& layers) = 0;

  /// A place in the picture: what is within `spread` (m for each m of the way) of the ray.
  struct Ray {
    Vec3f from, direction; ///< unit
    float spread = 0;
  };
  virtual void pick(const Ray&) {}                                   ///< the particle there, or none
  virtual std::vector<std::vector<std::string>> why() { return {}; } ///< of each view: about what was picked, in lines
};

} // namespace tutu::app
