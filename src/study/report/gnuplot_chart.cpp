#include "src/study/report/gnuplot_chart.h"

#include "rig/error.h"
#include "rig/io/file_io.h"
#include "rig/text.h"
#include "src/base/child_process.h"

#include <fmt/format.h>
#include <stdexcept>

namespace tutu::app {
namespace {

std::string script_of(const Chart& chart) {
  std::string text =
      fmt::format("set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\nset yrange [0:*]\nset "
                  "grid\nset key top right noenhanced\n",
                  gnuplot_text(chart.title), gnuplot_text(chart.x), gnuplot_text(chart.y));
  if (!chart.right.empty())
    text += fmt::format("set y2label {} noenhanced\nset y2tics\nset ytics nomirror\nset y2range [0:*]\n",
                        gnuplot_text(chart.right));
  std::string plot, data;
  for (const ChartLine& line : chart.lines) {
    plot += fmt::format("{}'-' with linespoints {} title {}", plot.empty() ? "plot " : ", ",
                        line.right_axis ? "axes x1y2" : "", gnuplot_text(line.name));
    for (const auto& [x, y] : line.points) data += fmt::format("{} {}\n", x, y);
    data += "e\n";
  }
  return text + plot + "\n" + data;
}

} // namespace

void require_chart(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension != ".svg" && extension != ".png")
    throw InputError(file.string(), "", '"' + extension + '"', "a name that ends in .svg or .png");
  if (!on_path("gnuplot"))
    throw InputError(file.string(), "", "no gnuplot to draw it", "the package gnuplot-nox to be installed");
}

std::string gnuplot_text(std::string_view text) {
  std::string result = "'";
  // Not doubled, as gnuplot has it: 5.4 reads a text that begins with one wrongly, and goes on reading commands.
  for (const char c : plain_text(text, ' ')) result += c == '\'' ? std::string("\u2019") : std::string(1, c);
  return result + "'";
}

std::string gnuplot_datum(std::string_view text) {
  std::string result = plain_text(text, ' ');
  for (char& c : result)
    if (c == '"' || c == '\\') c = c == '"' ? '\'' : '/';
  return '"' + result + '"';
}

void draw_with_gnuplot(const std::string& script, int width, int height, const std::filesystem::path& file) {
  require_chart(file);
  const bool svg = file.extension() == ".svg";
  // The picture comes by stdout: so the file's name is no part of the script. No settings of the user's are read.
  const ProcessEnd end = run_command({"gnuplot", "--default-settings"},
                                     fmt::format("set terminal {} size {},{}{}\n{}", svg ? "svg" : "png", width, height,
                                                 svg ? " font 'sans,13' background 'white'" : "", script));
  if (!end.good() || end.output.empty())
    throw std::runtime_error(file.string() + ": gnuplot failed: " + end.last_message());
  write_file(file, end.output);
}

void write_chart(const Chart& chart, const std::filesystem::path& file) {
  draw_with_gnuplot(script_of(chart), 800, 500, file);
}

} // namespace tutu::app
