#include "src/study/chart/chart_points.h"

#include "src/study/chart/pareto.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace tutu::app {
namespace {

constexpr double k_clock_noise = 1.1; // times as long: as far as the same work is seen to differ in one chart

/// Why a run failed, in a few words; "" when it did not.
std::string reason_of(const Row& row) {
  const std::string& outcome = row.text("outcome");
  if (outcome == "ok") {
    const double depth = row.number("in_body_mm_surface").value_or(0.0);
    return depth > 1e3 * k_most_depth ? fmt::format("{:.0f} mm in the body", depth) : "";
  }
  if (outcome == "recovered") return "diverged " + row.text("recoveries") + " times";
  if (outcome == "diverged") return "diverged for good";
  return outcome + ": " + row.text("reason").substr(0, 60);
}

std::string shown(const std::optional<double>& value, double scale, const char* format = "{:.2f}") {
  return value ? fmt::format(fmt::runtime(format), scale * *value) : "-";
}

/// Cost and errors of a point in all axes; nothing when one is missing.
std::optional<std::vector<double>> respects_of(const ChartPoint& point) {
  std::vector<double> values = {point.cost()};
  for (const ErrorAxis& axis : error_axes()) {
    const auto value = point.figure(axis.column);
    if (!value) return {};
    values.push_back(*value);
  }
  return values;
}

/// The very same errors: it moved the same. What such settings differ in is the noise of the clock, as long as it is no
/// more.
bool moves_the_same(const ChartPoint& a, const ChartPoint& b) {
  const auto of_a = respects_of(a), of_b = respects_of(b);
  return of_a && of_b && std::equal(of_a->begin() + 1, of_a->end(), of_b->begin() + 1) &&
         a.cost() <= k_clock_noise * b.cost();
}

} // namespace

const std::vector<ErrorAxis>& error_axes() {
  static const std::vector<ErrorAxis> axes = {
      {"trajectory_mm_rms", "trajectory", "off the reference in the first second, mm RMS", 1.0, 0.01},
      {"drape_mm_rms", "drape", "drape off the reference's, mm RMS", 1.0, 0.01},
      {"in_body_mm_surface", "body", "surface in the true body, deepest, mm", 1.0, 0.1},
      {"longer_pct_p99", "longer", "threads longer than at rest, p99, %", 1.0, 0.01},
  };
  return axes;
}

double median(std::vector<double> values) {
  const std::size_t half = values.size() / 2;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half), values.end());
  if (values.size() % 2 == 1) return values[half];
  const double below = *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half));
  return 0.5 * (below + values[half]);
}

SettingValues ChartPoint::values() const { return rows.front().setting(); }

std::optional<double> ChartPoint::figure(const std::string& column) const {
  std::vector<double> values;
  for (const Row& row : rows)
    if (const auto value = row.number(column)) values.push_back(*value);
  if (values.empty()) return {};
  return median(std::move(values));
}

double ChartPoint::least_ms(const char* column) const {
  double least = 0.0;
  for (const Row& row : rows)
    if (const auto ms = row.number(column); ms && (least == 0.0 || *ms < least)) least = *ms;
  return least;
}

std::vector<ChartPoint> points_of(const std::vector<Row>& rows, const SettingValues& default_setting) {
  std::vector<ChartPoint> points;
  std::map<SettingValues, std::size_t> places;
  for (const Row& row : rows) {
    const auto [place, is_new] = places.try_emplace(row.setting(), points.size());
    if (is_new) points.emplace_back();
    ChartPoint& point = points[place->second];
    if (const std::string reason = reason_of(row); !reason.empty()) {
      ++point.failed;
      if (point.reason.empty()) point.reason = reason;
    }
    if (!row.text("name").empty()) {
      point.name = row.text("name");
      point.named = true;
    }
    point.rows.push_back(row);
  }
  for (ChartPoint& point : points)
    if (!point.named) point.name = difference(point.values(), default_setting);
  return points;
}

std::vector<int> front_of(const std::vector<ChartPoint>& points, const ErrorAxis& axis) {
  std::vector<CostAndError> candidates;
  std::vector<int> indices;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto error = points[i].figure(axis.column);
    if (!points[i].good() || !error || !points[i].figure("ms_p99")) continue;
    candidates.push_back({points[i].cost(), *error});
    indices.push_back(static_cast<int>(i));
  }
  std::vector<int> front;
  for (const int k : pareto_front(candidates)) front.push_back(indices[k]);
  return front;
}

std::string default_verdict(const std::vector<ChartPoint>& points) {
  const auto found =
      std::find_if(points.begin(), points.end(), [](const ChartPoint& p) { return p.name == "default"; });
  if (found == points.end()) return "";
  if (!found->good()) return "the default setting failed: " + found->reason + "\n";
  std::string text;
  for (const ErrorAxis& axis : error_axes()) {
    const std::vector<int> front = front_of(points, axis);
    const auto error = found->figure(axis.column);
    if (!error) continue;
    const bool on_it = std::any_of(front.begin(), front.end(),
                                   [&](int i) { return &points[i] == &*found || moves_the_same(*found, points[i]); });
    if (on_it) {
      text += fmt::format("default: on the front of {}\n", axis.stem);
      continue;
    }
    const ChartPoint* better = nullptr; // the most exact of those that take no longer
    for (const int i : front)
      if (points[i].cost() <= found->cost()) better = &points[i];
    if (better)
      text += fmt::format("default: not on the front of {}: {} has {:.3g} in {:.3f} ms, default {:.3g} in {:.3f} ms\n",
                          axis.stem, better->name, axis.scale * better->figure(axis.column).value_or(0.0),
                          better->cost(), axis.scale * *error, found->cost());
  }
  if (const auto own = respects_of(*found)) {
    std::string better;
    for (const ChartPoint& point : points) {
      const auto others = respects_of(point);
      if (!others || !point.good() || moves_the_same(*found, point)) continue;
      if (dominates(*others, *own)) better += (better.empty() ? "" : "; ") + point.name;
    }
    text += better.empty() ? "default: nothing is as fast and as exact in all of these at once\n"
                           : "default: as fast and as exact or better in all of these at once: " + better + "\n";
  }
  return text;
}

std::string points_text(const std::vector<ChartPoint>& points) {
  std::vector<const ChartPoint*> order;
  for (const ChartPoint& point : points) order.push_back(&point);
  std::stable_sort(order.begin(), order.end(),
                   [](const ChartPoint* a, const ChartPoint* b) { return a->cost() < b->cost(); });
  std::string text = fmt::format("{:>8} {:>8} {:>11} {:>9} {:>8} {:>9} {:>8} {:>8}  setting\n", "ms p99", "median",
                                 "first s mm", "drape mm", "body mm", "longer %", "missed %", "false %");
  for (const ChartPoint* p : order) {
    const auto cell = [&](const char* column, double scale, const char* format = "{:.2f}") {
      return shown(p->figure(column), scale, format);
    };
    text += fmt::format("{:>8.3f} {:>8.3f} {:>11} {:>9} {:>8} {:>9} {:>8} {:>8}  {}{}\n", p->cost(),
                        p->least_ms("ms_median"), cell("trajectory_mm_rms", 1.0), cell("drape_mm_rms", 1.0),
                        cell("in_body_mm_surface", 1.0), cell("longer_pct_p99", 1.0), cell("missed_contacts", 100.0),
                        cell("false_contacts", 100.0), p->name,
                        p->good() ? "" : fmt::format("  FAILED {} of {}: {}", p->failed, p->rows.size(), p->reason));
  }
  return text;
}

} // namespace tutu::app
