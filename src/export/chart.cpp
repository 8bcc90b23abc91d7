#include "src/export/chart.h"

#include "rig/error.h"
#include "rig/file_io.h"

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

/// A text as gnuplot reads it between single quotes.
std::string in_quotes(std::string_view text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

std::string script_of(const Chart& chart, const std::filesystem::path& picture, bool svg) {
  std::string text =
      svg ? "set terminal svg size 800,500 font 'sans,13' background 'white'\n" : "set terminal png size 800,500\n";
  text += fmt::format("set output {}\nset title {} noenhanced\nset xlabel {}\nset ylabel {}\nset yrange [0:*]\nset "
                      "grid\nset key top right noenhanced\n",
                      in_quotes(picture.string()), in_quotes(chart.title), in_quotes(chart.x), in_quotes(chart.y));
  if (!chart.right.empty())
    text += fmt::format("set y2label {}\nset y2tics\nset ytics nomirror\nset y2range [0:*]\n", in_quotes(chart.right));
  std::string plot, data;
  for (const ChartLine& line : chart.lines) {
    plot += fmt::format("{}'-' with linespoints {} title {}", plot.empty() ? "plot " : ", ",
                        line.right_axis ? "axes x1y2" : "", in_quotes(line.name));
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

void write_chart(const Chart& chart, const std::filesystem::path& file) {
  require_chart(file);
  PendingFile pending(file);
  const std::string script = script_of(chart, pending.temporary(), file.extension() == ".svg");
  std::FILE* gnuplot = ::popen("gnuplot", "w");
  if (!gnuplot) throw std::runtime_error(file.string() + ": gnuplot did not start");
  std::fwrite(script.data(), 1, script.size(), gnuplot);
  if (::pclose(gnuplot) != 0) throw std::runtime_error(file.string() + ": gnuplot failed");
  pending.commit();
}

} // namespace tutu::app
