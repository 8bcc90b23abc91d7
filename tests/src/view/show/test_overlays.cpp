// What the overlays are made of, counted against plain loops.
#include "src/measure/cloth_depths.h"
#include "src/view/show/overlay_body.h"
#include "src/view/show/overlay_cloth.h"
#include "src/view/show/overlay_colours.h"
#include "src/view/show/overlay_contacts.h"
#include "src/view/show/scene_view.h"

#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_motion.h"
#include "src/scene/load.h"
#include "tests/support/paths.h"
#include "tests/support/small_scene.h"

#include <gtest/gtest.h>
#include <random>
#include <set>

namespace tutu::app {
namespace {

/// The small scene, some frames on, its sheet lying on the capsule.
class Overlays : public ::testing::Test {
protected:
  Overlays()
      : folder_(test::scratch_folder()), scene_(load_scene(read_scene(test::write_small_scene(folder_)))),
        session_(scene_) {
    session_.start({scene_.garments[0].rest_positions});
    for (int f = 0; f < 12; ++f) session_.advance();
    capture(session_, state_);
  }
  ~Overlays() override { std::filesystem::remove_all(folder_); }

  const cloth::Garment& garment() const { return scene_.garments[0]; }
  const std::vector<Vec3>& positions() const { return state_.garments[0].positions; }

  std::filesystem::path folder_;
  LoadedScene scene_;
  Session session_;
  FrameState state_;
};

TEST_F(Overlays, TheStateIsTheSessions) {
  EXPECT_EQ(state_hash(state_), session_.state_hash());
  EXPECT_EQ(state_.index, 12);
  EXPECT_EQ(state_.garments[0].positions, session_.garment(0).particles().positions);
  EXPECT_EQ(state_.colliders_end.size(), 1u);
  EXPECT_GT(state_.bytes(), positions().size() * 2 * sizeof(Vec3));
}

TEST_F(Overlays, AnArrowForEachParticleWithinTheGap) {
  std::vector<Touch> touches;
  find_touches(garment(), positions(), state_.swept(), touches);
  const double gap = garment().fabric.contact_offset();
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garment());
  int within = 0, of_all = 0;
  for (std::size_t i = 0; i < positions().size(); ++i) {
    if (pinned[i]) continue;
    ++of_all;
    const proxies::Capsule& c = state_.colliders_end[0]; // upright: distance by hand
    const Vec3& p = positions()[i];
    const Vec3 foot(c.a.x(), std::clamp(p.y(), std::min(c.a.y(), c.b.y()), std::max(c.a.y(), c.b.y())), c.a.z());
    within += (p - foot).norm() - c.radius < gap + k_touch_slack;
    within += p.y() < gap + k_touch_slack; // the ground
  }
  EXPECT_EQ(static_cast<int>(touches.size()), within);
  EXPECT_GT(within, of_all / 10); // it shows something,
  EXPECT_LT(within, of_all);      // and not everything
  std::vector<LineView> lines;
  add_touches(touches, gap, lines);
  EXPECT_EQ(lines.size(), 2 * touches.size()); // shaft and head
  for (const Touch& touch : touches)
    EXPECT_LT(
        (touch.contact.closest + touch.contact.distance * touch.contact.normal - positions()[touch.particle]).norm(),
        1e-12);
}

TEST_F(Overlays, AnArrowGrowsTenfoldWithDepthAndChangesColour) {
  const auto arrow = [](double distance) {
    Touch touch;
    touch.contact.distance = distance;
    std::vector<LineView> lines;
    add_touches(std::span(&touch, 1), 0.006, lines);
    return lines;
  };
  const auto length = [](const std::vector<LineView>& lines) { return (lines[1].b - lines[0].a).norm(); };
  EXPECT_NEAR(length(arrow(0.006)), k_touch_arrow, 1e-6);
  EXPECT_NEAR(length(arrow(0.001)), k_touch_arrow + 10 * 0.005, 1e-6);
  EXPECT_EQ(arrow(0.006)[0].colour, k_green);
  EXPECT_EQ(arrow(0.001)[0].colour, k_orange);
  EXPECT_EQ(arrow(-0.001)[0].colour, k_vermilion);
}

TEST_F(Overlays, ALineForEachThreadAndDiagonal) {
  std::vector<LineView> lines;
  add_strain(garment(), positions(), lines);
  std::size_t expected = 0;
  for (const cloth::Spring& spring : garment().springs) expected += spring.kind != cloth::SpringKind::bend;
  EXPECT_EQ(lines.size(), expected);
  EXPECT_GT(expected, 100u);
  const std::vector<double> strains = cloth::strains_of(garment(), state_.garments[0]); // structural springs come first
  for (std::size_t s = 0; s < strains.size(); ++s) EXPECT_EQ(lines[s].colour, strain_colour(strains[s])) << s;
}

TEST(OverlayColours, StrainDarkensEvenlyEitherWay) {
  const auto light = [](double strain) {
    const Colour c = strain_colour(strain);
    return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
  };
  for (const double side : {-1.0, 1.0}) {
    float before = light(0.0);
    for (int k = 2; k <= 20; ++k) {
      const float now = light(side * 0.005 * k + side * 1e-9);
      EXPECT_LE(now, before) << side * 0.005 * k;
      before = now;
    }
    EXPECT_LT(before, 0.3f * light(0.0));
    EXPECT_EQ(light(side * 0.2), before); // beyond the scale the last colour
  }
  EXPECT_GT(strain_colour(0.1)[0], strain_colour(0.1)[2]);   // longer: warm
  EXPECT_LT(strain_colour(-0.1)[0], strain_colour(-0.1)[2]); // shorter: cold
}

TEST_F(Overlays, PinsAndSeamsAreMarked) {
  std::vector<PointView> points;
  std::vector<LineView> lines;
  add_attachments(garment(), positions(), points, lines);
  EXPECT_EQ(points.size(), garment().pins.size());
  EXPECT_EQ(lines.size(), garment().pins.size() - 1); // one row
  cloth::Garment sewn = garment();
  sewn.seams = {{10, 11}, {19, 20}};
  points.clear();
  lines.clear();
  add_attachments(sewn, positions(), points, lines);
  EXPECT_EQ(points.size(), garment().pins.size() + 2);
  EXPECT_EQ(lines.size(), garment().pins.size() - 1 + 1); // 10 and 19 are neighbours
}

TEST_F(Overlays, SweptBoxesHoldWhatTheColliderPasses) {
  std::vector<LineView> lines;
  add_swept_boxes(state_.swept(), lines);
  ASSERT_EQ(lines.size(), 12u);
  Vec3f low = lines[0].a, high = low;
  std::set<std::tuple<float, float, float>> corners;
  for (const LineView& line : lines)
    for (const Vec3f& p : {line.a, line.b}) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
      corners.emplace(p.x(), p.y(), p.z());
    }
  EXPECT_EQ(corners.size(), 8u);
  const double r = state_.colliders_end[0].radius;
  EXPECT_NEAR(high.y() - low.y(), 0.4 + 2 * r, 1e-5);
  EXPECT_NEAR(high.x() - low.x(), 2 * r, 1e-5);
}

TEST(OverlayBody, ASweepIsDrawnWhereSomethingMoves) {
  const std::vector<proxies::Capsule> start = {{{0, 0, 0}, {1, 0, 0}, 0.1}, {{0, 2, 0}, {0, 2, 0}, 0.2}};
  std::vector<proxies::Capsule> end = start;
  std::vector<CapsuleView> capsules;
  std::vector<LineView> lines;
  add_sweeps({start, end, {}, {}}, capsules, lines);
  EXPECT_TRUE(capsules.empty());
  end[0].b = {0, 1, 0};
  add_sweeps({start, end, {}, {}}, capsules, lines);
  ASSERT_EQ(capsules.size(), static_cast<std::size_t>(k_sweep_poses));
  EXPECT_EQ(lines.size(), 2u * k_sweep_poses);
  for (int k = 0; k < k_sweep_poses; ++k) {
    const proxies::Capsule at = proxies::capsule_at(start[0], end[0], static_cast<double>(k) / k_sweep_poses);
    EXPECT_LT((capsules[k].b - at.b.cast<float>()).norm(), 1e-6f);
  }
}

TEST_F(Overlays, TheBroadPhaseIsTheSolversOwn) {
  const BroadPhaseState& broad = state_.broad[0];
  ASSERT_FALSE(broad.boxes.empty());
  ASSERT_EQ(broad.begin.size(), broad.boxes.size() + 1);
  for (const Vec3& p : positions()) { // the tiles cover the cloth
    bool covered = false;
    for (const proxies::Box& box : broad.boxes) covered |= box.contains(p);
    EXPECT_TRUE(covered);
  }
  const proxies::Box swept = proxies::swept_box(state_.colliders_start[0], state_.colliders_end[0]);
  std::size_t candidates = 0;
  for (const proxies::Box& box : broad.boxes) candidates += box.intersects(swept);
  EXPECT_GT(candidates, 0u);
  std::vector<LineView> lines;
  add_broad_phase(broad, positions(), state_.swept(), lines);
  EXPECT_EQ(lines.size(), 12 * broad.boxes.size() + candidates);
}

TEST_F(Overlays, ParticlesHaveTheirCandidatesWhereEachIsAsked) {
  scene_.settings.backend = proxies::Backend::brute;
  Session session(scene_);
  session.start({garment().rest_positions});
  session.advance();
  FrameState state;
  capture(session, state);
  ASSERT_TRUE(state.broad[0].boxes.empty());
  ASSERT_EQ(state.broad[0].begin.size(), positions().size() + 1);
  std::vector<LineView> lines;
  add_broad_phase(state.broad[0], positions(), state.swept(), lines);
  std::size_t expected = 0;
  for (const int collider : state.broad[0].colliders) expected += collider < state.swept().size();
  EXPECT_EQ(lines.size(), expected);
  EXPECT_GT(expected, 0u);
}

TEST_F(Overlays, EveryLayerAddsSomethingAndALegend) {
  session_.skin_body();
  SceneView view(scene_);
  for (Vec3* end : {&state_.colliders_start[0].a, &state_.colliders_start[0].b}) end->x() += 0.05; // it went somewhere
  const SkinView skin{session_.body_positions(), session_.body_normals()};
  const auto size = [&](const Layers& layers) {
    const FrameView frame = view.frame(state_, skin, layers);
    std::size_t coloured = 0;
    for (const SurfaceView& surface : frame.surfaces) coloured += surface.colours.size() + surface.wireframe;
    return frame.surfaces.size() + frame.lines.size() + frame.threads.size() + frame.points.size() +
           frame.marks.size() + frame.capsules.size() + frame.ground + coloured;
  };
  const std::size_t plain = size({});
  const std::set<std::string> speak_for_themselves = {"body",      "cloth",     "ground",
                                                      "wireframe", "particles", "proxy-error"};
  for (const LayerInfo& layer : k_layers) {
    Layers layers;
    layers.*layer.member = !(layers.*layer.member);
    EXPECT_NE(size(layers), plain) << layer.name;
    EXPECT_EQ(legend_of(layers).empty(), speak_for_themselves.count(layer.name) > 0) << layer.name;
  }
  EXPECT_EQ(size({}), plain); // what was shown leaves nothing behind
}

TEST(LayerTable, EveryLayerHasItsOwnNameAndKey) {
  std::set<std::string> names;
  std::set<char> keys;
  for (const LayerInfo& layer : k_layers) {
    names.insert(layer.name);
    keys.insert(layer.key);
  }
  EXPECT_EQ(names.size(), k_layers.size());
  EXPECT_EQ(keys.size(), k_layers.size());
  for (const char taken : {'r', 'j'}) EXPECT_EQ(keys.count(taken), 0u) << taken;
}

} // namespace
} // namespace tutu::app
