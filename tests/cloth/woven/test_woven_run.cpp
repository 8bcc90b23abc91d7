// Whole frames of the default solver against the twin, which asks every particle, edge and face for every collider in
// every substep: what the solver skips must not have mattered.
#include "cloth/damping.h"
#include "cloth/detail/colouring.h"
#include "cloth/detail/woven_seams.h"
#include "cloth/solver.h"
#include "cloth/woven/sheet.h"
#include "cloth/woven/sweep.h"
#include "tests/support/simd_targets.h"
#include "tests/support/swinging_limbs.h"
#include "tests/support/woven_cases.h"
#include "tests/support/woven_twin.h"

#include <functional>
#include <gtest/gtest.h>
#include <set>

using namespace tutu;
using namespace tutu::cloth;

namespace {

constexpr int k_period = 40; // frames

/// After `join` the threads around seams, back to the lengths they had before it: particle by particle, what is sewn
/// moved twice.
void close_seams(test::WovenTwin& twin, const Garment& garment, const std::function<void()>& join) {
  const auto threads = std::span(garment.springs).first(garment.structural_count);
  std::vector<int> sewn(twin.x.size(), -1);
  std::set<int> around; // particles less than k_seam_reach threads away
  for (const Seam& seam : garment.seams) {
    sewn[seam.i] = seam.j;
    sewn[seam.j] = seam.i;
    around.insert({seam.i, seam.j});
  }
  for (int k = 1; k < WovenSeams<double>::k_seam_reach; ++k)
    for (std::set<int> within = around; const Spring& thread : threads)
      if (within.contains(thread.i) || within.contains(thread.j)) around.insert({thread.i, thread.j});
  const auto mass = [&](int i) { return 1.0 / twin.inverse_mass(i); }; // infinite where it is pinned
  const auto weight = [&](int i) { return 1.0 / (sewn[i] < 0 ? mass(i) : mass(i) + mass(sewn[i])); };
  struct Kept {
    Spring thread;
    double length;
  };
  std::vector<Kept> kept;
  std::vector<int> ends;
  for (const Spring& thread : threads) {
    if (!around.contains(thread.i) && !around.contains(thread.j)) continue;
    if (!(weight(thread.i) + weight(thread.j) > 0.0)) continue;
    kept.push_back({thread, (twin.x[thread.j] - twin.x[thread.i]).norm()});
    for (const int i : {thread.i, thread.j}) ends.push_back(sewn[i] < 0 ? i : std::min(i, sewn[i]));
  }
  join();
  const auto move = [&](int i, const Vec3& way) {
    twin.x[i] += way;
    if (sewn[i] >= 0) twin.x[sewn[i]] = twin.x[i];
  };
  const std::vector<int> order = colour(ends, 2, garment.particle_count()).order;
  for (int sweep = 0; sweep < WovenSeams<double>::k_sweeps; ++sweep)
    for (const int k : order) {
      const auto& [thread, length] = kept[k];
      const Vec3 d = twin.x[thread.j] - twin.x[thread.i];
      const double wi = weight(thread.i), wj = weight(thread.j);
      const Vec3 pull = (d.norm() - length) / (wi + wj) * d.normalized();
      move(thread.i, wi * pull);
      move(thread.j, -wj * pull);
    }
}

/// One frame of xpbd.h, contacts by brute force. Returns false when an edge broke.
bool frame_of(test::WovenTwin& twin, const Garment& garment, const FrameInput& input, int blocks, ContactFeatures asked,
              int passes, std::int64_t* contacts) {
  constexpr int k_tile = 8;
  const double h = input.seconds / input.substeps, offset = garment.fabric.contact_offset();
  WovenStep<double> step;
  step.h = h;
  for (int axis = 0; axis < 3; ++axis) step.gravity[axis] = input.gravity[axis];
  step.kept = 1.0 / (1.0 + h * (garment.fabric.drag + input.extra_drag));
  step.fastest = k_fastest_particle;
  step.passes = passes;
  const DampedStep damped = Damping(garment).at(h);
  step.taken = damped.taken;
  step.elastic = damped.elastic;
  const auto join = [&] {
    for (const Seam& seam : garment.seams) {
      const double wi = twin.inverse_mass(seam.i), wj = twin.inverse_mass(seam.j);
      twin.join(seam.i, seam.j, wi == 0.0 && wj == 0.0 ? 0.5 : wi / (wi + wj)); // the common centre of mass
    }
  };
  const auto for_tiles = [&](const auto& f) {
    for (int block = 0; block < blocks; ++block)
      for (int first = 0; first < garment.rows; first += k_tile)
        f(block, first, std::min(first + k_tile, garment.rows));
  };
  for (int substep = 0; substep < input.substeps; ++substep) {
    const double before = static_cast<double>(substep) / input.substeps, s = (substep + 1.0) / input.substeps;
    if (garment.fabric.air) twin.air(input.wind_at(before), h);
    twin.predict(step);
    for (std::size_t k = 0; k < garment.pins.size(); ++k) {
      const int i = garment.pins[k].particle;
      twin.x[i] = (1.0 - s) * input.pins_start[k] + s * input.pins_end[k];
      twin.v[i] = (twin.x[i] - twin.was[i]) / h;
    }
    join();
    if (!twin.constraints(step)) return false;
    close_seams(twin, garment, join);
    std::vector<test::TwinCollider> colliders;
    for (int k = 0; k < input.colliders.size(); ++k) {
      test::TwinCollider c;
      c.now = proxies::capsule_at(input.colliders.start[k], input.colliders.end[k], s);
      c.before = proxies::capsule_at(input.colliders.start[k], input.colliders.end[k], before);
      c.now.radius += offset;
      c.spin = (s - before) * input.colliders.spin[k];
      c.friction = input.friction[k];
      c.push_speed_step = k_push_out_speed * h;
      colliders.push_back(c);
    }
    test::TwinPlane ground{*input.colliders.ground, input.friction.back(), k_push_out_speed * h};
    ground.plane.offset += offset;
    for_tiles([&](int block, int first, int last) {
      for (const auto& c : colliders) twin.contact_capsule(block, first, last, c, 0.0, contacts);
      twin.contact_plane(block, first, last, ground, contacts);
    });
    if (asked == ContactFeatures::triangles)
      for_tiles([&](int block, int first, int last) {
        for (const auto& c : colliders) twin.contact_cells(block, first, last, c, true, contacts);
      });
    twin.finish(step);
  }
  return true;
}

/// What can be run: something always holds.
std::vector<test::WovenCase> held_cases(ContactFeatures features) {
  std::vector<test::WovenCase> cases = test::woven_cases();
  // Cells of 5 mm, pinned by chance inside the limbs: next to a pin no edge can be out and whole.
  if (features == ContactFeatures::triangles)
    std::erase_if(cases, [](const test::WovenCase& one) { return one.name == "grid, wide, without bend, pinned"; });
  // The limbs tear small cells that may shear, of 128 columns too. (With triangles the twin searches long: few
  // columns.)
  const int most = features == ContactFeatures::triangles ? 17 : 127;
  for (test::WovenCase& ring : test::uneven_rings())
    if (ring.garment.columns <= most && (ring.garment.columns < 100 || ring.garment.fabric.shear > 0.0))
      cases.push_back(std::move(ring));
  for (test::WovenCase& one : cases)
    if (one.garment.pins.empty()) test::pin_first_row(one.garment);
  return cases;
}

double worst(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (const double error = (a[i] - b[i]).norm(); !(error <= most)) most = error;
  return most;
}

/// Whether the last step that was kept pinched the cloth: the twin knows only colliders that push one after the other.
bool pinched(const ContactSet& kept) {
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (kept[k].step == kept.step() && kept[k].cause == ContactCause::pinch) return true;
  return false;
}

class WovenRuns : public ::testing::TestWithParam<ContactFeatures> {};
INSTANTIATE_TEST_SUITE_P(Features, WovenRuns,
                         ::testing::Values(ContactFeatures::particles, ContactFeatures::triangles));

void compare_in_double(ContactFeatures features, const std::optional<Air>& air = {}) {
  constexpr int k_frames = 6, k_substeps = 8;
  std::int64_t all_contacts = 0;
  for (test::WovenCase& one : held_cases(features)) {
    SCOPED_TRACE(one.name);
    one.garment.fabric.air = air;
    for (const int passes : {1, 2}) {
      const Garment& garment = one.garment;
      SolverOptions options;
      options.features = features;
      options.double_precision = true;
      options.passes = passes;
      options.swept = false;
      const auto solver = make_solver(garment, options);
      const auto query = proxies::make_query(proxies::Backend::hybrid);
      const WovenSheet<double> layout(garment, false);
      test::WovenTwin twin(garment, layout.view().blocks, layout.view().lanes);
      test::SwingingLimbs limbs(garment, k_period);
      solver->reset(garment.rest_positions);
      double error = 0.0;
      std::int64_t contacts = 0, met = 0;
      ContactSet kept(20000);
      for (int frame = 0; frame < k_frames; ++frame) {
        FrameInput input = limbs.advance(k_substeps);
        input.wind_start = Vec3(1.0 + frame, 0.5, -2.0);
        input.wind_end = input.wind_start + Vec3::UnitX();
        input.contacts = &kept;
        const auto end = solver->step(input, *query);
        ASSERT_FALSE(end.has_value()) << "frame " << frame << ", substep " << divergence_of(end)->substep << ": "
                                      << what_was_found(*divergence_of(end));
        if (pinched(kept)) break;
        met = solver->contact_counts().contacts;
        ASSERT_TRUE(frame_of(twin, garment, input, layout.view().blocks, features, passes, &contacts))
            << "frame " << frame;
        error = std::max(error, worst(solver->particles().positions, twin.x));
        ASSERT_LT(error, 1e-9) << "frame " << frame << ", " << passes << " passes";
      }
      all_contacts += contacts;
      // What was put on the surface is found there again or not, as rounding has it.
      const std::int64_t graze = features == ContactFeatures::particles ? 0 : twin.grazing;
      EXPECT_LE(std::abs(met - contacts), graze) << met << " and " << contacts;
    }
  }
  EXPECT_GT(all_contacts, 10000);
}

TEST(WovenSheets, ParticlesInDoubleMeetWhatTheTwinsMeet_slow) { compare_in_double(ContactFeatures::particles); }
TEST(WovenSheets, InTheAirInDoubleMeetWhatTheTwinsMeet_slow) { compare_in_double(ContactFeatures::particles, Air{}); }
TEST(WovenSheets, TrianglesInDoubleMeetWhatTheTwinsMeet_slow) { compare_in_double(ContactFeatures::triangles); }

TEST_P(WovenRuns, InFloatStayNearTheTwinForAFrame_slow) {
  constexpr int k_frames = 6, k_substeps = 8;
  double most = 0.0;
  for (const test::WovenCase& one : held_cases(GetParam())) {
    SCOPED_TRACE(one.name);
    const Garment& garment = one.garment;
    SolverOptions options;
    options.features = GetParam();
    options.swept = false;
    const auto solver = make_solver(garment, options);
    const auto query = proxies::make_query(proxies::Backend::hybrid);
    const WovenSheet<float> layout(garment, false);
    test::WovenTwin twin(garment, layout.view().blocks, layout.view().lanes);
    test::SwingingLimbs limbs(garment, k_period);
    solver->reset(garment.rest_positions);
    std::int64_t contacts = 0;
    ContactSet kept(20000);
    for (int frame = 0; frame < k_frames; ++frame) {
      FrameInput input = limbs.advance(k_substeps);
      input.contacts = &kept;
      twin.x = solver->particles().positions;
      twin.v = solver->particles().velocities;
      ASSERT_FALSE(solver->step(input, *query).has_value()) << "frame " << frame;
      if (pinched(kept)) break;
      ASSERT_TRUE(frame_of(twin, garment, input, layout.view().blocks, GetParam(), 1, &contacts)) << "frame " << frame;
      const double error = worst(solver->particles().positions, twin.x);
      most = std::max(most, error);
      EXPECT_LT(error, 1e-4) << "frame " << frame;
    }
  }
  RecordProperty("worst", std::to_string(most * 1e6) + " um");
}

/// Positions and velocities after some frames, as bits.
template <bool k_double> std::uint64_t hash_on(std::int64_t target, const Garment& garment, ContactFeatures features) {
  const test::OnTarget on(target);
  SolverOptions options;
  options.features = features;
  options.double_precision = k_double;
  const auto solver = make_solver(garment, options);
  const auto query = proxies::make_query(proxies::Backend::hybrid);
  test::SwingingLimbs limbs(garment, k_period);
  for (int frame = 0; frame < 10; ++frame) {
    FrameInput input = limbs.advance(6);
    input.wind_start = input.wind_end = Vec3(3.0, 0.3, -2.0); // for what has air
    EXPECT_FALSE(solver->step(input, *query).has_value());
  }
  return state_hash(solver->particles());
}

void compare_on_all_targets(const Garment& garment, ContactFeatures features) {
  std::optional<std::uint64_t> single[2], two[2];
  for (const std::int64_t target : test::simd_targets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const bool fused = test::fuses(target);
    const std::uint64_t s = hash_on<false>(target, garment, features);
    const std::uint64_t d = hash_on<true>(target, garment, features);
    EXPECT_EQ(single[fused].value_or(s), s);
    EXPECT_EQ(two[fused].value_or(d), d);
    single[fused] = s;
    two[fused] = d;
  }
}

TEST_P(WovenRuns, GiveTheSameBitsOnAllTargetsThatFuseAndOnAllThatDoNot) {
  for (const test::WovenCase& one : held_cases(GetParam())) {
    SCOPED_TRACE(one.name);
    compare_on_all_targets(one.garment, GetParam());
  }
}

TEST(WovenSheets, GiveTheSameBitsInTheAirOnAllTargetsThatFuseAndOnAllThatDoNot_slow) {
  for (test::WovenCase& one : held_cases(ContactFeatures::particles)) {
    SCOPED_TRACE(one.name);
    one.garment.fabric.air = Air{};
    compare_on_all_targets(one.garment, ContactFeatures::particles);
  }
}

/// Places of a lane without a column must not decide anything.
TEST(WovenSheets, FreeLanesOfARingNeverTearIt) {
  for (const int columns : {45, 75, 90, 40, 52, 203, 31, 37}) // 15, 15, 15, 10, 13, 16, 8, 12 lanes
    for (const bool precise : {false, true})
      for (const double speed : {0.0, 3.0, 30.0}) {
        SCOPED_TRACE(std::to_string(columns) + " columns at " + std::to_string(speed) + " m/s");
        const Garment garment = test::detail::tube(50, columns, {}, 0.8, std::nullopt);
        SolverOptions options;
        options.double_precision = precise;
        const auto solver = make_solver(garment, options);
        const auto query = proxies::make_query(proxies::Backend::hybrid);
        Particles flying{garment.rest_positions, {}};
        flying.velocities.assign(flying.positions.size(), speed * Vec3(1, 0.3, -0.5));
        solver->restore(flying);
        FrameInput input;
        for (int frame = 0; frame < 20; ++frame) ASSERT_FALSE(solver->step(input, *query).has_value()) << frame;
      }
}

/// A ball flies through the whole tube: every free particle is in one tile, and put back once.
TEST(WovenSheets, SweptTilesOfARingHoldEachParticleOnce) {
  SweptCollider ball;
  ball.start = {{-10, 1, 0}, {-10, 1, 0}, 2.0};
  ball.end = {{10, 1, 0}, {10, 1, 0}, 2.0};
  for (const test::WovenCase& one : test::uneven_rings()) {
    SCOPED_TRACE(one.name);
    WovenSheet<double> sheet(one.garment, false);
    std::int64_t count = 0;
    for (int block = 0; block < sheet.view().blocks; ++block)
      count += sweep_tile(sheet, block, 0, one.garment.rows, ball, false, nullptr);
    EXPECT_EQ(count, one.garment.particle_count() - static_cast<std::int64_t>(one.garment.pins.size()));
    for (int i = 0; i < one.garment.particle_count(); ++i) {
      if (sheet.inverse_mass(i) > 0.0) {
        EXPECT_GT(sheet.position(i).x(), 10.0) << i;
      }
    }
  }
}

/// As many substeps as a recovery takes, and several passes: the square of the substep must not take what does not
/// exist out of the range of float.
TEST(WovenSheets, TinySubstepsAreNumbers) {
  for (const int passes : {1, 3}) {
    Garment garment = test::detail::grid(12, 20, {});
    test::pin_first_row(garment);
    SolverOptions options;
    options.passes = passes;
    const auto solver = make_solver(garment, options);
    const auto query = proxies::make_query(proxies::Backend::hybrid);
    test::SwingingLimbs limbs(garment, k_period);
    const FrameInput input = limbs.advance(k_most_recovery_substeps);
    EXPECT_FALSE(solver->step(input, *query).has_value()) << passes;
    for (const Vec3& p : solver->particles().positions) ASSERT_TRUE(p.allFinite());
  }
}

} // namespace
