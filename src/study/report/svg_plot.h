// Line plots as inline SVG: no script, no font, no network.
#pragma once

#include <string>
#include <vector>

namespace tutu::app {

struct PlotSeries {
  std::string name, colour; ///< any CSS colour
  std::vector<double> y;    ///< one a place of Plot::x
  bool dashed = false;
};

struct PlotMark {
  double x = 0.0;
  std::string label;
};

struct Plot {
  std::string title, x_name, y_name;
  std::vector<double> x; ///< rising
  std::vector<PlotSeries> series;
  std::vector<PlotMark> marks; ///< thin vertical lines
  double level = 0.0;          ///< a horizontal line, where > 0,
  std::string level_name;      ///< with this beside it
};

/// One <figure> that scales with its column. y starts at 0. Series of more points than the plot has columns are drawn
/// as the greatest of each column: no peak is lost.
std::string svg_of(const Plot& plot);

} // namespace tutu::app
