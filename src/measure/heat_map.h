// A picture that a report shows, made by whoever can draw.
#pragma once

#include <string>

namespace tutu::app {

struct HeatMap {
  int frame = 0;
  std::string front, back; ///< PNG
};

} // namespace tutu::app
