#include "src/study/chart/setting.h"

#include "proxies/proxy_file.h"
#include "src/run/session.h"
#include "src/run/settings_table.h"
#include "src/scene/load.h"
#include "src/study/chart/same_cloth.h"

#include <fmt/format.h>

namespace tutu::app {
namespace {

constexpr double k_easing_drag = 50.0; // 1/s: cloth sinks at 0.2 m/s and swings no more

/// What people call a value.
std::string in_words(const std::string& column, const std::string& value) {
  if (const SettingRow* row = find_setting(column)) return fmt::format(fmt::runtime(row->said), value);
  if (column == "resolution") return value + " x cells";
  if (value == k_no_proxies) return "no proxies";
  return value == k_own_proxies ? "the scene's proxies" : std::filesystem::path(value).stem().string();
}

} // namespace

Setting own_setting(const RunSettings& of_scene) {
  Setting setting;
  static_cast<RunSettings&>(setting) = of_scene;
  setting.name = "default";
  return setting;
}

const std::vector<std::string>& setting_columns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> names;
    for (const SettingRow& row : settings_table())
      if (!row.repeats) names.emplace_back(row.name);
    names.insert(names.end(), {"resolution", "proxies"});
    return names;
  }();
  return columns;
}

std::vector<std::string> setting_values(const Setting& s) {
  std::vector<std::string> values;
  for (const SettingRow& row : settings_table())
    if (!row.repeats) values.push_back(text_of(row, row.get(s)));
  values.insert(values.end(), {fmt::format("{:g}", s.resolution), s.proxies});
  return values;
}

std::optional<Unhonoured> unhonoured(const Setting& setting, const Scene& scene) {
  for (const SettingRow& row : settings_table())
    if (row.get(setting) != row.get(scene.settings))
      if (auto wrong = unhonoured(row, setting, scene.garments)) return wrong;
  return std::nullopt;
}

std::string difference(const SettingValues& values, const SettingValues& others) {
  std::string text;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (values[k] != others[k]) text += (text.empty() ? "" : ", ") + in_words(setting_columns()[k], values[k]);
  return text;
}

std::vector<std::string> setting_options(const SettingValues& values, const SettingValues& own) {
  std::vector<std::string> options;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (values[k] == own[k]) continue;
    const std::string& column = setting_columns()[k];
    const SettingRow* row = find_setting(column);
    const std::string option = row ? option_of(*row) : "--" + column;
    if (row && row->is_switch()) {
      options.push_back(values[k] == "on" ? option : "--no" + option.substr(1));
    } else {
      options.push_back(option);
      options.push_back(values[k]);
    }
  }
  return options;
}

LoadedScene with_setting(const LoadedScene& scene, const Setting& setting) {
  LoadedScene result = scene;
  result.settings = setting;
  SceneFiles& files = result.files;
  if (setting.proxies == k_no_proxies) {
    files.proxies.reset();
    result.proxies.clear();
  } else if (setting.proxies != k_own_proxies) {
    files.proxies = setting.proxies;
    result.proxies = proxies::read_proxies(setting.proxies, result.character.skeleton);
  }
  if (setting.resolution == 1.0) return result;
  for (std::size_t g = 0; g < files.garments.size(); ++g) {
    files.garments[g].resolution *= setting.resolution;
    WornGarment worn = put_on(files.garments[g], result.character);
    result.garments[g] = std::move(worn.garment);
    result.attachment_joints[g] = std::move(worn.joints);
    result.skin_pins[g] = std::move(worn.skin_pins);
  }
  return result;
}

GarmentPositions start_at_resolution(const LoadedScene& scene, const GarmentPositions& start, double resolution) {
  if (resolution == 1.0) return start;
  Setting setting = own_setting(scene.settings);
  setting.resolution = resolution;
  setting.uneven_mm = 0.0; // what is to start from here is made so
  const LoadedScene other = with_setting(scene, setting);
  GarmentPositions positions;
  for (std::size_t g = 0; g < start.size(); ++g)
    positions.push_back(positions_on(scene.garments[g], start[g], other.garments[g]));
  Session session(other);
  session.start(positions);
  const auto pose = rig::first_pose(other.motion);
  for (int f = 0; f < other.settings.frames_per_second && !session.failure(); ++f)
    session.advance_to(pose, k_easing_drag);
  for (std::size_t g = 0; g < start.size(); ++g)
    positions[g] = session.garment(static_cast<int>(g)).particles().positions;
  return positions;
}

} // namespace tutu::app
