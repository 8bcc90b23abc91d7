// A seam carries a load as the cloth beside it does.
#include "cloth/metrics.h"
#include "cloth/xpbd.h"
#include "proxies/query/collision_query.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::cloth;

namespace {

constexpr int k_rows = 12, k_cells = 30;

/// A hose of k_cells around, woven shut or sewn along `seam` of its rows, held along two lines a quarter of the way
/// around from the seam (column 0) on either side.
Garment hose(std::optional<double> seam) {
  GarmentDescription description;
  description.file = "hose";
  TubeShape shape;
  shape.rows = k_rows;
  shape.columns = seam ? k_cells + 1 : k_cells;
  shape.seam = seam;
  shape.rings = {{1.0, 0.15, 0.15, 0, 0}, {0.7, 0.15, 0.15, 0, 0}};
  description.shape = shape;
  description.fabric.damping = 0.0;
  Garment garment = build_garment(description);
  for (int row = 0; row < k_rows; ++row)
    for (const int column : {7, 23}) garment.pins.push_back({row * garment.columns + column, 0});
  return garment;
}

/// Pulls the lines `by` apart and waits.
std::vector<Vec3> pulled(const Garment& garment, bool is_double, double by) {
  const auto solver = make_xpbd(garment, {.double_precision = is_double});
  const auto query = proxies::make_query(proxies::Backend::brute);
  FrameInput input;
  input.gravity.setZero();
  input.substeps = 12;
  input.extra_drag = 5.0;
  const Vec3 way = 0.5 * by * (garment.rest_positions[7] - garment.rest_positions[23]).normalized();
  std::vector<Vec3> from, to;
  const auto place = [&](double share, std::vector<Vec3>& pins) {
    pins.clear();
    for (const Pin& pin : garment.pins) {
      const Vec3& x = garment.rest_positions[pin.particle];
      pins.push_back(x + (pin.particle % garment.columns == 7 ? share : -share) * way);
    }
  };
  for (int frame = 0; frame < 120; ++frame) {
    place(std::min(1.0, frame / 60.0), from);
    place(std::min(1.0, (frame + 1) / 60.0), to);
    input.pins_start = from;
    input.pins_end = to;
    EXPECT_FALSE(solver->step(input, *query).has_value()) << frame;
  }
  return solver->particles().positions;
}

double longest(const Garment& garment, std::span<const Vec3> x) {
  return longest_thread(MeasuredParts(garment), x).longer;
}

class Seams : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Precision, Seams, testing::Bool(),
                         [](const auto& one) { return one.param ? "Double" : "Float"; });

/// How far the lines must be apart for the cloth between them to be straight and 4 % longer.
double taut(const Garment& garment) {
  const auto& x = garment.rest_positions;
  return 1.04 * 2.0 * 7.0 * (x[7] - x[6]).norm() - (x[7] - x[23]).norm();
}

// Sides that are only put together, and no more, carry it at 9 %.
TEST_P(Seams, CarryWhatClothCarries) {
  const Garment whole = hose(std::nullopt), sewn = hose(1.0);
  const double of_cloth = longest(whole, pulled(whole, GetParam(), taut(whole)));
  const double of_seam = longest(sewn, pulled(sewn, GetParam(), taut(sewn)));
  EXPECT_GT(of_cloth, 0.035);
  EXPECT_LT(of_cloth, 0.06);
  EXPECT_NEAR(of_seam, of_cloth, 0.012);
}

TEST_P(Seams, AreShutUnderLoad) {
  const Garment slit = hose(0.5);
  const std::vector<Vec3> x = pulled(slit, GetParam(), taut(slit));
  for (const Seam& seam : slit.seams) EXPECT_EQ(x[seam.i], x[seam.j]);
}

} // namespace
