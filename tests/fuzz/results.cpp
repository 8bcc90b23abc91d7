// Rows of results: read whatever happened to them, charted, and merged into another file. The input is the file; and,
// since no mutation keeps all names of columns, the rows of one whose first line is right.
#include "rig/error.h"
#include "src/study/chart/chart_points.h"
#include "src/study/chart/results_file.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {

void fuzz_results(std::string_view input) {
  try {
    (void)app::read_results(write_input(input, "raw.csv"));
  } catch (const InputError&) {
  }
  const std::filesystem::path file = write_input(app::csv_line(app::row_columns()) + std::string(input), "results.csv");
  const app::Results results = app::read_results(file);
  for (const app::Row& row : results.rows) {
    require(row.values().size() == app::row_columns().size(), "a row has every column");
    require(app::values_of_csv(app::csv_line(row.values())).has_value(), "a row reads back as written");
  }
  const std::vector<app::ChartPoint> points = app::points_of(results.rows, app::setting_values(app::own_setting({})));
  for (const app::ErrorAxis& axis : app::error_axes()) (void)app::front_of(points, axis);
  (void)app::default_verdict(points);
  (void)app::points_text(points);
  if (results.rows.size() > 8) return; // every row is flushed to disk by itself
  std::filesystem::remove(scratch() / "merged.csv");
  (void)app::merge_rows(file, scratch() / "merged.csv");
  (void)app::read_results(scratch() / "merged.csv");
}

} // namespace tutu::fuzz
