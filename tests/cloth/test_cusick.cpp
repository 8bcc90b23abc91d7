// The drape coefficient of the shipped fabrics [Cusick 1968]: a disc of 30 cm over a support of 18 cm; the share of the
// overhanging ring that its shadow covers.
#include "cloth/garment_file.h"
#include "cloth/mesh_xpbd.h"
#include "rig/file_io.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>
#include <numbers>
#include <random>

using namespace tutu;
using namespace tutu::cloth;

namespace {

constexpr double k_radius = 0.15, k_support = 0.09; // m

double drape_coefficient(const Garment& garment, int rings, int substeps) {
  MeshXpbd<float> cloth(garment);
  // A flat disc is in (unstable) balance with itself: folds need something to begin with.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.001, 0.001);
  std::vector<Vec3> start = garment.rest_positions;
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  for (std::size_t i = 0; i < start.size(); ++i)
    if (!pinned[i]) start[i] += Vec3(shift(random), 3.0 * shift(random), shift(random));
  cloth.reset(start);
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  FrameInput input;
  input.pins_start = input.pins_end = pins;
  input.substeps = substeps;
  input.extra_drag = 3.0;
  const auto query = proxies::make_query(proxies::Backend::brute);
  for (int frame = 0; frame < 240; ++frame) EXPECT_FALSE(cloth.step(input, *query).has_value());

  const std::vector<Vec3>& x = cloth.particles().positions;
  const int border = 6 * rings, first = garment.particle_count() - border; // the last ring
  double shadow = 0.0;
  for (int k = 0; k < border; ++k) {
    const Vec3 &p = x[first + k], &q = x[first + (k + 1) % border];
    shadow += 0.5 * (p.z() * q.x() - p.x() * q.z());
  }
  const double support = std::numbers::pi * k_support * k_support, flat = std::numbers::pi * k_radius * k_radius;
  return (shadow - support) / (flat - support);
}

TEST(Cusick, FabricsDrapeWithinTheirPublishedBands_slow) {
  struct Band {
    const char* fabric;
    double least, most;
  };
  const auto folder = test::scratch_folder();
  for (const Band& band :
       {Band{"silk", 0.20, 0.40}, {"cotton", 0.60, 0.76}, {"wool", 0.40, 0.70}, {"denim", 0.70, 0.90}}) {
    constexpr int k_rings = 20, k_substeps = 60;
    // Threads as stiff as the fabrics' would need more substeps; so much less, and still none gives by 2 %.
    write_file(folder / "disc.json", R"({"shape": {"disc": {"centre": [0,1,0], "radius": 0.15, "rings": 20}},
      "fabric": {"base": ")" + test::source_file(std::string("assets/fabrics/") + band.fabric + ".json").string() +
                                         R"(", "stretch": 1000},
      "attachments": [{"joint": "support", "within": {"centre": [0,1,0], "radius": 0.0901}}]})");
    const double share = drape_coefficient(build_garment(read_garment(folder / "disc.json")), k_rings, k_substeps);
    EXPECT_GT(share, band.least) << band.fabric;
    EXPECT_LT(share, band.most) << band.fabric;
    RecordProperty(band.fabric, std::to_string(share));
  }
  std::filesystem::remove_all(folder);
}

} // namespace
