#include "src/study/chart/row.h"

#include "rig/io/file_io.h"
#include "src/base/content_hash.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace tutu::app {
namespace {

struct Stage {
  const char* name;
  double FrameTimes::*ms;
};
constexpr Stage k_stages[] = {{"pose", &FrameTimes::pose},       {"proxies", &FrameTimes::proxies},
                              {"broad", &FrameTimes::broad},     {"cloth", &FrameTimes::cloth},
                              {"contact", &FrameTimes::contact}, {"skin", &FrameTimes::skin}};

std::size_t index_of(const std::string& column) {
  const auto& columns = row_columns();
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end()) throw std::out_of_range("no column " + column);
  return static_cast<std::size_t>(found - columns.begin());
}

Row row_for(const CellTask& task) {
  Row row;
  row.set("key", cell_key(task));
  row.set("reference", task.reference);
  row.set("scene", task.scene);
  row.set("name", task.setting.name);
  const SettingValues values = setting_values(task.setting);
  for (std::size_t k = 0; k < values.size(); ++k) row.set(setting_columns()[k], values[k]);
  row.set("seed", std::to_string(task.setting.seed));
  row.set("frames", std::to_string(task.protocol.frames));
  row.set("settle", std::to_string(task.protocol.settle));
  row.set("held", std::to_string(task.protocol.held));
  row.set("every", std::to_string(task.protocol.every));
  row.set("machine", machine_name());
  row.set("tutu", TUTU_VERSION);
  return row;
}

} // namespace

const std::vector<std::string>& row_columns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> names = {"key", "reference", "scene", "name"};
    names.insert(names.end(), setting_columns().begin(), setting_columns().end());
    for (const char* name : {"seed", "frames", "settle", "held", "every", "particles", "colliders", "machine", "tutu",
                             "outcome", "reason"})
      names.emplace_back(name);
    for (const Stage& stage : k_stages)
      for (const char* figure : {"median", "p99"}) names.push_back(fmt::format("{}_ms_{}", stage.name, figure));
    for (const char* name : {"ms_median",
                             "ms_p99",
                             "in_proxies_mm_max",
                             "in_proxies_mm_p99",
                             "in_proxies_mm_mean",
                             "in_proxies_mm_surface",
                             "in_body_mm_max",
                             "in_body_mm_p99",
                             "in_body_mm_mean",
                             "in_body_mm_surface",
                             "in_body_share",
                             "missed_contacts",
                             "false_contacts",
                             "longer_pct_max",
                             "longer_pct_p99",
                             "longer_pct_mean",
                             "shorter_pct_max",
                             "shorter_pct_p99",
                             "shorter_pct_mean",
                             "held_longer_pct_max",
                             "trajectory_mm_rms",
                             "trajectory_mm_max",
                             "drape_mm_rms",
                             "drape_mm_hausdorff",
                             "jitter",
                             "energy_drift_mj",
                             "recoveries",
                             "most_substeps",
                             "state_hash"})
      names.emplace_back(name);
    return names;
  }();
  return columns;
}

const std::string& Row::text(const std::string& column) const { return values_.at(index_of(column)); }

std::optional<double> Row::number(const std::string& column) const {
  const std::string& value = text(column);
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size() || !std::isfinite(number)) return {};
  return number;
}

SettingValues Row::setting() const {
  SettingValues values;
  for (const std::string& column : setting_columns()) values.push_back(text(column));
  return values;
}

void Row::set(const std::string& column, std::string text) { values_.at(index_of(column)) = std::move(text); }
void Row::set(const std::string& column, double number) { set(column, fmt::format("{:.6g}", number)); }

std::string cell_key(const CellTask& task) {
  ContentHash hash;
  hash.add(task.reference);
  for (const std::string& value : setting_values(task.setting)) hash.add(value);
  const std::string& proxies = task.setting.proxies;
  if (proxies != k_own_proxies && proxies != k_no_proxies) hash.add(read_file(proxies));
  hash.add(static_cast<std::uint64_t>(task.setting.seed));
  return hash.text();
}

Row row_of(const Scene& scene, const CellTask& task, const CellRun& run, const RunErrors& errors) {
  Row row = row_for(task);
  int particles = 0;
  for (const cloth::Garment& garment : scene.garments) particles += garment.particle_count();
  row.set("particles", std::to_string(particles));
  const auto enabled = [](const proxies::Proxy& proxy) { return proxy.enabled; };
  row.set("colliders", std::to_string(std::count_if(scene.proxies.begin(), scene.proxies.end(), enabled)));
  row.set("outcome", !run.failure.empty() ? "diverged" : run.recoveries > 0 ? "recovered" : "ok");
  row.set("reason", !run.failure.empty() ? run.failure
                    : run.recoveries > 0 ? fmt::format("{} frames diverged and were taken again", run.recoveries)
                                         : "");
  row.set("recoveries", std::to_string(run.recoveries));
  row.set("most_substeps", std::to_string(run.most_substeps));
  row.set("state_hash", fmt::format("{:016x}", run.state_hash));
  if (run.ms.empty()) return row;

  for (const Stage& stage : k_stages) {
    std::vector<double> ms;
    for (const FrameTimes& times : run.stages) ms.push_back(times.*stage.ms);
    row.set(fmt::format("{}_ms_median", stage.name), cloth::percentile(ms, 0.5));
    row.set(fmt::format("{}_ms_p99", stage.name), cloth::percentile(ms, 0.99));
  }
  std::vector<double> ms = run.ms;
  row.set("ms_median", cloth::percentile(ms, 0.5));
  row.set("ms_p99", cloth::percentile(ms, 0.99));
  if (task.setting.backend != proxies::Backend::mesh) {
    row.set("in_proxies_mm_max", 1e3 * run.in_proxies.max);
    row.set("in_proxies_mm_p99", 1e3 * run.in_proxies.p99);
    row.set("in_proxies_mm_mean", 1e3 * run.in_proxies.mean);
    row.set("in_proxies_mm_surface", 1e3 * run.surface_in_proxies);
  }
  row.set("longer_pct_max", 100.0 * run.strains.longer.max);
  row.set("longer_pct_p99", 100.0 * run.strains.longer.p99);
  row.set("longer_pct_mean", 100.0 * run.strains.longer.mean);
  row.set("shorter_pct_max", 100.0 * run.strains.shorter.max);
  row.set("shorter_pct_p99", 100.0 * run.strains.shorter.p99);
  row.set("shorter_pct_mean", 100.0 * run.strains.shorter.mean);
  row.set("held_longer_pct_max", 100.0 * run.strains.held_longer.max);
  if (!run.trajectory.moments.empty()) {
    row.set("in_body_mm_max", 1e3 * run.in_body.max);
    row.set("in_body_mm_p99", 1e3 * run.in_body.p99);
    row.set("in_body_mm_mean", 1e3 * run.in_body.mean);
    row.set("in_body_mm_surface", 1e3 * run.surface_in_body);
    row.set("in_body_share", run.share_in_body);
  }
  if (!run.failure.empty()) return row; // what follows is of a whole run
  row.set("missed_contacts", errors.missed);
  row.set("false_contacts", errors.false_contacts);
  row.set("trajectory_mm_rms", 1e3 * errors.trajectory_rms);
  row.set("trajectory_mm_max", 1e3 * errors.trajectory_max);
  row.set("drape_mm_rms", 1e3 * errors.drape_rms);
  row.set("drape_mm_hausdorff", 1e3 * errors.drape_hausdorff);
  row.set("jitter", run.jitter);
  row.set("energy_drift_mj", 1e3 * run.energy_rise);
  return row;
}

Row row_of_crash(const CellTask& task, const std::string& reason) {
  Row row = row_for(task);
  row.set("outcome", k_crashed);
  row.set("reason", reason);
  return row;
}

std::string machine_name() {
  std::ifstream info("/proc/cpuinfo");
  std::string model = "unknown processor";
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name") && line.find(": ") != line.npos) {
      model = line.substr(line.find(": ") + 2);
      break;
    }
  return fmt::format("{}, {} threads", model, std::thread::hardware_concurrency());
}

} // namespace tutu::app
