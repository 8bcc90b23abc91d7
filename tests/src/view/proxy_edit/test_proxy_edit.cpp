// The proxy editor's core: drags against their closed form, history, figures against brute force, the fit of one.
#include "proxies/distance/signed_distance.h"
#include "proxies/proxy_file.h"
#include "rig/io/file_io.h"
#include "src/view/proxy_edit/fit_one.h"
#include "src/view/proxy_edit/proxy_editor.h"
#include "tests/support/capsule_body.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <random>

namespace tutu::app {
namespace {

using proxies::Anchor;
using proxies::Capsule;
using proxies::Proxy;
using proxies::ProxyKind;
using test::CapsuleBody;

class Dice {
public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double number(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(engine_); }
  int below(int count) { return std::uniform_int_distribution(0, count - 1)(engine_); }
  Vec3 vector(double most) { return {number(-most, most), number(-most, most), number(-most, most)}; }
  Quat rotation(double most) {
    return Quat(Eigen::AngleAxisd(number(-most, most), (vector(1.0) + Vec3(0, 0, 1e-3)).normalized()));
  }

private:
  std::mt19937 engine_;
};

/// A trunk and two limbs, each a capsule along +Y.
const std::vector<Capsule> k_shapes = {{{0, 0.3, 0}, {0, 0.8, 0}, 0.12},
                                       {{0.3, 0.2, 0}, {0.3, 0.6, 0}, 0.06, -0.02},
                                       {{-0.3, 0.3, 0}, {-0.3, 0.7, 0}, 0.05}};

rig::Character character() {
  rig::Character result;
  result.skeleton.names = {"Hips", "Spine", "LeftArm"};
  result.skeleton.parents = {rig::k_no_parent, 0, 1};
  result.skeleton.rest_local = {Transform{Quat::Identity(), Vec3(0, 0.5, 0)},
                                Transform{Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX())), Vec3(0, 0.2, 0.01)},
                                Transform{Quat(Eigen::AngleAxisd(-0.5, Vec3::UnitZ())), Vec3(0.3, 0.05, 0)}};
  CapsuleBody body;
  for (const Capsule& shape : k_shapes) body.add(shape, 48, 12, 8);
  result.mesh.positions = body.positions;
  result.mesh.triangles = body.triangles;
  result.mesh.normals = rig::angle_weighted_normals(body.positions, body.triangles);
  return result;
}

Anchor on_joints(const std::vector<std::pair<int, double>>& joints, const Vec3& at_rest,
                 const std::vector<Transform>& rest) {
  Anchor anchor;
  for (const auto& [joint, weight] : joints) {
    anchor.joints[anchor.count] = joint;
    anchor.weights[anchor.count] = weight;
    anchor.points[anchor.count++] = rest[joint].inverse() * at_rest;
  }
  return anchor;
}

/// k_shapes as proxies, at rest, on the Hips.
std::vector<Proxy> proxies_on(const rig::Character& character) {
  const std::vector<Transform> rest = rig::rest_model(character.skeleton);
  std::vector<Proxy> result;
  for (const Capsule& shape : k_shapes) {
    Proxy proxy;
    proxy.name = fmt::format("p{}", result.size());
    proxy.kind = ProxyKind::capsule;
    proxy.a = on_joints({{0, 1.0}}, shape.a, rest);
    proxy.b = on_joints({{0, 1.0}}, shape.b, rest);
    proxy.radius = shape.radius;
    proxy.taper = shape.taper;
    result.push_back(proxy);
  }
  return result;
}

/// Where lines of sight through two points of the picture meet the plane through `place` that faces the camera: the way
/// from the one to the other.
Vec3 way_in_plane(const Ray& from, const Ray& to, const Vec3& place, const Vec3& normal) {
  const auto meet = [&](const Ray& ray) -> Vec3 {
    const double s = (place.dot(normal) - ray.origin.dot(normal)) / ray.direction.dot(normal);
    return ray.origin + s * ray.direction;
  };
  return meet(to) - meet(from);
}

TEST(ProxyEdit, DragsAreTheClosedForm) {
  const rig::Skeleton skeleton = character().skeleton;
  const std::vector<Transform> rest = rig::rest_model(skeleton);
  Dice dice(7);
  double worst = 0.0;
  int drags = 0, blends = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Transform> world;
    for (const Transform& joint : rest) world.push_back(Transform{dice.rotation(0.8), dice.vector(0.3)} * joint);
    const ProxyPose pose{world, rest};
    Proxy proxy;
    proxy.name = "p";
    proxy.kind = round % 4 == 0 ? ProxyKind::sphere : ProxyKind::capsule;
    const bool blend = round % 3 == 0;
    const double share = dice.number(0.1, 0.9);
    proxy.a = blend ? on_joints({{1, share}, {2, 1.0 - share}}, dice.vector(0.5), rest)
                    : on_joints({{1, 1.0}}, dice.vector(0.5), rest);
    proxy.b = proxy.kind == ProxyKind::sphere ? proxy.a : on_joints({{2, 1.0}}, dice.vector(0.5), rest);
    if (proxy.kind == ProxyKind::capsule && round % 5 == 0) { // halfway between two joints' origins
      proxy.b.count = 2;
      proxy.b.joints = {0, 2};
      proxy.b.weights = {0.5, 0.5};
      proxy.b.points.fill(Vec3::Zero());
    }
    proxy.radius = dice.number(0.05, 0.1);
    if (proxy.kind == ProxyKind::capsule && round % 2 == 0) proxy.taper = dice.number(-0.03, 0.03);
    Picture picture;
    picture.camera.eye = (dice.vector(0.5) + Vec3(0, 1, 4)).cast<float>();
    picture.camera.target = dice.vector(0.2).cast<float>();
    picture.width = 640;
    picture.height = 480;
    const Vec3 view = (picture.camera.target.cast<double>() - picture.camera.eye.cast<double>()).normalized();
    const Ray press = ray_through(picture, dice.number(200, 440), dice.number(150, 330));
    const Ray to = ray_through(picture, dice.number(200, 440), dice.number(150, 330));
    const Capsule before = posed(proxy, world);
    const bool alone = round % 7 == 0;
    for (const Handle& handle : handles_of(proxy, pose, view)) {
      const ProxyDrag drag(proxy, handle, pose, press, view);
      const Proxy after = drag.at(to, alone);
      const Vec3 way = way_in_plane(press, to, handle.place, view);
      Capsule expected = before;
      double radius_a = before.radius, radius_b = before.radius + before.taper;
      const bool both = proxy.taper == 0.0 && !alone;
      if (handle.kind == HandleKind::move || handle.kind == HandleKind::end_a) expected.a += way;
      if (handle.kind == HandleKind::move || handle.kind == HandleKind::end_b) expected.b += way;
      if (handle.kind == HandleKind::radius_a) {
        radius_a = std::max(k_least_radius, radius_a + way.dot(handle.place - before.a) / radius_a);
        if (both || proxy.kind == ProxyKind::sphere) radius_b = radius_a;
      }
      if (handle.kind == HandleKind::radius_b) {
        radius_b = std::max(k_least_radius, radius_b + way.dot(handle.place - before.b) / radius_b);
        if (both) radius_a = radius_b;
      }
      const Capsule got = posed(after, world);
      for (const double off : {(got.a - expected.a).norm(), (got.b - expected.b).norm(), got.radius - radius_a,
                               got.radius + got.taper - radius_b})
        worst = std::max(worst, std::abs(off));
      if (!blend && handle.kind == HandleKind::move) { // as authored, in the joint's frame
        const Vec3 in_joint = world[1].rotation.conjugate() * (expected.a - world[1].translation);
        worst = std::max(worst, (after.a.points[0] - in_joint).norm());
      }
      EXPECT_TRUE(same_proxies({drag.at(press, alone)}, {proxy})); // a pointer that comes back
      ++drags;
      blends += blend;
    }
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(blends, drags / 4);
  std::printf("%d drags, off the closed form by at most %.3g\n", drags, worst);
}

TEST(ProxyEdit, JointsThatFlattenTheRestPoseMoveNothing) {
  const std::vector<Transform> rest(2);
  std::vector<Transform> world(2);
  world[1].rotation = Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));
  const Anchor half = on_joints({{0, 0.5}, {1, 0.5}}, Vec3(0, 0.1, 0), rest);
  EXPECT_FALSE(anchor_at(half, Vec3(0, 1, 0), {world, rest}));
}

TEST(ProxyEdit, TheFirstSurfaceUnderThePointerIsMet) {
  const std::vector<Capsule> balls = {{{0, 0, 0}, {0, 0, 0}, 0.1}, {{0, 0, 1}, {0, 0, 1}, 0.1}};
  EXPECT_EQ(proxy_under({{0, 0, 4}, {0, 0, -1}}, balls), 1);
  EXPECT_EQ(proxy_under({{0, 0, -4}, {0, 0, 1}}, balls), 0);
  EXPECT_FALSE(proxy_under({{0, 1, 4}, {0, 0, -1}}, balls));
}

/// Does something at random, as a user would; the state after.
void edit(ProxyEditor& editor, Dice& dice) {
  const int count = static_cast<int>(editor.state().proxies.size());
  if (count > 0) editor.select(dice.below(count));
  editor.choose_joint(dice.below(3));
  const int what = dice.below(8);
  if (what == 0) editor.run(ProxyCommand::add_sphere);
  else if (what == 1) editor.run(ProxyCommand::add_capsule);
  else if (what == 2) editor.run(ProxyCommand::remove);
  else if (what == 3) editor.run(ProxyCommand::one_radius);
  else if (editor.selected()) {
    const auto handles = editor.handles();
    const Handle& handle = handles[dice.below(static_cast<int>(handles.size()))];
    const auto seen = project(editor.picture().camera, 640, 480, handle.place.cast<float>());
    ASSERT_TRUE(seen && editor.press(seen->x(), seen->y()));
    for (int k = 0; k < 3; ++k) editor.point(dice.number(100, 500), dice.number(100, 400), dice.below(2) == 0);
    editor.release();
  }
}

TEST(ProxyEdit, UndoComesBackToTheBit) {
  const rig::Character body = character();
  Dice dice(11);
  for (int round = 0; round < 10; ++round) {
    ProxyEditor editor(body, proxies_on(body), "");
    editor.set_picture({{{0, 0.8f, 3}, {0, 0.6f, 0}, 0.6f}, 640, 480}, 1.0f);
    std::vector<std::vector<Proxy>> states = {editor.state().proxies};
    for (int k = 0; k < 40; ++k) {
      edit(editor, dice);
      if (editor.document().undo_depth() == states.size()) states.push_back(editor.state().proxies);
      ASSERT_EQ(editor.document().undo_depth() + 1, states.size());
    }
    EXPECT_GT(states.size(), 25u);
    EXPECT_TRUE(editor.document().dirty());
    for (std::size_t k = states.size() - 1; k-- > 0;) {
      editor.run(ProxyCommand::undo);
      ASSERT_TRUE(same_proxies(editor.state().proxies, states[k]));
    }
    EXPECT_FALSE(editor.can_run(ProxyCommand::undo));
    EXPECT_FALSE(editor.document().dirty());
    for (std::size_t k = 1; k < states.size(); ++k) {
      editor.run(ProxyCommand::redo);
      ASSERT_TRUE(same_proxies(editor.state().proxies, states[k]));
    }
    EXPECT_FALSE(editor.can_run(ProxyCommand::redo));
  }
}

/// The same figures by sorting all samples.
void expect_brute(std::vector<std::pair<double, double>> errors, const proxies::ErrorFigures& figures) {
  std::sort(errors.begin(), errors.end());
  double all = 0.0, below = 0.0, squares = 0.0, p95 = 0.0;
  for (const auto& [error, area] : errors) {
    all += area;
    squares += area * error * error;
  }
  for (const auto& [error, area] : errors) {
    below += area;
    if (p95 = error; below >= 0.95 * all) break;
  }
  EXPECT_NEAR(figures.max, errors.back().first, 1e-12);
  EXPECT_NEAR(figures.rms, std::sqrt(squares / all), 1e-12);
  EXPECT_NEAR(figures.p95, p95, 1.01 * proxies::ErrorGatherer::k_bin);
}

TEST(ProxyEdit, FiguresAreThoseOfBruteForce) {
  const rig::Character body = character();
  const ProxyMeasure measure(body.mesh);
  Dice dice(3);
  for (int round = 0; round < 10; ++round) {
    std::vector<Capsule> shapes = k_shapes;
    for (Capsule& shape : shapes) {
      shape.a += dice.vector(0.03);
      shape.b += dice.vector(0.03);
      shape.radius *= dice.number(0.8, 1.2);
    }
    const int one = dice.below(3);
    const auto result = measure.measure(shapes, one);
    std::array<std::vector<std::pair<double, double>>, 2> under, over; // whole, one
    for (const SkinSpot& spot : measure.spots()) {
      double nearest = 1e9;
      int which = -1;
      for (int k = 0; k < 3; ++k)
        if (const double d = proxies::signed_distance(spot.place, shapes[k]).distance; d < nearest) {
          nearest = d;
          which = k;
        }
      for (const int set : {0, 1}) {
        if (set == 1 && which != one) continue;
        under[set].emplace_back(std::max(0.0, nearest), spot.area);
        over[set].emplace_back(std::max(0.0, -nearest), spot.area);
      }
    }
    EXPECT_GT(result.whole.samples, 3000);
    EXPECT_EQ(result.whole.samples, static_cast<int>(under[0].size()));
    EXPECT_EQ(result.one.samples, static_cast<int>(under[1].size()));
    expect_brute(under[0], result.whole.under);
    expect_brute(over[0], result.whole.over);
    expect_brute(under[1], result.one.under);
    expect_brute(over[1], result.one.over);
  }
}

TEST(ProxyEdit, FitOneRecoversACapsule) {
  const rig::Character body = character();
  const ProxyMeasure measure(body.mesh);
  Dice dice(5);
  double ends = 0.0, radii = 0.0;
  for (int round = 0; round < 30; ++round) {
    const int one = round % 3;
    std::vector<Capsule> shapes = k_shapes;
    Capsule& shape = shapes[one];
    shape.a += dice.vector(0.02);
    shape.b += dice.vector(0.02);
    shape.radius *= dice.number(0.8, 1.2);
    const Capsule fitted = fit_one(measure.spots(), shapes, one, false);
    ends = std::max({ends, (fitted.a - k_shapes[one].a).norm(), (fitted.b - k_shapes[one].b).norm()});
    radii = std::max({radii, std::abs(fitted.radius_at(0) - k_shapes[one].radius_at(0)),
                      std::abs(fitted.radius_at(1) - k_shapes[one].radius_at(1))});
  }
  // The mesh has its corners on the capsule and its faces up to 0.26 mm below.
  EXPECT_LT(ends, 1e-3);
  EXPECT_LT(radii, 5e-4);
  std::printf("ends off by at most %.3f mm, radii by %.3f mm\n", 1e3 * ends, 1e3 * radii);
}

TEST(ProxyEdit, FitOneNeverMakesItWorse) {
  const rig::Character body = character();
  const ProxyMeasure measure(body.mesh, 1500);
  Dice dice(9);
  int better = 0;
  for (int round = 0; round < 24; ++round) {
    std::vector<Capsule> shapes;
    for (int k = 0; k < 4; ++k) {
      Capsule shape{dice.vector(0.3) + Vec3(0, 0.5, 0), Vec3::Zero(), dice.number(0.02, 0.2)};
      shape.b = k == 0 ? shape.a : Vec3(shape.a + dice.vector(0.3));
      if (k == 1) shape.taper = dice.number(-0.01, 0.3); // also where one ball is all there is
      shapes.push_back(shape);
    }
    const int one = dice.below(4);
    const double before = skin_cost(measure.spots(), shapes);
    const double rms = measure.measure(shapes, one).whole.rms;
    shapes[one] = fit_one(measure.spots(), shapes, one, one == 0);
    EXPECT_LE(skin_cost(measure.spots(), shapes), before);
    EXPECT_LE(measure.measure(shapes, one).whole.rms, rms * (1.0 + 1e-12));
    EXPECT_GE(shapes[one].narrowest(), k_least_radius * (1.0 - 1e-12));
    if (one == 0) {
      EXPECT_EQ(shapes[0].a, shapes[0].b);
      EXPECT_EQ(shapes[0].taper, 0.0);
    }
    better += skin_cost(measure.spots(), shapes) < 0.99 * before;
  }
  EXPECT_GT(better, 12);
}

class ProxyEditFiles : public ::testing::Test {
protected:
  void SetUp() override { folder_ = test::scratch_folder(); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(ProxyEditFiles, WhatIsSavedReadsBack) {
  const rig::Character body = character();
  ProxyEditor editor(body, proxies_on(body), "");
  editor.set_picture({{{0, 0.8f, 3}, {0, 0.6f, 0}, 0.6f}, 640, 480}, 1.0f);
  Dice dice(13);
  for (int k = 0; k < 20; ++k) edit(editor, dice);
  editor.run(ProxyCommand::save); // there is no file yet
  EXPECT_EQ(editor.question(), ProxyQuestion::save_as);
  editor.answer_save_as(folder_ / "nowhere" / "new.json");
  EXPECT_EQ(editor.question(), ProxyQuestion::save_as); // for another name
  EXPECT_TRUE(editor.document().dirty());
  editor.answer_save_as(folder_ / "new.json");
  EXPECT_EQ(editor.question(), ProxyQuestion::none);
  EXPECT_FALSE(editor.document().dirty());
  EXPECT_EQ(editor.file(), folder_ / "new.json");
  const std::vector<Proxy> read = proxies::read_proxies(folder_ / "new.json", body.skeleton);
  const std::vector<Proxy>& held = editor.state().proxies;
  ASSERT_EQ(read.size(), held.size());
  for (std::size_t k = 0; k < read.size(); ++k) {
    EXPECT_EQ(read[k].name, held[k].name);
    const Capsule a = posed(read[k], editor.pose().rest), b = posed(held[k], editor.pose().rest);
    EXPECT_LT((a.a - b.a).norm() + (a.b - b.b).norm(), 1e-14);
    EXPECT_EQ(a.radius, b.radius);
    EXPECT_NEAR(a.taper, b.taper, 1e-15);
  }
}

TEST_F(ProxyEditFiles, APlaceThatCannotBeWrittenIsOneMessage) {
  const rig::Character body = character();
  ProxyEditor editor(body, proxies_on(body), folder_ / "none" / "p.json");
  editor.select(0);
  editor.run(ProxyCommand::remove);
  editor.run(ProxyCommand::save);
  EXPECT_THAT(editor.message(), ::testing::HasSubstr("p.json"));
  EXPECT_EQ(editor.message().find('\n'), std::string::npos);
  EXPECT_TRUE(editor.document().dirty());
  EXPECT_FALSE(editor.ask_to_leave());
  editor.answer_leave(true); // saving fails: it stays
  EXPECT_FALSE(editor.leaving());
  EXPECT_FALSE(editor.ask_to_leave());
  editor.answer_leave(false);
  EXPECT_TRUE(editor.leaving());
}

TEST_F(ProxyEditFiles, LeavingWithoutChangesAsksNothing) {
  const rig::Character body = character();
  ProxyEditor editor(body, proxies_on(body), folder_ / "p.json");
  EXPECT_TRUE(editor.ask_to_leave());
  EXPECT_EQ(editor.question(), ProxyQuestion::none);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "p.json"));
}

} // namespace
} // namespace tutu::app
