#include "src/study/report/gnuplot_chart.h"

#include "rig/error.h"
#include "rig/io/file_io.h"

#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>
#include <unistd.h>

namespace tutu::app {
namespace {

bool on_path(const char* program) {
  const char* path = std::getenv("PATH");
  std::string_view rest = path ? path : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    if (!folder.empty() && ::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

std::string script_of(const Chart& chart) {
  std::string text = fmt::format("set title {} noenhanced\nset xlabel {}\nset ylabel {}\nset yrange [0:*]\nset "
                                 "grid\nset key top right noenhanced\n",
                                 gnuplot_text(chart.title), gnuplot_text(chart.x), gnuplot_text(chart.y));
  if (!chart.right.empty())
    text +=
        fmt::format("set y2label {}\nset y2tics\nset ytics nomirror\nset y2range [0:*]\n", gnuplot_text(chart.right));
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
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

void draw_with_gnuplot(const std::string& script, int width, int height, const std::filesystem::path& file) {
  require_chart(file);
  PendingFile pending(file);
  const bool svg = file.extension() == ".svg";
  const std::string head =
      fmt::format("set terminal {} size {},{}{}\nset output {}\n", svg ? "svg" : "png", width, height,
                  svg ? " font 'sans,13' background 'white'" : "", gnuplot_text(pending.temporary().string()));
  std::FILE* gnuplot = ::popen("gnuplot", "w");
  if (!gnuplot) throw std::runtime_error(file.string() + ": gnuplot did not start");
  for (const std::string* text : {&head, &script}) std::fwrite(text->data(), 1, text->size(), gnuplot);
  if (::pclose(gnuplot) != 0) throw std::runtime_error(file.string() + ": gnuplot failed");
  pending.commit();
}

void write_chart(const Chart& chart, const std::filesystem::path& file) {
  draw_with_gnuplot(script_of(chart), 800, 500, file);
}

} // namespace tutu::app
