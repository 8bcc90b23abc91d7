// How far a scene is from where its methods fail, read off a map.
#pragma once

#include "src/study/stability/maps.h"

#include <optional>
#include <string>

namespace tutu::app {

/// The scene's own cell, and the nearest along either axis at which a run failed.
struct Margin {
  std::size_t ix = 0, iy = 0; ///< of its own cell
  bool holds = false;         ///< there (of a map of steps: the largest step there is not below the scene's)
  struct Nearest {
    bool along_x = false;
    double value = 0.0; ///< SI, of the failing cell on that axis
    double ratio = 1.0; ///< > 1: how many times the scene's own value it is, or goes into it
    Outcome how = Outcome::held;
  };
  std::optional<Nearest> nearest; ///< none: everything along both axes holds. Not for maps of steps
  std::optional<double> largest;  ///< s, of maps of steps
};

/// None where the scene is not on the map. `step`: the scene's own, s.
std::optional<Margin> margin_of(const StabilityMap& map, double step);

/// One sentence: "holds; the nearest failure is at substep 2.78 ms, 2.0 times its own (non-finite)".
std::string in_words(const StabilityMap& map, double step);

/// "1.39 ms", as the axis has it.
std::string in_words(const MapAxis& axis, double value);

} // namespace tutu::app
