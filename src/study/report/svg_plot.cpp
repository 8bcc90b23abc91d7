#include "src/study/report/svg_plot.h"

#include "src/study/report/html.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

// User units; the width is that of a phone, so that text stays legible there.
constexpr double k_width = 460, k_height = 230, k_left = 40, k_right = 10, k_top = 12, k_bottom = 34;
constexpr int k_columns = 410;

/// 1, 2 or 5 times a power of ten: about `count` of them in `extent`.
double tick_step(double extent, double count) {
  const double raw = extent / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= raw) return step * power;
  return 10.0 * power;
}

struct Axes {
  double x0, x1, y1;

  double px(double x) const { return k_left + (x - x0) / (x1 - x0) * (k_width - k_left - k_right); }
  double py(double y) const { return k_height - k_bottom - y / y1 * (k_height - k_top - k_bottom); }
};

std::string points_of(const Plot& plot, const PlotSeries& series, const Axes& axes) {
  std::string points;
  const std::size_t count = plot.x.size(), group = std::max<std::size_t>(1, count / k_columns);
  for (std::size_t first = 0; first < count; first += group) {
    const auto begin = series.y.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = series.y.begin() + static_cast<std::ptrdiff_t>(std::min(count, first + group));
    const auto most = std::max_element(begin, end);
    points += fmt::format("{:.1f},{:.1f} ", axes.px(plot.x[static_cast<std::size_t>(most - series.y.begin())]),
                          axes.py(*most));
  }
  return points;
}

} // namespace

std::string svg_of(const Plot& plot) {
  Axes axes{plot.x.empty() ? 0.0 : plot.x.front(), plot.x.empty() ? 1.0 : plot.x.back(), plot.level};
  if (!(axes.x1 > axes.x0)) axes.x1 = axes.x0 + 1.0;
  for (const PlotSeries& series : plot.series)
    for (const double y : series.y) axes.y1 = std::max(axes.y1, y);
  axes.y1 = axes.y1 > 0.0 ? 1.08 * axes.y1 : 1.0;

  std::string svg = fmt::format("<figure><figcaption>{}</figcaption>\n<svg viewBox=\"0 0 {} {}\" role=\"img\" "
                                "aria-label=\"{}\">\n",
                                html_escaped(plot.title), k_width, k_height, html_escaped(plot.title));
  const double y_step = tick_step(axes.y1, 5), x_step = tick_step(axes.x1 - axes.x0, 6);
  for (double y = 0.0; y <= axes.y1; y += y_step)
    svg += fmt::format("<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text x=\"{3}\" "
                       "y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
                       k_left, k_width - k_right, axes.py(y), k_left - 4, axes.py(y) + 4, y);
  for (double x = std::ceil(axes.x0 / x_step) * x_step; x <= axes.x1 + 1e-9 * x_step; x += x_step)
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:g}</text>\n", axes.px(x),
                       k_height - k_bottom + 14, x);
  svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", k_width - k_right, k_height - 5,
                     html_escaped(plot.x_name));
  svg += fmt::format("<text x=\"4\" y=\"{}\">{}</text>\n", k_height - 5, html_escaped(plot.y_name));
  std::vector<PlotMark> marks = plot.marks;
  std::sort(marks.begin(), marks.end(), [](const PlotMark& x, const PlotMark& y) { return x.x < y.x; });
  double label_end = 0.0, label_y = k_top + 7; // labels that would touch go down a line
  for (const PlotMark& mark : marks) {
    constexpr double k_digit = 6.5, k_line = 10;
    label_y = axes.px(mark.x) < label_end ? label_y + k_line : k_top + 7;
    label_end = axes.px(mark.x) + 4 + k_digit * static_cast<double>(mark.label.size());
    svg += fmt::format(
        "<line class=\"mark\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text class=\"small\" "
        "x=\"{3:.1f}\" y=\"{4}\">{5}</text>\n",
        axes.px(mark.x), k_top, k_height - k_bottom, axes.px(mark.x) + 2, label_y, html_escaped(mark.label));
  }
  if (plot.level > 0.0)
    svg += fmt::format(
        "<line class=\"level\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text class=\"small\" "
        "x=\"{1}\" y=\"{3:.1f}\" text-anchor=\"end\">{4}</text>\n",
        k_left, k_width - k_right, axes.py(plot.level), axes.py(plot.level) - 3, html_escaped(plot.level_name));
  for (const PlotSeries& series : plot.series) {
    if (plot.x.size() == 1) // a line needs two
      svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", axes.px(plot.x[0]),
                         axes.py(series.y[0]), series.colour);
    svg += fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"{} points=\"{}\"/>\n", series.colour,
                       series.dashed ? " stroke-dasharray=\"4 3\"" : "", points_of(plot, series, axes));
  }
  svg += "</svg>\n<p class=\"legend\">";
  for (const PlotSeries& series : plot.series)
    svg += fmt::format("<span><i style=\"border-top:3px {} {}\"></i>{}</span> ", series.dashed ? "dashed" : "solid",
                       series.colour, html_escaped(series.name));
  return svg + "</p></figure>\n";
}

} // namespace tutu::app
