// What a garment can reach: all of it, at rest and hanging any way the tethers allow.
#include "cloth/garment/reach.h"
#include "proxies/distance/capsule_union.h"

#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::cloth;

namespace {

Garment sheet(bool held) {
  GarmentDescription description;
  description.shape = GridShape{6, 5, {0, 1, 0}, {0.4, 0, 0}, {0, -0.5, 0}};
  if (held) {
    Attachment top;
    top.joint = "Hips";
    description.attachments.push_back(top); // row 0
  }
  return build_garment(description);
}

std::vector<Vec3> pins_of(const Garment& garment) {
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  return pins;
}

TEST(Reach, CoversTheSheetAndNotTheRoom) {
  const Garment garment = sheet(true);
  const GarmentReach reach(garment);
  ASSERT_TRUE(reach.bounded());
  std::vector<proxies::Capsule> balls;
  reach.place(pins_of(garment), balls);
  ASSERT_EQ(balls.size(), 5u);
  proxies::CapsuleUnion all;
  all.assign(balls);
  for (const Vec3& p : garment.rest_positions) {
    EXPECT_LT(all.distance(p), 0.0);
    EXPECT_LT(all.distance(Vec3(p.x(), 2.0 - p.y(), p.z())), 0.0); // thrown up
    EXPECT_LT(all.distance(Vec3(p.x(), 1.0, 1.0 - p.y())), 0.0);   // forwards
  }
  EXPECT_GT(all.distance(Vec3(0.2, 0.2, 0)), 0.0); // 0.3 m below its lower edge
  EXPECT_GT(all.distance(Vec3(1.3, 1, 0)), 0.0);
}

TEST(Reach, FollowsThePins) {
  const Garment garment = sheet(true);
  std::vector<Vec3> pins = pins_of(garment);
  for (Vec3& pin : pins) pin.x() += 3.0;
  std::vector<proxies::Capsule> balls;
  GarmentReach(garment).place(pins, balls);
  proxies::CapsuleUnion all;
  all.assign(balls);
  EXPECT_LT(all.distance(Vec3(3.2, 0.6, 0)), 0.0);
  EXPECT_GT(all.distance(Vec3(0.2, 0.6, 0)), 0.0);
}

TEST(Reach, NothingBoundsAGarmentThatIsNotHeld) {
  const GarmentReach reach(sheet(false));
  EXPECT_FALSE(reach.bounded());
  std::vector<proxies::Capsule> balls;
  reach.place({}, balls);
  EXPECT_TRUE(balls.empty());
}

} // namespace
