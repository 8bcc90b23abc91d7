// What is kept of contacts is what the solver did: it accounts for every move that colliders caused, and keeping it
// changes nothing.
#include "cloth/contact/contact_set.h"
#include "cloth/solver.h"
#include "cloth/state/tolerances.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_motion.h"
#include "src/study/bench/mesh_sheet.h"
#include "tests/support/simd_targets.h"
#include "tests/support/solids.h"

#include <gtest/gtest.h>
#include <map>
#include <set>
#include <string>

using namespace tutu;
using namespace tutu::cloth;

namespace {

constexpr double k_seconds = 1.0 / 300.0, k_friction = 0.3;

/// 20 by 20 cm, level at y = 0, of 5 cm cells, held along one side: a grid or irregular triangles.
Garment sheet(bool woven) {
  GarmentDescription description;
  description.file = "sheet";
  description.fabric.stretch = 20.0; // so soft and heavy that mass_spring may take steps of k_seconds
  description.fabric.density = 1.0;
  if (woven) {
    description.shape = GridShape{5, 5, {-0.1, 0, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}};
    description.attachments = {{.joint = "stage", .last_row = 0}};
  } else {
    description.shape = app::mesh_sheet(4, {-0.1, 0, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}, 0.25);
    description.attachments = {{.joint = "stage", .within = Attachment::Ball{{-0.1, 0, -0.1}, 0.12}}};
  }
  return build_garment(description);
}

/// A ball, a capsule, a cone and a ground that swing up through a sheet and out of it; with `fast`, thin limbs that go
/// right through it besides. Or a body of triangles in their place.
class Scene {
public:
  Scene(const Garment& garment, bool body, bool fast) : body_(body), fast_(fast) {
    for (const Pin& pin : garment.pins) pins_.push_back(garment.rest_positions[pin.particle]);
    place(0);
  }

  FrameInput advance(int substeps) {
    start_ = end_;
    body_start_ = body_end_;
    place(++frame_);
    FrameInput input;
    input.substeps = substeps;
    input.seconds = k_seconds;
    input.pins_start = input.pins_end = pins_;
    const proxies::Plane ground{Vec3(0.1, 1, 0).normalized(), -0.06};
    if (body_) input.colliders = {{}, {}, ground, {}, body_start_, body_end_};
    else input.colliders = {start_, end_, ground};
    friction_.assign(start_.size() + 2, k_friction);
    input.friction = friction_;
    return input;
  }
  std::unique_ptr<proxies::CollisionQuery> query(proxies::Backend backend) const {
    return body_ ? proxies::make_mesh_query({ball_.positions, ball_.triangles}) : proxies::make_query(backend);
  }
  /// Where a proxy is at a moment of the frame.
  proxies::Capsule proxy_at(int proxy, double s) const { return proxies::capsule_at(start_[proxy], end_[proxy], s); }
  Vec3 body_vertex_at(std::uint32_t vertex, double s) const {
    return (1.0 - s) * body_start_[vertex].cast<double>() + s * body_end_[vertex].cast<double>();
  }
  const test::Surface& ball() const { return ball_; }
  bool is_body() const { return body_; }
  int proxies() const { return body_ ? 0 : static_cast<int>(start_.size()); }

private:
  void place(int frame) {
    const double rise = 0.03 * std::sin(0.25 * frame);
    end_ = {{{0.05, rise - 0.055, 0.05}, {0.05, rise - 0.055, 0.05}, 0.05},
            {{-0.09, rise - 0.02, 0.01}, {0.02, rise - 0.03, 0.02}, 0.015},
            {{0.06, rise - 0.04, -0.05}, {-0.04, rise - 0.01, -0.06}, 0.03, -0.018}};
    if (fast_) { // 50 m/s
      const double y = frame % 2 ? -0.09 : 0.08;
      end_.push_back({{-0.08, y, 0.07}, {0.08, y, 0.06}, 0.004});
      end_.push_back({{0.03, -y, 0.0}, {0.03, -y, 0.0}, 0.006});
    }
    body_end_.clear();
    for (const Vec3f& p : ball_.positions)
      body_end_.push_back(p + Vec3f(0.02f, static_cast<float>(rise) - 0.09f, 0.01f));
  }

  bool body_, fast_;
  int frame_ = 0;
  std::vector<proxies::Capsule> start_, end_;
  test::Surface ball_ = test::sphere_surface(0.09, 2);
  std::vector<Vec3f> body_start_, body_end_;
  std::vector<Vec3> pins_;
  std::vector<double> friction_;
};

/// A way to make contacts.
struct Way {
  std::string name;
  bool woven = true, body = false;
  proxies::Backend backend = proxies::Backend::hybrid;
  SolverOptions options;
};

std::vector<Way> ways() {
  std::vector<Way> ways;
  for (const bool woven : {true, false})
    for (const SolverKind solver : {SolverKind::xpbd, SolverKind::mass_spring})
      for (const bool in_double : {false, true})
        for (int backend = 0; backend < 4; ++backend) {
          if (solver == SolverKind::mass_spring && in_double) continue; // it is double already
          Way way{"", woven, backend == 3, proxies::Backend::hybrid, {}};
          if (!way.body) way.backend = proxies::backend_named(proxies::k_backend_names[backend]);
          way.options.solver = solver;
          way.options.double_precision = in_double;
          way.options.features = ContactFeatures::triangles;
          way.name = std::string(woven ? "grid, " : "mesh, ") + std::string(name_of(solver)) +
                     (in_double ? " in double, " : ", ") + std::string(proxies::k_backend_names[backend]);
          ways.push_back(way);
        }
  return ways;
}

/// A contact makes sense on its own.
void expect_sound(const ClothContact& contact, const Scene& scene, double offset, double rounding) {
  const double sum = contact.weights[0] + contact.weights[1] + contact.weights[2];
  EXPECT_NEAR(sum, 1.0, 10.0 * rounding);
  const proxies::Contact& met = contact.contact;
  EXPECT_NEAR(met.normal.norm(), 1.0, 10.0 * rounding);
  if (contact.cause != ContactCause::sweep) {
    EXPECT_LT(met.distance, offset + 0.01); // low cells float
    EXPECT_EQ(contact.time, 1.0);
  }
  EXPECT_GE(contact.push, 0.0);
  EXPECT_NEAR(contact.moved.dot(met.normal), contact.push, rounding);
  if (contact.cause != ContactCause::pinch) {
    EXPECT_LE(contact.rubbed().norm(), k_friction * contact.push + rounding);
  }
  if (scene.is_body() || contact.on == ColliderFeature::ground) return;
  EXPECT_EQ(contact.body_triangle, -1);
}

/// On the collider where it was met, by that collider's own shape.
void expect_on_collider(const ClothContact& contact, const Scene& scene, double s, double rounding) {
  const Vec3& closest = contact.contact.closest;
  if (contact.on == ColliderFeature::ground) {
    EXPECT_EQ(contact.collider, scene.proxies());
    return;
  }
  if (contact.on >= ColliderFeature::body_vertex) {
    ASSERT_GE(contact.body_triangle, 0);
    Vec3 on = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      on += contact.on_collider[k] * scene.body_vertex_at(scene.ball().triangles[contact.body_triangle][k], s);
    EXPECT_LT((on - closest).norm(), rounding);
    const int corners = static_cast<int>(std::ranges::count_if(contact.on_collider, [](double w) { return w > 0.0; }));
    EXPECT_EQ(corners, 1 + static_cast<int>(contact.on) - static_cast<int>(ColliderFeature::body_vertex));
    return;
  }
  const proxies::Capsule proxy = scene.proxy_at(contact.collider, s);
  EXPECT_EQ(contact.on == ColliderFeature::sphere, (proxy.b - proxy.a).norm() == 0.0);
  EXPECT_EQ(contact.on == ColliderFeature::cone, proxy.taper != 0.0);
  const double t = contact.on_collider[1];
  EXPECT_EQ(contact.on_collider[0], 1.0 - t);
  const Vec3 axis_point = proxy.a + t * (proxy.b - proxy.a);
  EXPECT_LT((axis_point + proxy.radius_at(t) * contact.contact.normal - closest).norm(), rounding);
}

TEST(ContactSet, AccountsForEveryMoveThatCollidersCaused) {
  std::map<std::string, int> seen; // "edge, cone"
  for (const Way& way : ways())
    for (const bool fast : {false, true}) {
      if (fast && way.body) continue; // the true body is not swept
      SCOPED_TRACE(way.name + (fast ? ", fast" : ""));
      const Garment garment = sheet(way.woven);
      const bool single = way.woven && way.options.solver == SolverKind::xpbd && !way.options.double_precision;
      const double rounding = single ? 1e-6 : 1e-12, offset = garment.fabric.contact_offset();
      Scene scene(garment, way.body, fast);
      const auto solver = make_solver(garment, way.options), alone = make_solver(garment, way.options);
      const auto query = scene.query(way.backend), nobody = proxies::make_query(proxies::Backend::hybrid);
      ContactSet kept(10000);
      std::size_t first = 0;
      for (int frame = 0; frame < 30; ++frame) {
        FrameInput input = scene.advance(1);
        FrameInput empty = input;
        empty.colliders = {};
        empty.friction = {};
        alone->restore(solver->particles());
        input.contacts = &kept;
        const std::int64_t counted = solver->contact_counts().contacts;
        const bool is_torn = solver->step(input, *query).has_value() || alone->step(empty, *nobody).has_value();
        ASSERT_FALSE(is_torn && !fast);
        if (is_torn) break;
        ASSERT_EQ(static_cast<std::int64_t>(kept.size() - first), solver->contact_counts().contacts - counted);
        EXPECT_EQ(kept.step(), frame + 1);
        std::vector<Vec3> moved = alone->particles().positions, sped = alone->particles().velocities;
        for (; first < kept.size(); ++first) {
          const ClothContact& contact = kept[first];
          EXPECT_EQ(contact.step, frame + 1);
          EXPECT_EQ(contact.substep, 0);
          if (contact.cause != ContactCause::sweep) { // where those before it left the cloth
            const proxies::Contact& met = contact.contact;
            const Vec3 off = contact.point(moved) - met.closest - met.distance * met.normal;
            const bool is_pair = way.body && contact.feature() != proxies::ClothFeature::vertex;
            EXPECT_LT(is_pair ? std::abs(off.dot(met.normal)) : off.norm(), rounding);
          }
          expect_sound(contact, scene, offset, rounding);
          expect_on_collider(contact, scene, contact.time, rounding);
          contact.move(moved, contact.moved);
          contact.move(sped, contact.velocity);
          const char* const features[] = {"particle", "edge", "face", ""};
          const char* const colliders[] = {"sphere",      "capsule",   "cone",     "ground",
                                           "body vertex", "body edge", "body face"};
          ++seen[std::string(features[static_cast<int>(contact.feature())]) + ", " +
                 colliders[static_cast<int>(contact.on)] + (contact.cause == ContactCause::sweep ? ", swept" : "")];
        }
        const Particles& now = solver->particles();
        for (int i = 0; i < garment.particle_count(); ++i) {
          EXPECT_LT((now.positions[i] - moved[i]).norm(), rounding) << "frame " << frame << ", particle " << i;
          const bool is_slowed = sped[i].norm() > k_fastest_particle;
          EXPECT_LT((now.velocities[i] - sped[i]).norm(), is_slowed ? 1e9 : rounding / k_seconds) << frame << ' ' << i;
        }
      }
      EXPECT_EQ(kept.lost(), 0u);
    }
  for (const char* cloth : {"particle", "edge", "face"})
    for (const char* collider : {"sphere", "capsule", "cone"}) EXPECT_GT(seen[std::string(cloth) + ", " + collider], 0);
  for (const char* kind : {"particle, ground", "particle, body face", "edge, body edge", "face, body vertex",
                           "particle, capsule, swept", "edge, capsule, swept", "edge, sphere, swept"})
    EXPECT_GT(seen[kind], 0) << kind;
}

bool same(const Particles& a, const Particles& b) { return a.positions == b.positions && a.velocities == b.velocities; }

TEST(ContactSet, KeepingThemChangesNothing) {
  for (const Way& way : ways()) {
    SCOPED_TRACE(way.name);
    const Garment garment = sheet(way.woven);
    Scene scene(garment, way.body, true);
    const auto watched = make_solver(garment, way.options), alone = make_solver(garment, way.options);
    const auto query = scene.query(way.backend), second = scene.query(way.backend);
    ContactSet kept(100);
    for (int frame = 0; frame < 20; ++frame) {
      FrameInput input = scene.advance(4);
      const auto end = alone->step(input, *second);
      input.contacts = &kept;
      ASSERT_EQ(watched->step(input, *query).has_value(), end.has_value());
      ASSERT_TRUE(same(watched->particles(), alone->particles())) << "frame " << frame;
      if (end) break;
    }
  }
}

bool operator==(const ClothContact& a, const ClothContact& b) {
  return a.step == b.step && a.substep == b.substep && a.particles == b.particles && a.weights == b.weights &&
         a.levers == b.levers && a.collider == b.collider && a.cause == b.cause && a.on == b.on && a.time == b.time &&
         a.push == b.push && a.moved == b.moved && a.on_collider == b.on_collider &&
         a.contact.distance == b.contact.distance && a.contact.normal == b.contact.normal &&
         a.contact.closest == b.contact.closest;
}

/// Whatever the width of vectors: the same contacts in the same order, to the bit, on all that fuse products and sums,
/// and on all that do not.
TEST(ContactSet, IsTheSameOnEveryTarget) {
  std::map<bool, ContactSet> first; // by whether the target fuses products and sums
  for (const std::int64_t target : test::simd_targets()) {
    const test::OnTarget on(target);
    const Garment garment = sheet(true);
    Scene scene(garment, false, false);
    SolverOptions options;
    options.features = ContactFeatures::triangles;
    const auto solver = make_solver(garment, options);
    const auto query = scene.query(proxies::Backend::hybrid);
    ContactSet kept(100000);
    for (int frame = 0; frame < 20; ++frame) {
      FrameInput input = scene.advance(6);
      input.seconds = 1.0 / 60.0;
      input.contacts = &kept;
      ASSERT_FALSE(solver->step(input, *query));
    }
    EXPECT_GT(kept.size(), 300u);
    const auto [found, is_new] = first.try_emplace(test::fuses(target), kept);
    if (is_new) continue;
    ASSERT_EQ(kept.size(), found->second.size()) << hwy::TargetName(target);
    for (std::size_t k = 0; k < kept.size(); ++k)
      ASSERT_TRUE(kept[k] == found->second[k]) << hwy::TargetName(target) << ", contact " << k;
  }
}

TEST(ContactSet, IsARingOfTheLatest) {
  ContactSet kept(3), none(0);
  for (ContactSet* set : {&kept, &none})
    for (int k = 0; k < 5; ++k) {
      set->begin_step();
      set->begin_substep();
      set->begin_substep();
      ClothContact contact;
      contact.particles = {k, 7, 8};
      contact.weights = {0.0, 0.25, 0.75};
      contact.levers = {0.0, 1.0, 2.0};
      set->add(contact);
      EXPECT_EQ(set->size() + set->lost(), static_cast<std::size_t>(k + 1));
    }
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(none.size(), 0u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(kept[k].step, k + 3);
    EXPECT_EQ(kept[k].substep, 1);
    EXPECT_EQ(kept[k].particles, (std::array{7, 8, -1})); // those that have a part
    EXPECT_EQ(kept[k].weights, (std::array{0.25, 0.75, 0.0}));
    EXPECT_EQ(kept[k].feature(), proxies::ClothFeature::edge);
  }
}

} // namespace
