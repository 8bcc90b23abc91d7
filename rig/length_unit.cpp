#include "rig/length_unit.h"

#include "rig/math.h"

#include <charconv>

namespace tutu::rig {

std::optional<double> metres_in(std::string_view text) {
  for (const LengthUnit& unit : k_length_units)
    if (text == unit.symbol || text == unit.name) return unit.metres;
  double metres = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), metres);
  if (failure != std::errc() || end != text.data() + text.size() || !(metres > 0.0 && metres <= k_largest_number))
    return std::nullopt;
  return metres;
}

} // namespace tutu::rig
