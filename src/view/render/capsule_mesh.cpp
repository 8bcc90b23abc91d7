#include "src/view/render/capsule_mesh.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace tutu::app {

CapsuleMesh capsule_mesh(int segments, int rings) {
  CapsuleMesh mesh;
  // Rows of latitude from -Y to +Y; the equator is there twice, once for each end, and the strip between is the mantle.
  const int rows = 2 * rings + 2;
  for (int row = 0; row < rows; ++row) {
    const bool upper = row > rings;
    const int step = upper ? row - 1 : row;
    const float latitude =
        std::numbers::pi_v<float> * (static_cast<float>(step) / static_cast<float>(2 * rings) - 0.5f);
    for (int s = 0; s < segments; ++s) {
      const float longitude = 2 * std::numbers::pi_v<float> * static_cast<float>(s) / static_cast<float>(segments);
      mesh.vertices.emplace_back(std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                                 std::cos(latitude) * std::sin(longitude), upper ? 1.0f : 0.0f);
    }
  }
  for (int row = 0; row + 1 < rows; ++row)
    for (int s = 0; s < segments; ++s) {
      const auto index = [&](int r, int column) {
        return static_cast<std::uint32_t>(r * segments + column % segments);
      };
      const std::uint32_t a = index(row, s), b = index(row, s + 1), c = index(row + 1, s), d = index(row + 1, s + 1);
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  return mesh;
}

} // namespace tutu::app
