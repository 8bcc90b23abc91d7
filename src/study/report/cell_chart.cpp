#include "src/study/report/cell_chart.h"

#include "src/study/report/gnuplot_chart.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

constexpr int k_width = 900, k_height = 560; // pixels
constexpr std::size_t k_line = 95;           // characters under the chart
constexpr double k_text_up = 0.28;           // of a cell: a dot in the middle does not hide it

std::uint32_t number_of(const Rgb& colour) { return colour[0] << 16 | colour[1] << 8 | colour[2]; }

/// Black or white, whichever is read on that colour (relative luminance).
const char* ink_on(const Rgb& colour) {
  const double luminance = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
  return luminance > 115.0 ? "black" : "white";
}

/// On lines of at most k_line characters, broken at blanks.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::string rest = text;
  while (rest.size() > k_line) {
    const std::size_t blank = rest.rfind(' ', k_line);
    if (blank == std::string::npos || blank == 0) break;
    lines.push_back(rest.substr(0, blank));
    rest.erase(0, blank + 1);
  }
  lines.push_back(rest);
  return lines;
}

std::string tics_of(const std::vector<std::string>& values) {
  std::string text;
  for (std::size_t k = 0; k < values.size(); ++k)
    text += fmt::format("{}{} {}", k ? ", " : "", gnuplot_text(values[k]), k);
  return text;
}

std::string script_of(const CellChart& chart) {
  const std::size_t columns = chart.x_values.size(), rows = chart.y_values.size();
  std::string text = fmt::format(
      "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\nset xrange [-0.5:{}]\nset yrange "
      "[-0.5:{}]\nset xtics ({}) noenhanced\nset ytics ({}) noenhanced\nset tics out nomirror\n"
      "set rmargin at screen 0.73\nset key at screen 0.75,0.93 left top Left reverse samplen 1.5 noenhanced\n",
      gnuplot_text(chart.title), gnuplot_text(chart.x), gnuplot_text(chart.y), static_cast<double>(columns) - 0.5,
      static_cast<double>(rows) - 0.5, tics_of(chart.x_values), tics_of(chart.y_values));
  const std::vector<std::string> under = lines_of(chart.subtitle);
  text += fmt::format("set bmargin {}\n", 4 + under.size());
  for (std::size_t k = 0; k < under.size(); ++k)
    text += fmt::format("set label {} at screen 0.02,{} left noenhanced\n", gnuplot_text(under[k]),
                        0.025 + 0.032 * static_cast<double>(under.size() - 1 - k));
  for (std::size_t k = 0; k < chart.cells.size(); ++k)
    if (const ChartCell& cell = chart.cells[k]; !cell.text.empty())
      text += fmt::format("set label {} at {},{} center front noenhanced textcolor rgb '{}'\n", gnuplot_text(cell.text),
                          k % columns, static_cast<double>(k / columns) + k_text_up, ink_on(cell.colour));

  std::string plot = "plot '-' using 1:2:(0.5):(0.5):3 with boxxyerror fill solid 1.0 border lc rgb 'white' lc rgb "
                     "variable notitle";
  std::string data;
  for (std::size_t k = 0; k < chart.cells.size(); ++k)
    data += fmt::format("{} {} {}\n", k % columns, k / columns, number_of(chart.cells[k].colour));
  data += "e\n";
  for (const auto& [colour, name] : chart.key)
    plot += fmt::format(", keyentry with boxes fill solid 1.0 lc rgb 0x{:06x} title {}", number_of(colour),
                        gnuplot_text(name));
  if (!chart.line.empty()) {
    plot += fmt::format(", '-' with lines lw 2 dt 2 lc rgb 'black' title {}", gnuplot_text(chart.line_name));
    for (const auto& [x, y] : chart.line) data += fmt::format("{} {}\n", x, y);
    data += "e\n";
  }
  for (const CellChart::Mark& mark : chart.marks) { // black on white, so that it is seen on any colour
    plot += fmt::format(", '-' with points pt 7 ps 2.6 lc rgb 'white' notitle, '-' with points pt 7 ps 1.7 lc rgb "
                        "'black' title {}",
                        gnuplot_text(mark.name));
    for (int twice = 0; twice < 2; ++twice) data += fmt::format("{} {}\ne\n", mark.x, mark.y);
  }
  return text + plot + "\n" + data;
}

} // namespace

Rgb blend(const Rgb& a, const Rgb& b, double share) {
  Rgb mixed;
  for (std::size_t k = 0; k < mixed.size(); ++k)
    mixed[k] = static_cast<std::uint8_t>(std::lround(std::lerp(1.0 * a[k], 1.0 * b[k], std::clamp(share, 0.0, 1.0))));
  return mixed;
}

void write_cell_chart(const CellChart& chart, const std::filesystem::path& file) {
  draw_with_gnuplot(script_of(chart), k_width, k_height, file);
}

} // namespace tutu::app
