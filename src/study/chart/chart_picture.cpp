#include "src/study/chart/chart_picture.h"

#include "src/study/report/gnuplot_chart.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

constexpr int k_width = 1100, k_height = 720;                 // pixels
constexpr double k_plot_width = 980.0, k_plot_height = 580.0; // inside the axes, about

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

/// Names beside points, each where it covers no other: in pixels of the plot, x to the right, y up.
class Labels {
public:
  /// Nothing may cover a point.
  void keep_clear(const Drawn& point) { boxes_.push_back({point.x - 6.0, point.y, 12.0, 12.0}); }

  /// Where the left end of a text's middle line goes.
  Drawn place(const Drawn& point, std::size_t characters) {
    constexpr double k_character = 7.5, k_line = 17.0, k_aside = 13.0;
    Box box{point.x + k_aside, point.y, k_character * static_cast<double>(characters), k_line};
    for (int step = 1; step < 40 && !is_free(box); ++step) { // up and down by turns, farther each time
      const int lines = (step + 1) / 2;
      box.y = point.y + (step % 2 == 1 ? lines : -lines) * k_line;
    }
    boxes_.push_back(box);
    return {box.x, box.y};
  }

private:
  struct Box { // y: of its middle
    double x, y, width, height;
  };
  bool is_free(const Box& a) const {
    if (a.y < 0.5 * a.height || a.y > k_plot_height - 0.5 * a.height) return false;
    return std::none_of(boxes_.begin(), boxes_.end(), [&](const Box& b) {
      return a.x < b.x + b.width && b.x < a.x + a.width && std::abs(a.y - b.y) < 0.5 * (a.height + b.height);
    });
  }
  std::vector<Box> boxes_;
};

/// Place of the cross, and of its upright text, which keeps a line from the one before.
std::string failed_rows(std::vector<std::pair<double, std::string>> failures, double left, double right, double y) {
  std::sort(failures.begin(), failures.end());
  constexpr double k_line = 14.0; // px
  const double line = std::pow(right / left, k_line / k_plot_width);
  std::string rows;
  double last = 0.0;
  for (const auto& [x, text] : failures) {
    last = std::max(x, last * line);
    rows += fmt::format("{} {} {} {}\n", x, y, last, gnuplot_datum(text));
  }
  return rows;
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
  const bool all_good = std::all_of(points.begin(), points.end(), [](const ChartPoint& p) { return p.good(); });
  // Room for the failed ones and their reasons.
  const double top = 1.3 * y.high * std::pow(std::max(10.0, y.high / y.low), all_good ? 0.1 : 1.1);
  const double left = x.low / 1.5, right = x.high * 3.0, bottom = y.low / 2.0;

  std::string families[std::size(k_families)], step, labels, rings;
  std::vector<std::pair<double, std::string>> failures; // where along the upper edge, and what is said
  for (const ChartPoint& p : points) {
    const Drawn at = place(p);
    if (p.good()) families[family_of(p)] += fmt::format("{} {}\n", at.x, at.y);
    else failures.emplace_back(p.cost() > 0.0 ? at.x : x.high, p.name + ": " + p.reason);
  }
  const std::string failed = failed_rows(std::move(failures), left, right, top / 1.15);
  for (const int i : front) step += fmt::format("{} {}\n", place(points[i]).x, place(points[i]).y);
  const auto pixels = [&](const Drawn& at) {
    return Drawn{k_plot_width * std::log(at.x / left) / std::log(right / left),
                 k_plot_height * std::log(at.y / bottom) / std::log(top / bottom)};
  };
  Labels places;
  for (const ChartPoint& p : points)
    if (p.good() && p.cost() > 0.0) places.keep_clear(pixels(place(p)));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool on_front = std::find(front.begin(), front.end(), static_cast<int>(i)) != front.end();
    if (!points[i].good() || !(points[i].named || on_front)) continue;
    const Drawn text = places.place(pixels(place(points[i])), points[i].name.size());
    const Drawn at = place(points[i]), to = {left * std::pow(right / left, text.x / k_plot_width),
                                             bottom * std::pow(top / bottom, text.y / k_plot_height)};
    labels += fmt::format("{} {} {} {} {}\n", to.x, to.y, gnuplot_datum(points[i].name), at.x - to.x, at.y - to.y);
    if (points[i].named) rings += fmt::format("{} {}\n", at.x, at.y);
  }

  std::string script = fmt::format(
      "set title {} noenhanced\nset xlabel 'ms a frame, p99'\nset ylabel {} noenhanced\nset logscale xy\n"
      "set xrange [{}:{}]\nset yrange [{}:{}]\nset grid\nset key outside bottom center horizontal noenhanced\n",
      gnuplot_text(scene + ": error against time"), gnuplot_text(axis.title), left, right, bottom, top);
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
    add("$failed using 3:2:4 with labels right rotate by 90 offset 0,-0.8 font ',10' noenhanced tc rgb '#cc0000' "
        "notitle");
  }
  if (!rings.empty()) {
    script += block("rings", rings);
    add("$rings with points pt 6 ps 2.2 lw 2 lc rgb '#20242c' notitle");
  }
  if (!labels.empty()) {
    script += block("labels", labels);
    add("$labels using 1:2:4:5 with vectors nohead lc rgb '#bbbbbb' notitle");
    add("$labels using 1:2:3 with labels left noenhanced notitle");
  }
  draw_with_gnuplot(script + plot + "\n", k_width, k_height, file);
}

} // namespace tutu::app
