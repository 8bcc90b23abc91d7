// Charts of coloured cells by gnuplot: a grid of settings, one cell each.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tutu::app {

using Rgb = std::array<std::uint8_t, 3>;

struct ChartCell {
  Rgb colour = {255, 255, 255};
  std::string text; ///< a few letters in it: no reader has to tell colours apart
};

/// Cells lie at whole numbers: (0, 0) at the lower left. Marks and the line are in the same units.
struct CellChart {
  struct Mark {
    double x = 0.0, y = 0.0;
    std::string name;
  };
  std::string title, subtitle, x, y;            ///< what the axes say
  std::vector<std::string> x_values, y_values;  ///< what stands beside each column and row
  std::vector<ChartCell> cells;                 ///< [row * columns + column]
  std::vector<std::pair<Rgb, std::string>> key; ///< what colours mean
  std::vector<Mark> marks;                      ///< dots
  std::vector<std::pair<double, double>> line;  ///< empty: none
  std::string line_name;
};

/// From `a` (0) to `b` (1).
Rgb blend(const Rgb& a, const Rgb& b, double share);

/// Draws it. Throws as write_chart.
void write_cell_chart(const CellChart& chart, const std::filesystem::path& file);

} // namespace tutu::app
