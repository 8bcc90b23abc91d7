// The same garment of more or fewer particles.
#include "cloth/garment/garment.h"
#include "rig/error.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::cloth;

namespace {

GarmentDescription sheet() {
  GarmentDescription description;
  description.shape = GridShape{11, 5, Vec3::Zero(), Vec3::UnitX(), -2.0 * Vec3::UnitY()};
  return description;
}

TEST(Resampled, KeepsSizeMassAndWhatIsHeld) {
  GarmentDescription description = sheet();
  description.attachments = {{"Hips", 0, 2}, {"Hips", -2, -1, 0, 1}}; // the upper fifth; a corner from below
  const Garment before = build_garment(description), after = build_garment(resampled(description, 3.0));
  EXPECT_EQ(after.rows, 31);
  EXPECT_EQ(after.columns, 13);
  EXPECT_TRUE(after.rest_positions.back().isApprox(before.rest_positions.back()));
  const auto span = [](const Garment& g, int a) {
    const Attachment& held = g.attachments[a];
    const auto row = [&](int r) { return g.rest_positions[static_cast<std::size_t>(r) * g.columns].y(); };
    return std::pair(row(held.first_row), row(held.last_row));
  };
  for (const int a : {0, 1}) {
    EXPECT_NEAR(span(after, a).first, span(before, a).first, 1e-12) << a;
    EXPECT_NEAR(span(after, a).second, span(before, a).second, 1e-12) << a;
  }
  EXPECT_EQ(after.attachments[1].last_column, 3);
}

TEST(Resampled, ByOneChangesNothing) {
  const GarmentDescription same = resampled(sheet(), 1.0);
  EXPECT_EQ(std::get<GridShape>(same.shape).rows, 11);
}

TEST(Resampled, ATubeThatIsSewnKeepsItsSeamAndAWovenOneItsCells) {
  GarmentDescription description;
  TubeShape tube;
  tube.rows = 5;
  tube.columns = 12;
  tube.rings = {{1.0, 0.2, 0.2}, {0.5, 0.3, 0.3}};
  description.shape = tube;
  EXPECT_EQ(build_garment(resampled(description, 2.0)).columns, 24); // cells go all around
  tube.seam = 0.5;
  description.shape = tube;
  const Garment sewn = build_garment(resampled(description, 2.0));
  EXPECT_EQ(sewn.columns, 23);
  EXPECT_FALSE(sewn.seams.empty());
}

TEST(Resampled, ADiscGetsRingsAndAMeshIsRefused) {
  GarmentDescription disc;
  disc.shape = DiscShape{Vec3::Zero(), 0.3, 0.3, 4};
  EXPECT_EQ(std::get<DiscShape>(resampled(disc, 1.5).shape).rings, 6);
  GarmentDescription mesh;
  mesh.file = "cape.json";
  mesh.shape = MeshShape{};
  EXPECT_NO_THROW(resampled(mesh, 1.0));
  EXPECT_THROW(resampled(mesh, 2.0), InputError);
}

TEST(Resampled, TooFewParticlesAreRefusedWhenBuilt) {
  EXPECT_THROW(build_garment(resampled(sheet(), 0.01)), InputError);
  EXPECT_THROW(build_garment(resampled(sheet(), 1e6)), InputError);
}

} // namespace
