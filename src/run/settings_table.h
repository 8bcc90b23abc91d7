// Every setting of a run, once: what files, the command line, charts and hashes call it, what it may be, and what it
// is for. A new setting is a member of RunSettings (settings.h), a row here, and its use.
#pragma once

#include "cloth/garment/garment.h"
#include "rig/io/json_file.h"
#include "src/run/settings.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::app {

/// Values are numbers here: of a number itself, of a choice the place in `names`, of a switch 0 or 1. All are whole but
/// those of a row that says otherwise.
struct SettingRow {
  const char* name;    ///< in settings files (not where it `repeats`), of --split and in charts; as an option
                       ///< with - for _
  const char* section; ///< of a scene file, and
  const char* key;     ///< in there
  const char* words;   ///< what it is
  const char* said;    ///< what people call a value: a format for its text
  std::span<const std::string_view> names; ///< of a choice; else none
  int least = 0, most = 1;
  double (*get)(const RunSettings&) = nullptr;
  void (*set)(RunSettings&, double) = nullptr;
  /// What of it cloth that settles depends on; null: nothing.
  double (*drapes)(const RunSettings&) = nullptr;
  bool has_fractions = false; ///< of a number: 29.97
  bool repeats = false;       ///< runs that differ in it alone are runs of one setting: charts take several of each

  bool is_choice() const { return !names.empty(); }
  bool is_switch() const { return names.empty() && least == 0 && most == 1; }
  double standard() const { return get(RunSettings{}); } ///< where nobody says anything
};

std::span<const SettingRow> settings_table();
/// Null where there is none of that name.
const SettingRow* find_setting(std::string_view name);
/// All names.
std::vector<std::string> setting_names();

/// A value as charts and the command line have it: "12", "xpbd", "on".
std::string text_of(const SettingRow& row, double value);
/// What may be given: "from 1 to 100", "on or off", "one of: mass_spring, xpbd".
std::string expected_of(const SettingRow& row);
/// The value of a text (on, off, true and false for a switch); nothing where it is none.
std::optional<double> value_of(const SettingRow& row, std::string_view text);
/// Of JSON: true and false for a switch. Throws InputError as JsonValue.
double value_of(const SettingRow& row, const JsonValue& json);

/// As an option: "--self-collision".
std::string option_of(const SettingRow& row);

/// The values of a section of a scene file. Adds the rows that it states to `stated`. Throws InputError as JsonValue.
void read_section(const JsonValue& json, std::string_view section, RunSettings& settings,
                  std::vector<const SettingRow*>& stated);

/// One setting in place of the scene's, and who says so: an option of the command line, for messages.
struct SettingChange {
  const SettingRow* row;
  double value;
  std::string by;
};

/// What is wrong with stating this value for these garments: that one of them is simulated with another, since the
/// solver, the garment's kind or the backend knows no other (cloth::honoured). Nothing where all honour it.
struct Unhonoured {
  std::string found, expected;
};
std::optional<Unhonoured> unhonoured(const SettingRow& row, const RunSettings& settings,
                                     std::span<const cloth::Garment> garments);

/// Calls add(number) with whole numbers for all that cloth that settles depends on. Nothing for a setting at its
/// standard, so that a new one changes no hash of what was made before there was any.
template <class Add> void for_each_draping(const RunSettings& settings, const Add& add) {
  for (const SettingRow& row : settings_table()) {
    if (!row.drapes || row.drapes(settings) == row.drapes(RunSettings{})) continue;
    for (const char c : std::string_view(row.name)) add(c);
    const double value = row.drapes(settings);
    if (value == std::floor(value)) add(static_cast<int>(value));
    else
      for (const std::int32_t half : std::bit_cast<std::array<std::int32_t, 2>>(value)) add(half);
  }
}

} // namespace tutu::app
