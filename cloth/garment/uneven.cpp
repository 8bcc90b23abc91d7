#include "cloth/garment/uneven.h"

namespace tutu::cloth {

void make_uneven(const Garment& garment, double most, std::mt19937_64& random, std::span<Vec3> positions) {
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  // Not std::uniform_real_distribution, whose numbers are each library's own.
  const auto shift = [&] { return most * (2.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1.0); };
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double x = shift(), y = shift(), z = shift();
    if (!pinned[i]) positions[i] += Vec3(x, y, z);
  }
}

} // namespace tutu::cloth
