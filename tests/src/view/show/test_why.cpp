// Why a particle is where it is, against numbers worked out here.
#include "proxies/distance/signed_distance.h"
#include "rig/error.h"
#include "src/scene/load.h"
#include "src/view/play/scene_player.h"
#include "src/view/show/overlay_contacts.h"
#include "src/view/show/why.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/small_scene.h"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

constexpr double k_frame = 1.0 / 60.0; // s

class WhyAParticle : public ::testing::Test {
protected:
  WhyAParticle()
      : folder_(test::scratch_folder()), file_(test::write_small_scene(folder_)),
        scene_(load_scene(read_scene(file_))) {}
  ~WhyAParticle() override { std::filesystem::remove_all(folder_); }

  /// Frames 0 to `last`.
  std::vector<FrameState> run(int last) const {
    Session session(scene_);
    session.start({scene_.garments[0].rest_positions});
    std::vector<FrameState> frames(1);
    capture(session, frames[0]);
    for (int f = 1; f <= last; ++f) {
      session.advance();
      capture(session, frames.emplace_back());
    }
    return frames;
  }

  std::filesystem::path folder_;
  std::string file_;
  LoadedScene scene_;
};

/// Distance from an upright capsule and the point of its axis that is nearest, by hand.
std::pair<double, Vec3> from_upright(const proxies::Capsule& c, const Vec3& p) {
  const Vec3 foot(c.a.x(), std::clamp(p.y(), std::min(c.a.y(), c.b.y()), std::max(c.a.y(), c.b.y())), c.a.z());
  return {(p - foot).norm() - c.radius, foot};
}

/// An edge against dense sampling of it.
TEST_F(WhyAParticle, AnEdgesContactsAreThoseOfItsNearestPoint) {
  const std::vector<FrameState> frames = run(12);
  const cloth::Garment& garment = scene_.garments[0];
  const std::vector<Vec3>& positions = frames[12].garments[0].positions;
  const double gap = garment.fabric.contact_offset();
  int touching = 0;
  for (std::size_t k = 0; k < garment.springs.size(); ++k) {
    const cloth::Spring& spring = garment.springs[k];
    const WhyEdge why = explain_edge(scene_, 0, static_cast<int>(k), frames[12]);
    EXPECT_EQ(why.i, spring.i);
    EXPECT_EQ(why.j, spring.j);
    EXPECT_DOUBLE_EQ(why.strain(), (positions[spring.j] - positions[spring.i]).norm() / spring.rest_length - 1.0);
    double nearest = 1e9;
    for (int n = 0; n <= 1000; ++n) {
      const Vec3 point = positions[spring.i] + 0.001 * n * (positions[spring.j] - positions[spring.i]);
      nearest = std::min(nearest, from_upright(frames[12].colliders_end[0], point).first);
    }
    ASSERT_EQ(why.contacts.size(), nearest < gap + k_touch_slack ? 1u : 0u) << nearest;
    if (why.contacts.empty()) continue;
    ++touching;
    EXPECT_NEAR(why.contacts[0].distance, nearest, 1e-6);
    EXPECT_NEAR(why.contacts[0].depth, std::max(0.0, gap - nearest), 1e-6);
    const Vec3 at = positions[spring.i] + why.contacts[0].at * (positions[spring.j] - positions[spring.i]);
    EXPECT_NEAR(from_upright(frames[12].colliders_end[0], at).first, nearest, 1e-6);
  }
  EXPECT_GT(touching, 5);
}

TEST_F(WhyAParticle, AClickBetweenTwoFindsTheirEdge) {
  ScenePlayer player(scene_, {scene_.garments[0].rest_positions}, 20);
  player.views({});
  const std::vector<Vec3f> at = [&] {
    std::vector<Vec3f> all;
    for (const Vec3& p : player.shown().garments[0].positions) all.push_back(p.cast<float>());
    return all;
  }();
  const auto click = [&](const Vec3f& target) {
    const Vec3f eye(0.1f, 3.0f, 0.2f), direction = (target - eye).normalized();
    player.pick(Player::Ray{eye, direction, 0.02f});
  };
  for (const int i : {12, 30, 50}) {
    click(at[i]);
    EXPECT_TRUE(player.why_shown() && player.why_shown()->particle == i && !player.why_edge()) << i;
    click(0.5f * (at[i] + at[i + 1]));
    const auto edge = player.why_edge();
    ASSERT_TRUE(edge && !player.why_shown()) << i;
    EXPECT_EQ(std::minmax(edge->i, edge->j), std::minmax(i, i + 1));
  }
}

TEST_F(WhyAParticle, ItsContactsAndConstraintsAreThoseOfPlainLoops) {
  const std::vector<FrameState> frames = run(12);
  const cloth::Garment& garment = scene_.garments[0];
  const double gap = garment.fabric.contact_offset();
  int touching = 0, pushed = 0;
  for (int i = 0; i < garment.particle_count(); ++i) {
    const Why why = explain(scene_, 0, i, frames[12], &frames[11]);
    const Vec3& p = frames[12].garments[0].positions[i];
    EXPECT_EQ(why.position, p);
    EXPECT_EQ(why.pinned, cloth::pinned_flags(garment)[i] == 1);

    const auto [distance, foot] = from_upright(frames[12].colliders_end[0], p);
    const Vec3 v = frames[11].garments[0].velocities[i] + k_frame * Vec3(0, -9.81, 0);
    const Vec3 ahead = frames[11].garments[0].positions[i] + k_frame * v;
    const auto [ahead_distance, ahead_foot] = from_upright(frames[12].colliders_end[0], ahead);
    const double projection = why.pinned ? 0.0 : std::max(0.0, gap - ahead_distance);
    const bool expected = distance < gap + k_touch_slack || projection > 0.0;
    ASSERT_EQ(why.contacts.size(), expected ? 1u : 0u) << i; // the ground is far
    if (expected) {
      const WhyContact& contact = why.contacts[0];
      EXPECT_EQ(contact.collider, scene_.proxies[0].name);
      EXPECT_NEAR(contact.distance, distance, 1e-12);
      EXPECT_NEAR(contact.depth, std::max(0.0, gap - distance), 1e-12);
      EXPECT_LT((contact.normal - (p - foot).normalized()).norm(), 1e-9);
      EXPECT_NEAR(contact.projection, projection, 1e-12);
      if (projection > 0.0) {
        // The capsule turns about its own axis only: its surface goes across the normal.
        const Vec3 normal = (ahead - ahead_foot).normalized();
        EXPECT_NEAR(contact.cancelled, std::max(0.0, -v.dot(normal)), 1e-3);
        ++pushed;
      }
      ++touching;
    }
    std::size_t springs = 0;
    for (const cloth::Spring& spring : garment.springs) springs += spring.i == i || spring.j == i;
    ASSERT_EQ(why.constraints.size(), springs);
    for (std::size_t k = 0; k < why.constraints.size(); ++k) {
      const WhyConstraint& constraint = why.constraints[k];
      EXPECT_NEAR(constraint.length, (frames[12].garments[0].positions[constraint.other] - p).norm(), 1e-15);
      EXPECT_LE(constraint.strain(), why.constraints[k == 0 ? 0 : k - 1].strain());
    }
  }
  EXPECT_GT(touching, 5);
  EXPECT_GT(pushed, 5);
}

TEST_F(WhyAParticle, TheFirstFrameThatIsWrongIsFound) {
  std::vector<FrameState> frames = run(6);
  const int particle = 40;
  for (const FrameState& frame : frames) EXPECT_FALSE(wrong_in(scene_, 0, particle, frame)) << frame.index;
  // Pulled away from all its neighbours.
  frames[3].garments[0].positions[particle] += Vec3(0, 0.2, 0);
  const auto overlong = wrong_in(scene_, 0, particle, frames[3]);
  ASSERT_TRUE(overlong);
  EXPECT_EQ(overlong->frame, 3);
  EXPECT_EQ(overlong->what, "longer");
  double worst = 0.0;
  for (const cloth::Spring& spring : scene_.garments[0].springs)
    if (spring.kind == cloth::SpringKind::structural && (spring.i == particle || spring.j == particle))
      worst = std::max(worst,
                       (frames[3].garments[0].positions[spring.i] - frames[3].garments[0].positions[spring.j]).norm() /
                               spring.rest_length -
                           1.0);
  EXPECT_DOUBLE_EQ(overlong->value, worst);
  // Put into the capsule: that tells more than the longer thread.
  const proxies::Capsule& trunk = frames[4].colliders_end[0];
  frames[4].garments[0].positions[particle] = 0.5 * (trunk.a + trunk.b) + Vec3(0.1, 0, 0);
  const auto inside = wrong_in(scene_, 0, particle, frames[4]);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->what, scene_.proxies[0].name);
  EXPECT_NEAR(inside->value, trunk.radius - 0.1, 1e-6);
}

TEST_F(WhyAParticle, AProxyThatIsClickedTellsWhoTouchesIt) {
  ScenePlayer player(scene_, {scene_.garments[0].rest_positions}, 12);
  player.go(12);
  while (player.behind()) (void)player.views({});
  const Player::Ray ray{{0, 0.5f, 3}, {0, 0, -1}, 1e-4f}; // at the middle of the capsule, below the sheet
  player.pick(ray);
  EXPECT_FALSE(player.why_proxy()); // it is not drawn
  (void)player.views({.cloth = false, .proxies = true});
  player.pick(ray);
  const auto why = player.why_proxy();
  ASSERT_TRUE(why);
  EXPECT_EQ(why->name, scene_.proxies[0].name);
  EXPECT_EQ(why->frame, 12);
  EXPECT_NEAR(why->speed, 0.0, 1e-9); // it turns about its own axis
  const double gap = scene_.garments[0].fabric.contact_offset();
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(scene_.garments[0]);
  int touching = 0;
  double deepest = 0.0;
  for (std::size_t i = 0; i < pinned.size(); ++i) {
    if (pinned[i]) continue;
    const double distance =
        from_upright(player.shown().colliders_end[0], player.shown().garments[0].positions[i]).first;
    touching += distance < gap + k_touch_slack;
    deepest = std::max(deepest, gap - distance);
  }
  EXPECT_EQ(why->touching, touching);
  EXPECT_GT(touching, 5);
  EXPECT_NEAR(why->depth, deepest, 1e-12);
  player.pick({{0, 0.5f, 3}, {0, 1, 0}, 1e-4f});
  EXPECT_FALSE(player.why_proxy());
}

TEST_F(WhyAParticle, TheProgramSaysTheSame) {
  const auto json_file = folder_ / "why.json";
  const std::vector<FrameState> frames = run(10);
  const test::Outcome outcome =
      test::run_program({"play", file_, "--headless", "--no-pictures", "--why", "sheet:40@10", "--json", json_file});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json json = nlohmann::json::parse(read_file(json_file));
  EXPECT_EQ(json["frames"], 10);
  EXPECT_EQ(json["why"]["garment"], "sheet");
  EXPECT_EQ(json["why"]["particle"], 40);
  EXPECT_EQ(json["why"]["frame"], 10);
  EXPECT_TRUE(json["why"].contains("first_wrong"));
  EXPECT_NE(outcome.output.find("sheet 40 in frame 10"), std::string::npos) << outcome.output;
}

TEST_F(WhyAParticle, WhatDoesNotExistIsRefusedInOneLine) {
  for (const auto& [address, expected] :
       std::vector<std::pair<std::string, std::string>>{{"sheet:81@3", "a particle from 0 to 80"},
                                                        {"shirt:1@3", "a garment of the scene: sheet"},
                                                        {"sheet:1@100000", "a frame from 0 to"},
                                                        {"sheet:1", "GARMENT:PARTICLE@FRAME"},
                                                        {"sheet@1", "GARMENT:PARTICLE@FRAME"},
                                                        {"sheet:-1@3", "GARMENT:PARTICLE@FRAME"},
                                                        {"sheet:1x@3", "GARMENT:PARTICLE@FRAME"}}) {
    const test::Outcome outcome = test::run_program({"play", file_, "--no-pictures", "--why", address});
    EXPECT_EQ(outcome.status, 2) << address;
    EXPECT_NE(outcome.output.find(address), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find(expected), std::string::npos) << outcome.output;
  }
  const test::Outcome unknown = test::run_program({"play", file_, "--no-pictures", "--show", "contact"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.output.find("contact"), std::string::npos) << unknown.output;
}

} // namespace
} // namespace tutu::app
