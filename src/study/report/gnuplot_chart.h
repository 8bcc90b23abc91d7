// Charts by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::app {

/// One line of a chart: name and points.
struct ChartLine {
  std::string name;
  std::vector<std::pair<double, double>> points;
  bool right_axis = false;
};

struct Chart {
  std::string title, x, y, right; ///< what the axes say; `right` empty: there is none
  std::vector<ChartLine> lines;
};

/// Throws InputError on a name that ends neither in .svg nor in .png, and where there is no gnuplot on the PATH: ask
/// before long work.
void require_chart(const std::filesystem::path& file);

// Every text of a script goes through one of these two: whatever it holds, it is read as text and ends where it should.

/// Between single quotes, in which gnuplot knows no commands and no escapes; what would end the line is a blank, a
/// quote becomes a typographic one.
std::string gnuplot_text(std::string_view text);
/// A column of a data block.
std::string gnuplot_datum(std::string_view text);

/// Runs a script (without terminal and output) on a picture of so many pixels. Throws as write_chart.
void draw_with_gnuplot(const std::string& script, int width, int height, const std::filesystem::path& file);

/// Draws it. Throws as require_chart, and std::runtime_error with gnuplot's words when it fails.
void write_chart(const Chart& chart, const std::filesystem::path& file);

} // namespace tutu::app
