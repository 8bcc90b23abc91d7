#include "src/run/settings_table.h"

#include "cloth/solver.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tutu::app {
namespace {

using Settings = RunSettings;

template <auto k_member> double get(const Settings& settings) { return static_cast<double>(settings.*k_member); }
template <auto k_member> void set(Settings& settings, double value) {
  auto& member = settings.*k_member;
  member = static_cast<std::remove_reference_t<decltype(member)>>(value);
}

/// What a row calls its setting, here and there.
struct Names {
  const char *name, *section, *key, *words, *said;
};

template <auto k_member> constexpr SettingRow choice(const Names& n, std::span<const std::string_view> names) {
  return {n.name,         n.section,      n.key,         n.words, n.said, names, 0, static_cast<int>(names.size()) - 1,
          &get<k_member>, &set<k_member>, &get<k_member>};
}
template <auto k_member> constexpr SettingRow number(const Names& n, int least, int most) {
  return {n.name, n.section, n.key, n.words, n.said, {}, least, most, &get<k_member>, &set<k_member>, &get<k_member>};
}
template <auto k_member> constexpr SettingRow on_off(const Names& n) { return number<k_member>(n, 0, 1); }

constexpr SettingRow with_fractions(SettingRow row) {
  row.has_fractions = true;
  return row;
}

constexpr SettingRow repeating(SettingRow row) {
  row.repeats = true;
  return row;
}

constexpr SettingRow except_for_drapes(SettingRow row, double (*drapes)(const Settings&)) {
  row.drapes = drapes;
  return row;
}

constexpr SettingRow k_table[] = {
    choice<&Settings::solver>({"solver", "solver", "name", "how cloth is solved", "{}"}, cloth::k_solver_names),
    // Against proxies all answer alike.
    except_for_drapes(choice<&Settings::backend>({"backend", "collision", "backend",
                                                  "how particles ask colliders; mesh: the true, skinned body and no "
                                                  "proxies",
                                                  "{}"},
                                                 proxies::k_backend_names),
                      [](const Settings& s) { return s.backend == proxies::Backend::mesh ? 1.0 : 0.0; }),
    number<&Settings::substeps>({"substeps", "solver", "substeps", "substeps a frame", "{} substeps"}, 1, 10000),
    on_off<&Settings::adaptive_substeps>({"adaptive_substeps", "solver", "adaptive_substeps",
                                          "more substeps in frames where something moves too fast for those",
                                          "adaptive substeps {}"}),
    with_fractions(number<&Settings::frames_per_second>(
        {"frames_per_second", "solver", "frames_per_second", "frames a second, as 29.97", "{} frames/s"}, 1, 10000)),
    choice<&Settings::features>({"features", "collision", "features",
                                 "what of the cloth meets colliders; auto: triangles where they could be reached "
                                 "between particles",
                                 "features {}"},
                                cloth::k_contact_features_names),
    on_off<&Settings::swept>(
        {"swept", "collision", "swept", "contacts by time of impact where something moves far", "swept {}"}),
    number<&Settings::passes>({"passes", "solver", "passes", "passes over the constraints, a substep", "{} passes"}, 1,
                              100),
    on_off<&Settings::double_precision>(
        {"double_precision", "solver", "double_precision", "the solver's kernels in double", "double precision {}"}),
    on_off<&Settings::self_collision>(
        {"self_collision", "collision", "self_collision", "each garment meets itself", "self collision {}"}),
    except_for_drapes(
        number<&Settings::threads>({"threads", "solver", "threads",
                                    "threads that step garments side by side; the result is the same", "{} threads"},
                                   1, k_most_threads),
        nullptr),
    except_for_drapes(
        with_fractions(number<&Settings::uneven_mm>(
            {"uneven_mm", "solver", "uneven_mm",
             "how far free particles start off their drape, at most, mm along each axis", "uneven by {} mm"},
            0, 100)),
        nullptr),
    repeating(except_for_drapes(
        number<&Settings::seed>({"seed", "solver", "seed", "which uneven start that is", "seed {}"}, 1, 1'000'000),
        nullptr)),
};

std::string_view kind_of(const cloth::Garment& garment) {
  return garment.rows > 0 ? "a grid or tube" : "a mesh or disc";
}

} // namespace

std::span<const SettingRow> settings_table() { return k_table; }

const SettingRow* find_setting(std::string_view name) {
  for (const SettingRow& row : k_table)
    if (row.name == name) return &row;
  return nullptr;
}

std::vector<std::string> setting_names() {
  std::vector<std::string> names;
  for (const SettingRow& row : k_table) names.emplace_back(row.name);
  return names;
}

std::string text_of(const SettingRow& row, double value) {
  if (row.is_choice()) return std::string(row.names[static_cast<std::size_t>(value)]);
  if (row.is_switch()) return value != 0.0 ? "on" : "off";
  std::array<char, 64> digits{}; // the fewest that read back to the same bits
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed).ptr;
  return {digits.data(), end};
}

std::string expected_of(const SettingRow& row) {
  if (row.is_choice()) return fmt::format("one of: {}", fmt::join(row.names, ", "));
  return row.is_switch() ? "on or off" : fmt::format("from {} to {}", row.least, row.most);
}

std::optional<double> value_of(const SettingRow& row, std::string_view text) {
  if (row.is_choice()) {
    const auto found = std::find(row.names.begin(), row.names.end(), text);
    if (found == row.names.end()) return std::nullopt;
    return static_cast<double>(found - row.names.begin());
  }
  if (row.is_switch()) {
    if (text == "on" || text == "true") return 1.0;
    if (text == "off" || text == "false") return 0.0;
    return std::nullopt;
  }
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
  const bool read = error == std::errc() && end == text.data() + text.size();
  const bool fits = number >= row.least && number <= row.most && (row.has_fractions || number == std::floor(number));
  return read && fits ? std::optional(number) : std::nullopt;
}

double value_of(const SettingRow& row, const JsonValue& json) {
  if (row.is_choice()) return *value_of(row, json.string_among(row.names));
  if (row.is_switch()) return json.boolean() ? 1.0 : 0.0;
  return row.has_fractions ? json.number_in(row.least, row.most) : json.integer_in(row.least, row.most);
}

std::string option_of(const SettingRow& row) {
  std::string option = std::string("--") + row.name;
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

void read_section(const JsonValue& json, std::string_view section, RunSettings& settings,
                  std::vector<const SettingRow*>& stated) {
  std::vector<std::string_view> keys;
  for (const SettingRow& row : k_table)
    if (row.section == section) keys.emplace_back(row.key);
  json.only_keys(keys);
  for (const SettingRow& row : k_table) {
    if (row.section != section) continue;
    const auto value = json.find(row.key);
    if (!value) continue;
    row.set(settings, value_of(row, *value));
    stated.push_back(&row);
  }
}

std::optional<Unhonoured> unhonoured(const SettingRow& row, const RunSettings& settings,
                                     std::span<const cloth::Garment> garments) {
  for (const cloth::Garment& garment : garments) {
    RunSettings used = settings;
    static_cast<cloth::SolverOptions&>(used) = cloth::honoured(settings, garment, settings.backend);
    if (row.get(used) == row.get(settings)) continue;
    const auto said = [&](const RunSettings& s) {
      return fmt::format(fmt::runtime(row.said), text_of(row, row.get(s)));
    };
    return Unhonoured{said(settings),
                      fmt::format("{}, or nothing: solver {} with backend {} simulates {} ({}) with no other",
                                  said(used), cloth::name_of(settings.solver),
                                  proxies::k_backend_names[static_cast<std::size_t>(settings.backend)], garment.name,
                                  kind_of(garment))};
  }
  return std::nullopt;
}

} // namespace tutu::app
