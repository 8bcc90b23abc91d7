// What a divergence says is what a brute look at the state finds.
#include "cloth/garment/elements.h"
#include "cloth/mass_spring.h"
#include "cloth/mesh_xpbd.h"
#include "cloth/recovery.h"
#include "cloth/state/tolerances.h"
#include "cloth/xpbd.h"
#include "src/study/bench/mesh_sheet.h"

#include <functional>
#include <gmock/gmock.h>
#include <limits>
#include <random>
#include <thread>

using namespace tutu;
using namespace tutu::cloth;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

Garment woven(const std::vector<Attachment>& held) {
  GarmentDescription description;
  description.file = "sheet";
  description.shape = GridShape{12, 12, {-0.25, 1, 0}, {0.5, 0, 0}, {0, 0, 0.5}};
  description.attachments = held;
  return build_garment(description);
}

Garment meshed(const std::vector<Attachment>& held) {
  GarmentDescription description;
  description.file = "mesh";
  description.shape = app::mesh_sheet(11, {-0.25, 1, 0}, {0.5, 0, 0}, {0, 0, 0.5}, 0.2);
  for (const Attachment& attachment : held) {
    Attachment there;
    there.joint = attachment.joint;
    there.within = Attachment::Ball{{-0.25, 1, 0}, attachment.last_column == 0 ? 0.01 : 0.5};
    there.above = 0.0;
    if (attachment.last_column != 0) there.within = Attachment::Ball{{0, 1, -10.0}, 10.001}; // the first row
    description.attachments.push_back(there);
  }
  return build_garment(description);
}

/// A solver, its garment held as asked, and what it looks at.
struct Case {
  std::string name;
  Garment garment;
  std::function<std::unique_ptr<Solver>(const Garment&)> make;
  bool looks_at_shear = false, looks_between_pins = true, knows_tethers = false;
  double rounding = 1e-9;
};

std::vector<Case> cases(const std::vector<Attachment>& held) {
  const auto xpbd = [](bool precise) {
    return [precise](const Garment& g) { return make_xpbd(g, {.double_precision = precise}); };
  };
  return {
      {"woven, float", woven(held), xpbd(false), true, false, true, 1e-4},
      {"woven, double", woven(held), xpbd(true), true, false, true},
      {"mesh, float", meshed(held), [](const Garment& g) { return std::make_unique<MeshXpbd<float>>(g); }},
      {"mesh, double", meshed(held), [](const Garment& g) { return std::make_unique<MeshXpbd<double>>(g); }},
      {"springs, woven", woven(held), [](const Garment& g) { return std::make_unique<MassSpring>(g); }},
      {"springs, mesh", meshed(held), [](const Garment& g) { return std::make_unique<MassSpring>(g); }},
  };
}

const Attachment k_first_row{"Hips", 0, 0, 0, -1}, k_corner{"Hips", 0, 0, 0, 0};

std::vector<Vec3> pins_of(const Garment& garment) {
  std::vector<Vec3> pins;
  for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  return pins;
}

/// The largest length over what it may be, of all edges and tethers that the solver looks at.
double worst_ratio(const Case& what, std::span<const Vec3> x) {
  const std::vector<std::uint8_t> pinned = pinned_flags(what.garment);
  double worst = 0.0;
  for (const Spring& s : what.garment.springs) {
    if (s.kind == SpringKind::bend || (s.kind == SpringKind::shear && !what.looks_at_shear)) continue;
    if (pinned[s.i] && pinned[s.j] && !what.looks_between_pins) continue;
    worst = std::max(worst, (x[s.i] - x[s.j]).norm() / s.rest_length);
  }
  if (what.knows_tethers && what.garment.pins.size() == 1)
    for (const Tether& t : build_tethers(what.garment))
      worst = std::max(worst, (x[t.particle] - x[t.anchor]).norm() / longest_of(t, what.garment.fabric));
  return worst;
}

/// That every word of it is true of the state.
void expect_true(const Case& what, const Divergence& d, const Particles& state) {
  const auto& x = state.positions;
  const double broken = 1.0 + k_diverged_stretch;
  ASSERT_GE(d.particle, 0);
  ASSERT_LT(d.particle, state.count());
  if (d.trouble != Trouble::no_number && (d.trouble != Trouble::out_of_world || !is_in_world(x[d.particle]))) {
    EXPECT_EQ(d.position, x[d.particle]);
  }
  switch (d.trouble) {
  case Trouble::long_edge:
  case Trouble::long_tether: {
    ASSERT_GE(d.other, 0);
    EXPECT_NEAR(d.length, (x[d.particle] - x[d.other]).norm(), 1e-9 * d.length);
    EXPECT_GE(d.length / d.rest_length, broken * (1.0 - what.rounding)) << "never what is allowed";
    EXPECT_NEAR(d.length / d.rest_length / worst_ratio(what, x), 1.0, what.rounding);
    EXPECT_NEAR(d.stretch(), d.length / d.rest_length - 1.0, 1e-12);
    EXPECT_TRUE(is_in_world(x)) << "else that is what is wrong";
    break;
  }
  case Trouble::no_number: break; // of what may have been taken back since
  case Trouble::out_of_world: EXPECT_FALSE(is_in_world(d.position)); break;
  case Trouble::too_fast: EXPECT_GT(d.speed, k_world_radius); break;
  default: ADD_FAILURE() << "not of a solver";
  }
  const std::string words = what_was_found(d);
  EXPECT_THAT(words, Not(HasSubstr("nan")));
  EXPECT_THAT(words, HasSubstr(std::to_string(d.particle)));
  ASSERT_EQ(d.held.has_value(), !what.garment.pins.empty());
  if (!d.held) return;
  const auto& rest = what.garment.rest_positions;
  for (const Pin& pin : what.garment.pins)
    EXPECT_GE((rest[pin.particle] - rest[d.particle]).norm(), (rest[d.held->particle] - rest[d.particle]).norm());
}

const std::unique_ptr<proxies::CollisionQuery>& hybrid() {
  static const auto query = proxies::make_query(proxies::Backend::hybrid);
  return query;
}

TEST(Divergence, APinThatJumps) {
  for (const Case& what : cases({k_first_row})) {
    SCOPED_TRACE(what.name);
    const auto cloth = what.make(what.garment);
    const std::vector<Vec3> start = pins_of(what.garment);
    std::vector<Vec3> end = start;
    const std::size_t k = 4;
    end[k].z() -= 30.0;
    FrameInput input;
    input.substeps = 40;
    input.pins_start = input.pins_end = start;
    for (int f = 0; f < 3; ++f) ASSERT_FALSE(cloth->step(input, *hybrid())) << "before it jumps";
    input.pins_end = end;
    const auto result = cloth->step(input, *hybrid());
    const Divergence* d = divergence_of(result);
    ASSERT_TRUE(d);
    expect_true(what, *d, cloth->particles());
    EXPECT_EQ(d->trouble, Trouble::long_edge);
    EXPECT_EQ(d->substep, 0);
    EXPECT_EQ(d->particle, what.garment.pins[k].particle);
    EXPECT_NEAR((d->position - (start[k] - Vec3(0, 0, 0.75))).norm(), 0.0, 1e-12) << "where it is in that substep";
    EXPECT_EQ(d->held->particle, d->particle);
    EXPECT_NEAR(d->held->way, 0.75, 1e-5);
    EXPECT_NEAR(d->speed, 0.75 * 2400.0, 0.01);
    EXPECT_THAT(what_was_found(*d), HasSubstr("is held, and was moved by 0.75 m in that substep"));
  }
}

TEST(Divergence, APinThatHoldsTheWholeSheetJumps) {
  for (const Case& what : cases({k_corner})) {
    SCOPED_TRACE(what.name);
    ASSERT_EQ(what.garment.pins.size(), 1u);
    const auto cloth = what.make(what.garment);
    const std::vector<Vec3> start = pins_of(what.garment);
    const std::vector<Vec3> end = {start[0] + Vec3(0, 200.0, 0)};
    FrameInput input;
    input.pins_start = start;
    input.pins_end = end;
    const auto result = cloth->step(input, *hybrid());
    if (what.name.starts_with("mesh") && !result) continue; // its tethers take the rest along
    const Divergence* d = divergence_of(result);
    ASSERT_TRUE(d);
    expect_true(what, *d, cloth->particles());
    EXPECT_TRUE(d->is_of_length());
    EXPECT_EQ(d->trouble == Trouble::long_tether ? d->other : d->particle, what.garment.pins[0].particle);
    EXPECT_NEAR(d->held->way, 40.0, 1e-3);
  }
}

TEST(Divergence, ANumberThatIsNone) {
  for (const bool of_velocity : {false, true})
    for (const Case& what : cases({k_first_row})) {
      SCOPED_TRACE(what.name + (of_velocity ? ", velocity" : ", position"));
      const auto cloth = what.make(what.garment);
      Particles state = cloth->particles();
      const int k = state.count() / 2 + 3;
      (of_velocity ? state.velocities : state.positions)[k].y() = std::nan("");
      cloth->restore(state);
      const std::vector<Vec3> pins = pins_of(what.garment);
      FrameInput input;
      input.pins_start = input.pins_end = pins;
      const auto result = cloth->step(input, *hybrid());
      const Divergence* d = divergence_of(result);
      ASSERT_TRUE(d);
      expect_true(what, *d, cloth->particles());
      EXPECT_EQ(d->trouble, Trouble::no_number);
      EXPECT_EQ(d->particle, k) << "not what it has spread to";
      EXPECT_EQ(d->substep, 0);
      EXPECT_THAT(what_was_found(*d), HasSubstr("was no number"));
    }
}

TEST(Divergence, AParticleOutOfTheWorld) {
  for (const Case& what : cases({k_first_row})) {
    SCOPED_TRACE(what.name);
    const auto cloth = what.make(what.garment);
    Particles state = cloth->particles();
    const int k = state.count() / 2 + 3;
    state.positions[k].x() = 1e9;
    cloth->restore(state);
    const std::vector<Vec3> pins = pins_of(what.garment);
    FrameInput input;
    input.pins_start = input.pins_end = pins;
    const auto result = cloth->step(input, *hybrid());
    const Divergence* d = divergence_of(result);
    ASSERT_TRUE(d);
    expect_true(what, *d, cloth->particles());
    EXPECT_EQ(d->trouble, Trouble::out_of_world);
    EXPECT_EQ(d->particle, k);
    EXPECT_THAT(what_was_found(*d), HasSubstr("out of the world at ("));
  }
}

TEST(Divergence, AnEdgeTorn) {
  for (const Case& what : cases({k_first_row})) {
    SCOPED_TRACE(what.name);
    const auto cloth = what.make(what.garment);
    Particles state = cloth->particles();
    const int k = state.count() / 2 + 3;
    state.positions[k].y() += 300.0;
    cloth->restore(state);
    const std::vector<Vec3> pins = pins_of(what.garment);
    FrameInput input;
    input.pins_start = input.pins_end = pins;
    const auto result = cloth->step(input, *hybrid());
    const Divergence* d = divergence_of(result);
    ASSERT_TRUE(d);
    expect_true(what, *d, cloth->particles());
    EXPECT_EQ(d->trouble, Trouble::long_edge);
    EXPECT_EQ(d->substep, 0);
    if (what.name.starts_with("woven")) { // found before anything gives way
      EXPECT_TRUE(d->particle == k || d->other == k);
      EXPECT_NEAR(d->length, 300.0, 3.0);
    }
    EXPECT_THAT(what_was_found(*d), HasSubstr("times its rest length"));
  }
}

TEST(Divergence, TooFastForAnyWorld) {
  for (const Case& what : cases({})) {
    SCOPED_TRACE(what.name);
    const auto cloth = what.make(what.garment);
    Particles state = cloth->particles();
    // Sheets of threads slow what is fast, but cannot in the first substep.
    const double speed = what.name.starts_with("woven") ? 1e12 : 1e7;
    for (Vec3& v : state.velocities) v.x() = speed;
    cloth->restore(state);
    FrameInput input;
    input.seconds = what.name.starts_with("woven") ? 1e-5 : 1.0 / 60.0; // within the world, all the same
    const auto result = cloth->step(input, *hybrid());
    const Divergence* d = divergence_of(result);
    ASSERT_TRUE(d);
    EXPECT_EQ(d->trouble, what.name.starts_with("woven") ? Trouble::out_of_world : Trouble::too_fast);
    EXPECT_NEAR(d->speed / speed, 1.0, 0.01);
  }
}

/// From states thrown together, of all sizes: whatever is said is true, and each solver meets several kinds.
TEST(Divergence, WhateverHappensWhatIsSaidIsTrue) {
  for (const std::vector<Attachment>& held : {std::vector{k_first_row}, {k_corner}, {}})
    for (const Case& what : cases(held)) {
      std::set<Trouble> met;
      int good = 0;
      for (unsigned seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(what.name + ", seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        std::normal_distribution<double> any;
        const auto anywhere = [&](double size) { return Vec3(size * Vec3(any(random), any(random), any(random))); };
        const auto cloth = what.make(what.garment);
        Particles state = cloth->particles();
        const double off = std::pow(10.0, 2.0 * any(random) - 2.0), speed = std::pow(10.0, 3.0 * any(random) + 1.0);
        for (Vec3& p : state.positions) p += anywhere(off);
        for (Vec3& v : state.velocities) v += anywhere(speed);
        if (seed % 7 == 0) state.positions[random() % state.positions.size()] = anywhere(1e7);
        if (seed % 11 == 0) state.positions[random() % state.positions.size()].z() = std::nan("");
        cloth->restore(state);
        std::vector<Vec3> pins = pins_of(what.garment), end = pins;
        if (seed % 3 == 0)
          for (Vec3& p : end) p += anywhere(1.0);
        FrameInput input;
        input.pins_start = pins;
        input.pins_end = end;
        input.substeps = 60;
        for (int f = 0; f < 5; ++f) {
          const auto result = cloth->step(input, *hybrid());
          good += !result;
          if (!result) continue;
          expect_true(what, *divergence_of(result), cloth->particles());
          met.insert(divergence_of(result)->trouble);
          break;
        }
      }
      EXPECT_GE(met.size(), 3u) << what.name;
      EXPECT_GT(good, 10) << what.name;
    }
}

TEST(Divergence, WhatAColliderSendsOutOfTheWorldIsNamed) {
  for (const Case& what : cases({})) {
    if (!what.name.starts_with("woven")) continue;
    SCOPED_TRACE(what.name);
    const auto cloth = what.make(what.garment);
    const std::vector<proxies::Capsule> start = {{{0, 0.5, 0.25}, {0, 0.5, 0.25}, 0.1}},
                                        end = {{{0, 3e7, 0.25}, {0, 3e7, 0.25}, 0.1}};
    FrameInput input;
    input.colliders = {start, end, std::nullopt};
    const auto result = cloth->step(input, *hybrid());
    const Divergence* d = divergence_of(result);
    ASSERT_TRUE(d);
    expect_true(what, *d, cloth->particles());
    EXPECT_EQ(d->trouble, Trouble::out_of_world);
  }
}

TEST(Divergence, ATargetOrAColliderThatIsNoNumberIsNamed) {
  const Garment garment = woven({k_first_row});
  GuardedSolver cloth(make_xpbd(garment, {}), garment);
  const std::vector<Vec3> pins = pins_of(garment);
  std::vector<Vec3> bad = pins;
  bad[3].y() = std::nan("");
  FrameInput input;
  input.pins_start = pins;
  input.pins_end = bad;
  auto result = cloth.step(input, *hybrid());
  ASSERT_TRUE(divergence_of(result));
  EXPECT_EQ(divergence_of(result)->trouble, Trouble::bad_target);
  EXPECT_EQ(divergence_of(result)->particle, garment.pins[3].particle);
  EXPECT_THAT(what_was_found(*divergence_of(result)), HasSubstr("the target of held particle 3 at (-0.113636, 1, 0)"));
  input.pins_end = pins;
  const std::vector<proxies::Capsule> nowhere = {{{0, std::nan(""), 0}, {1, 0, 0}, 0.1}};
  input.colliders = {nowhere, nowhere, std::nullopt};
  result = cloth.step(input, *hybrid());
  ASSERT_TRUE(divergence_of(result));
  EXPECT_EQ(divergence_of(result)->trouble, Trouble::bad_collider);
  EXPECT_EQ(what_was_found(*divergence_of(result)), "a collider was no number");
}

/// The same constraints, solved until they break, in both widths of the numbers: the report must not depend on what
/// was solved after the trouble was met. A pin's row keeps the rest of the sheet from it.
TEST(Divergence, TheStateIsThatOfTheMomentNotOfLastFramesPins) {
  for (const Case& what : cases({k_first_row})) {
    SCOPED_TRACE(what.name);
    const auto cloth = what.make(what.garment);
    std::vector<Vec3> start = pins_of(what.garment), end = start;
    FrameInput input;
    input.pins_start = start;
    input.substeps = 40;
    for (Vec3& p : end) p.x() += 0.01;
    input.pins_end = end;
    ASSERT_FALSE(cloth->step(input, *hybrid()));
    start = end;
    for (Vec3& p : end) p.x() += 640.0;
    const auto result = cloth->step(input, *hybrid());
    if (what.name.starts_with("mesh") && !result) continue; // its tethers take the rest along
    ASSERT_TRUE(divergence_of(result));
    for (std::size_t k = 0; k < start.size(); ++k)
      EXPECT_NEAR((cloth->particles().positions[what.garment.pins[k].particle] - start[k]).x(), 16.0, 1e-9);
  }
}

// ---- being stopped

/// Shaken and without pins, so that no position of a pin is rounded differently.
Particles shaken(const Garment& garment) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> any(0.0, 0.05);
  Particles state{garment.rest_positions, garment.rest_positions};
  for (Vec3& v : state.velocities) v = Vec3(any(random), any(random), any(random));
  return state;
}

TEST(Stop, ASolverStopsBetweenTwoSubstepsFromAnotherThread) {
  constexpr double k_h = 1.0 / 16384.0; // a power of two: any number of them divides back to it
  for (const Case& what : cases({})) {
    SCOPED_TRACE(what.name);
    const auto cloth = what.make(what.garment), twin = what.make(what.garment);
    cloth->restore(shaken(what.garment));
    twin->restore(shaken(what.garment));
    std::atomic<bool> stop = false;
    FrameInput input;
    input.substeps = 100000;
    input.seconds = input.substeps * k_h;
    input.stop = &stop;
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      stop = true;
    });
    const auto begin = std::chrono::steady_clock::now();
    const auto result = cloth->step(input, *hybrid());
    other.join();
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 1.0);
    ASSERT_TRUE(result.has_value());
    ASSERT_FALSE(divergence_of(result)) << "not a divergence";
    const int done = std::get<Stopped>(*result).substeps;
    ASSERT_GT(done, 0);
    ASSERT_LT(done, input.substeps);
    FrameInput whole;
    whole.substeps = done;
    whole.seconds = done * k_h;
    ASSERT_FALSE(twin->step(whole, *hybrid()));
    EXPECT_EQ(state_hash(cloth->particles()), state_hash(twin->particles())) << "that of a whole substep";
  }
}

TEST(Stop, AGuardedSolverHasNotTakenTheFrame) {
  const Garment garment = woven({k_first_row});
  for (const bool diverges : {false, true}) { // the second while it helps itself
    GuardedSolver cloth(make_xpbd(garment, {}), garment);
    const std::vector<Vec3> pins = pins_of(garment);
    std::vector<Vec3> end = pins;
    if (diverges)
      for (std::size_t k = 0; k < end.size(); ++k) end[k].y() += k % 2 == 0 ? 1e5 : -1e5;
    std::atomic<bool> stop = false;
    FrameInput input;
    input.pins_start = input.pins_end = pins;
    input.stop = &stop;
    ASSERT_FALSE(cloth.step(input, *hybrid()));
    const std::vector<Vec3> before = cloth.particles().positions;
    input.pins_end = end;
    input.substeps = diverges ? 500 : 1000000;
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      stop = true;
    });
    const auto result = cloth.step(input, *hybrid());
    other.join();
    ASSERT_TRUE(result.has_value());
    if (divergence_of(result)) continue; // it had given up before
    EXPECT_FALSE(cloth.recovery().has_value());
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR((cloth.particles().positions[i] - before[i]).norm(), 0.0, 1e-6) << i;
    stop = false;
    input.pins_end = pins;
    input.substeps = 5;
    EXPECT_FALSE(cloth.step(input, *hybrid())) << "it goes on";
  }
}

} // namespace
