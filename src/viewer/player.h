// What the window plays. The scene side implements it, the window only calls it.
#pragma once

#include "src/render/frame_view.h"
#include "src/scene/layers.h"

#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// Milliseconds of one stage in the last frame.
struct StageTime {
  const char* name;
  double ms;
};

class Player {
public:
  virtual ~Player() = default;

  virtual void restart() = 0;               ///< back to time 0 and the draped start
  virtual bool step() = 0;                  ///< one frame further; false when the simulation had to stop: see message()
  virtual void seek(double time) = 0;       ///< s; the garments are carried along and settle again
  virtual double frame_seconds() const = 0; ///< s a step advances
  virtual double time() const = 0;          ///< s since the start
  virtual double duration() const = 0;      ///< s of the motion, for the slider
  virtual std::string title() const = 0;
  virtual std::string message() const = 0; ///< "" or one sentence for the user
  virtual std::vector<StageTime> stage_times() const = 0;
  /// s; where the skin sticks out of the proxies the most. May take seconds the first time. None without proxies.
  virtual std::optional<double> worst_time() { return std::nullopt; }
  virtual FrameView view(const Layers& layers) = 0; ///< spans stay good until the next call of any function
};

} // namespace tutu::app
