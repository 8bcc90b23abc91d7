#include "src/chart/chart_picture.h"

#include "src/export/chart.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

constexpr int k_width = 1100, k_height = 720; // pixels

/// What is drawn in one colour. Okabe and Ito 2008.
struct Family {
  const char *name, *colour;
};
constexpr Family k_families[] = {{"xpbd", "#0072b2"},
                                 {"xpbd, particles only", "#56b4e9"},
                                 {"mass_spring", "#d55e00"},
                                 {"against the true body", "#009e73"}};

std::size_t family_of(const ChartPoint& point) {
  const Row& row = point.rows.front();
  if (row.text("backend") == "mesh") return 3;
  if (row.text("solver") == "mass_spring") return 2;
  return row.text("features") == "particles" ? 1 : 0;
}

struct Drawn {
  double x = 0.0, y = 0.0;
};

/// The range of an axis of logarithms around some values.
struct Range {
  double low = 1e300, high = 0.0;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return high < low; }
};

std::string block(const char* name, const std::string& lines) {
  return fmt::format("${} << EOD\n{}EOD\n", name, lines);
}

/// A name as a column of a data block, without what would end it.
std::string data_text(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  return '"' + text + '"';
}

} // namespace

void write_chart_picture(const std::vector<ChartPoint>& points, const ErrorAxis& axis, const std::string& scene,
                         const std::filesystem::path& file) {
  const auto place = [&](const ChartPoint& p) {
    return Drawn{p.cost(), std::max(axis.floor, axis.scale * p.figure(axis.column).value_or(0.0))};
  };
  const std::vector<int> front = front_of(points, axis);
  Range x, y;
  for (const ChartPoint& p : points) {
    if (p.cost() > 0.0) x.add(p.cost());
    if (p.good()) y.add(place(p).y);
  }
  if (x.empty()) x = {0.1, 1.0};
  if (y.empty()) y = {axis.floor, 1.0};
  const double top = y.high * std::pow(y.high / y.low, 0.35) * 1.3; // room for the failed ones and their reasons

  std::string families[std::size(k_families)], failed, step, labels;
  for (const ChartPoint& p : points) {
    const Drawn at = place(p);
    if (p.good()) families[family_of(p)] += fmt::format("{} {}\n", at.x, at.y);
    else
      failed +=
          fmt::format("{} {} {}\n", p.cost() > 0.0 ? at.x : x.high, top / 1.15, data_text(p.name + ": " + p.reason));
  }
  for (const int i : front) step += fmt::format("{} {}\n", place(points[i]).x, place(points[i]).y);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool on_front = std::find(front.begin(), front.end(), static_cast<int>(i)) != front.end();
    if (!points[i].good() || !(points[i].named || on_front)) continue;
    const Drawn at = place(points[i]);
    labels += fmt::format("{} {} {}\n", at.x, at.y, data_text(points[i].name));
  }

  std::string script =
      fmt::format("set title {} noenhanced\nset xlabel 'ms a frame, p99'\nset ylabel {} noenhanced\nset logscale xy\n"
                  "set xrange [{}:{}]\nset yrange [{}:{}]\nset grid\nset key bottom left noenhanced\n",
                  gnuplot_text(scene + ": error against time"), gnuplot_text(axis.title), x.low / 1.5, x.high * 3.0,
                  y.low / 1.5, top);
  std::string plot;
  const auto add = [&](const std::string& what) { plot += (plot.empty() ? "plot " : ", ") + what; };
  if (!step.empty()) {
    script += block("front", step);
    add("$front with steps lc rgb '#999999' lw 2 title 'Pareto front'");
  }
  for (std::size_t f = 0; f < std::size(k_families); ++f) {
    if (families[f].empty()) continue;
    script += block(fmt::format("family{}", f).c_str(), families[f]);
    add(fmt::format("$family{} with points pt 7 ps 1.4 lc rgb '{}' title {}", f, k_families[f].colour,
                    gnuplot_text(k_families[f].name)));
  }
  if (!failed.empty()) {
    script += block("failed", failed);
    add("$failed using 1:2 with points pt 2 ps 1.6 lw 2 lc rgb '#cc0000' title 'failed'");
    add("$failed using 1:2:3 with labels right rotate by 30 offset -1,-0.6 noenhanced tc rgb '#cc0000' notitle");
  }
  if (!labels.empty()) {
    script += block("labels", labels);
    add("$labels using 1:2:3 with labels left offset 0.9,0.6 noenhanced notitle");
  }
  draw_with_gnuplot(script + plot + "\n", k_width, k_height, file);
}

} // namespace tutu::app
