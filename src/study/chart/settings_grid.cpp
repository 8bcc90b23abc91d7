#include "src/study/chart/settings_grid.h"

#include "rig/io/json_file.h"
#include "src/run/settings_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <map>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_fitted = "fitted ";
constexpr std::size_t k_most_settings = 10'000;

std::string proxies_of(const JsonValue& json) {
  if (json.is_number()) return fitted_proxies(json.integer_in(1, 1000));
  const std::string text = json.string();
  if (text == k_own_proxies || text == k_no_proxies) return text;
  const fs::path file = (fs::path(json.file()).parent_path() / text).lexically_normal();
  if (!fs::is_regular_file(file))
    throw json.error("no file " + file.string(),
                     "scene, none, a number of proxies, or a file from the settings file's folder");
  return file.string();
}

/// Gives `setting` what one value of `column` says.
void set_value(Setting& s, const std::string& column, const JsonValue& json) {
  if (column == "resolution") s.resolution = json.number_in(0.01, 100.0);
  else if (column == "proxies") s.proxies = proxies_of(json);
  else if (const SettingRow* row = find_setting(column)) row->set(s, value_of(*row, json));
}

/// Settings, none of them twice.
class Settings {
public:
  /// Adds it unless it is there; one that is there gets the name.
  void add(Setting setting) {
    const auto [place, is_new] = places_.try_emplace(setting_values(setting), settings_.size());
    if (is_new) settings_.push_back(std::move(setting));
    else if (Setting& there = settings_[place->second]; there.name.empty()) there.name = setting.name;
  }
  std::vector<Setting> take() { return std::move(settings_); }

private:
  std::vector<Setting> settings_;
  std::map<SettingValues, std::size_t> places_;
};

Setting unnamed(const RunSettings& scene) {
  Setting setting = own_setting(scene);
  setting.name.clear();
  return setting;
}

/// Every combination of the values of one object, `most` of them.
std::vector<Setting> product_of(const JsonValue& json, const RunSettings& scene, std::size_t most) {
  std::vector<Setting> settings = {unnamed(scene)};
  if (const auto name = json.find("name")) settings.front().name = name->string();
  for (const auto& [key, value] : json.members()) {
    if (key == "name" || key == "comment") continue;
    const auto& columns = setting_columns();
    if (std::find(columns.begin(), columns.end(), key) == columns.end())
      throw value.error("unknown key \"" + key + "\"", fmt::format("name or one of: {}", fmt::join(columns, ", ")));
    const std::vector<JsonValue> values = value.is_array() ? value.items() : std::vector<JsonValue>{value};
    if (values.empty()) throw value.error("an empty grid: no value", "at least one value");
    if (values.size() > most / settings.size())
      throw value.error(fmt::format("{} values, {} times", values.size(), settings.size()),
                        fmt::format("at most {} settings in all of the file", k_most_settings));
    std::vector<Setting> more;
    for (const Setting& setting : settings)
      for (const JsonValue& one : values) set_value(more.emplace_back(setting), key, one);
    settings = std::move(more);
  }
  return settings;
}

} // namespace

std::vector<Setting> read_settings(const fs::path& file, const RunSettings& scene) {
  const JsonValue json = JsonValue::read(file);
  json.only_keys({"settings"});
  const std::vector<JsonValue> grids = json.at("settings").items();
  if (grids.empty()) throw json.at("settings").error("an empty grid of settings", "at least one object");
  Settings settings;
  settings.add(own_setting(scene));
  std::size_t asked = 0; // of the file, whether they are there already or not
  for (const JsonValue& grid : grids) {
    if (asked == k_most_settings) throw grid.error(fmt::format("at most {} settings before it", k_most_settings - 1));
    std::vector<Setting> product = product_of(grid, scene, k_most_settings - asked);
    asked += product.size();
    for (Setting& setting : product) settings.add(std::move(setting));
  }
  return settings.take();
}

Setting report_setting(const RunSettings& scene, const std::string& proxies) {
  Setting setting = own_setting(scene);
  setting.name = "report";
  setting.solver = cloth::SolverKind::mass_spring;
  setting.substeps = 5;
  // Of a scene at 29.97 in place of 30, 39.96: only so do both have frames at the same moments.
  const double rate = scene.frames_per_second;
  setting.frames_per_second = k_report_rate * rate / std::round(rate);
  setting.adaptive_substeps = false;
  setting.proxies = proxies;
  return setting;
}

std::vector<Setting> builtin_settings(const SceneDescription& scene, bool quick) {
  Settings settings;
  settings.add(own_setting(scene.settings));
  const auto vary = [&](const std::function<void(Setting&)>& change) {
    Setting setting = unnamed(scene.settings);
    change(setting);
    settings.add(std::move(setting));
  };
  const auto fraction = [&](double times) {
    return std::max(1, static_cast<int>(times * scene.settings.substeps + 0.5));
  };

  // What takes longest comes first, so that no core waits for it at the end.
  for (const double times : quick ? std::vector{1.0 / 3} : std::vector{1.0 / 3, 1.0})
    vary([&](Setting& s) {
      s.backend = proxies::Backend::mesh;
      s.substeps = fraction(times);
    });
  for (const int substeps : {72, 144})
    vary([&](Setting& s) {
      s.solver = cloth::SolverKind::mass_spring;
      s.substeps = substeps;
    });
  vary([&](Setting& s) { s.substeps = fraction(4); });
  for (const auto features : {cloth::ContactFeatures::automatic, cloth::ContactFeatures::particles})
    for (const double times : {1.0 / 6, 1.0 / 3, 2.0 / 3, 1.0, 2.0})
      vary([&](Setting& s) {
        s.features = features;
        s.substeps = fraction(times);
      });
  vary([](Setting& s) { s.features = cloth::ContactFeatures::triangles; });
  for (const auto backend : {proxies::Backend::fcl, proxies::Backend::brute})
    vary([&](Setting& s) { s.backend = backend; });
  for (const double resolution : {0.5, 2.0}) vary([&](Setting& s) { s.resolution = resolution; });
  vary([](Setting& s) { s.swept = false; });
  vary([](Setting& s) { s.adaptive_substeps = false; });
  vary([](Setting& s) { s.passes = 2; });
  vary([](Setting& s) { s.proxies = k_no_proxies; });
  if (scene.garments.size() > 1) vary([](Setting& s) { s.threads = 2; });
  for (const int count : quick ? std::vector{18} : std::vector{12, 18, 24, 48})
    vary([&](Setting& s) { s.proxies = fitted_proxies(count); });
  if (!quick) {
    vary([](Setting& s) { s.self_collision = true; });
    vary([](Setting& s) { s.double_precision = true; });
    for (const double resolution : {0.75, 1.5, 3.0}) vary([&](Setting& s) { s.resolution = resolution; });
    vary([&](Setting& s) {
      s.resolution = 2.0;
      s.substeps = fraction(2);
    });
  }
  if (!scene.proxies) return settings.take();
  const fs::path hand = scene.proxies->parent_path() / (scene.proxies->stem().string() + "-hand.json");
  if (!fs::is_regular_file(hand)) return settings.take();
  for (const double times : {1.0 / 3, 1.0})
    vary([&](Setting& s) {
      s.proxies = hand.string();
      s.substeps = fraction(times);
    });
  settings.add(report_setting(scene.settings, hand.string()));
  return settings.take();
}

std::string fitted_proxies(int count) { return fmt::format("{}{}", k_fitted, count); }

std::optional<int> fitted_count(const Setting& setting) {
  if (!setting.proxies.starts_with(k_fitted)) return {};
  int count = 0;
  const char* end = setting.proxies.data() + setting.proxies.size();
  const auto [rest, error] = std::from_chars(setting.proxies.data() + k_fitted.size(), end, count);
  if (error != std::errc() || rest != end) return {};
  return count;
}

} // namespace tutu::app
