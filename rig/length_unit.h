// The units of length that files are in.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace tutu::rig {

struct LengthUnit {
  const char* symbol;
  const char* name; ///< in the plural
  double metres;

  double per_metre() const { return 1.0 / metres; }
};
inline constexpr std::array<LengthUnit, 6> k_length_units = {{{"m", "metres", 1.0},
                                                              {"cm", "centimetres", 0.01},
                                                              {"mm", "millimetres", 0.001},
                                                              {"in", "inches", 0.0254},
                                                              {"ft", "feet", 0.3048},
                                                              {"dm", "decimetres", 0.1}}};

/// Metres in a unit: of a symbol or a name above, or of a number of metres ("0.01"). None for anything else.
std::optional<double> metres_in(std::string_view unit);
/// What metres_in takes, for messages.
inline constexpr const char* k_expected_unit = "m, cm, mm, dm, in, ft, or the metres in a unit";

} // namespace tutu::rig
