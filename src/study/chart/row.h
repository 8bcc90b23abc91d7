// One run as one row of results: every setting, every figure, the machine, and how it ended.
#pragma once

#include "src/study/chart/compare.h"
#include "src/study/chart/setting.h"

#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// Names of the columns, in order. "key" comes first and is what makes two rows the same run.
const std::vector<std::string>& row_columns();

/// Text by column; "" where there is no figure.
class Row {
public:
  Row() : values_(row_columns().size()) {}
  explicit Row(std::vector<std::string> values) : values_(std::move(values)) {}

  const std::vector<std::string>& values() const { return values_; }
  const std::string& text(const std::string& column) const;      ///< std::out_of_range for a column that is not there
  std::optional<double> number(const std::string& column) const; ///< nothing where there is no finite number
  SettingValues setting() const;                                 ///< setting_values of the setting it is about
  void set(const std::string& column, std::string text);
  void set(const std::string& column, double number);

private:
  std::vector<std::string> values_;
};

/// What a row is about.
struct CellTask {
  std::string scene;     ///< its name
  std::string reference; ///< fingerprint of what it is measured against
  Protocol protocol;     ///< in frames of the scene's own rate
  Setting setting;       ///< its seed, too
};

/// 16 hexadecimal digits of the reference, the setting (with the content of its proxies file) and the seed.
std::string cell_key(const CellTask& task);

/// `outcome` is "ok", or "diverged" (`reason`: where), or "recovered" (frames were taken again), or that of
/// row_of_crash. Anything but "ok" has failed. `scene` is as the setting has it.
Row row_of(const Scene& scene, const CellTask& task, const CellRun& run, const RunErrors& errors);

/// "crashed": a run whose process ended without a row.
inline constexpr const char* k_crashed = "crashed";
Row row_of_crash(const CellTask& task, const std::string& reason);

/// "AMD EPYC 7B13, 2 threads".
std::string machine_name();

} // namespace tutu::app
