// Rows of results as points of a chart: the runs of one setting are one point.
#pragma once

#include "src/study/chart/row.h"

#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// An error that is charted against time.
struct ErrorAxis {
  const char* column; ///< of a row
  const char* stem;   ///< of the picture's name
  const char* title;
  double scale; ///< from the row's unit to the axis'
  double floor; ///< what is less is drawn here: an axis of logarithms has no zero
};
const std::vector<ErrorAxis>& error_axes();

/// A run whose cloth is deeper than k_most_depth (run_end.h) in the true body in any frame has failed: a setting that
/// leaves out what the body is made of would else be among the fastest, and its threads the least long.
struct ChartPoint {
  std::vector<Row> rows; ///< of its runs
  std::string name;      ///< what a person called it, or how it differs from the default
  bool named = false;    ///< by a person ("default", "report")
  int failed = 0;        ///< runs
  std::string reason;    ///< why, in short

  bool good() const { return failed == 0; }
  SettingValues values() const; ///< of the setting
  /// Median over its runs; nothing where none has a figure.
  std::optional<double> figure(const std::string& column) const;
  /// The least of its runs' "ms_p99" or "ms_median": what else a machine does only adds. 0 where none has it.
  double least_ms(const char* column) const;
  double cost() const { return least_ms("ms_p99"); } ///< ms a frame
};

/// In the order in which settings first come among the rows.
std::vector<ChartPoint> points_of(const std::vector<Row>& rows, const SettingValues& default_setting);

/// Indices of the good points on the front of cost and this error, by rising cost.
std::vector<int> front_of(const std::vector<ChartPoint>& points, const ErrorAxis& axis);

/// Whether the point named "default" is on each front, and if not what is better; and whether any point is better in
/// time and all errors at once. Some lines.
std::string default_verdict(const std::vector<ChartPoint>& points);

/// A table for a terminal, by rising cost.
std::string points_text(const std::vector<ChartPoint>& points);

/// Middle of some numbers: of an even count the mean of the two in the middle. Not empty.
double median(std::vector<double> values);

} // namespace tutu::app
