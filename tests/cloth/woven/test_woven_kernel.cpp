// The kernels against a twin in plain double, stage by stage, on every target that this processor runs.
#include "cloth/damping.h"
#include "cloth/woven/sheet.h"
#include "proxies/distance/signed_distance.h"
#include "tests/support/simd_targets.h"
#include "tests/support/woven_cases.h"
#include "tests/support/woven_twin.h"

#include <cstring>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::cloth;

namespace {

constexpr double k_h = 1.0 / 600.0; // s
constexpr int k_tile = 8;           // rows

/// m. Double: rounding, far below it. Float: see each stage; coordinates of a metre are rounded by 6e-8.
template <class T> struct Bound {
  static constexpr bool k_single = sizeof(T) == sizeof(float);
  static constexpr double predict = k_single ? 2e-7 : 1e-9;
  static constexpr double constraints = k_single ? 5e-6 : 1e-9; ///< three passes over cloth in disorder: 3.3e-6
  static constexpr double contact = k_single ? 1e-6 : 1e-9;
  static constexpr double cells = k_single ? 3e-5 : 1e-9;
  static constexpr double finish = k_single ? 2e-7 : 1e-9; ///< of h v
};

template <class T> T rounded(double value) { return static_cast<T>(static_cast<float>(value)); }

template <class T> WovenStep<T> step_of(int passes = 1, const DampedStep& damped = {}) {
  WovenStep<T> step;
  step.h = static_cast<T>(k_h);
  step.gravity[1] = T(-9.81);
  step.kept = T(0.999);
  step.fastest = T(3);
  step.passes = passes;
  step.taken = static_cast<T>(damped.taken);
  step.elastic = static_cast<T>(damped.elastic);
  return step;
}

/// A garment in disorder, in the kernel's hands and in the twin's.
template <class T> struct Both {
  WovenSheet<T> sheet;
  WovenKernel<T> kernel = woven_kernel<T>();
  test::WovenTwin twin;
  const Garment& garment;
  const WovenSheetView<T>& view;
  double edge; ///< m, the shortest

  Both(const Garment& cloth, std::uint64_t seed, bool with_multipliers = false)
      : sheet(cloth, with_multipliers), twin(cloth, sheet.view().blocks, sheet.view().lanes), garment(cloth),
        view(sheet.view()),
        edge(std::min_element(cloth.springs.begin(), cloth.springs.end(), [](const Spring& a, const Spring& b) {
               return a.rest_length < b.rest_length;
             })->rest_length) {
    std::mt19937_64 random(seed);
    std::vector<Vec3> positions = cloth.rest_positions, velocities;
    for (Vec3& p : positions) {
      p += test::random_point(random, 0.2 * edge);
      velocities.push_back(test::random_point(random, 2.5));
    }
    sheet.set(positions, velocities);
    copy();
  }

  Vec3 at(T* const* field, int i) const {
    const std::ptrdiff_t element = sheet.element_of(i);
    return Vec3(static_cast<double>(field[0][element]), static_cast<double>(field[1][element]),
                static_cast<double>(field[2][element]));
  }
  /// The twin goes on from where the kernel is.
  void copy() {
    for (int i = 0; i < garment.particle_count(); ++i) {
      twin.x[i] = at(view.x, i) + sheet.origin();
      twin.was[i] = at(view.was, i) + sheet.origin();
      twin.v[i] = at(view.v, i);
    }
  }
  /// Particles that are farther from the twin's than that.
  int beyond(double bound) const {
    int count = 0;
    for (int i = 0; i < garment.particle_count(); ++i)
      count += !((at(view.x, i) + sheet.origin() - twin.x[i]).norm() < bound);
    return count;
  }
  double worst_x() const {
    double worst = 0.0;
    for (int i = 0; i < garment.particle_count(); ++i) {
      const double error = (at(view.x, i) + sheet.origin() - twin.x[i]).norm();
      worst = error <= worst ? worst : error; // what is no number counts
    }
    return worst;
  }
  double worst_was() const {
    double worst = 0.0;
    for (int i = 0; i < garment.particle_count(); ++i)
      worst = std::max(worst, (at(view.was, i) + sheet.origin() - twin.was[i]).norm());
    return worst;
  }
  double worst_v() const {
    double worst = 0.0;
    for (int i = 0; i < garment.particle_count(); ++i) {
      const double error = (at(view.v, i) - twin.v[i]).norm();
      worst = error <= worst ? worst : error;
    }
    return worst;
  }
  void predict() {
    kernel.predict(view, step_of<T>());
    copy();
    sheet.follow();
  }
  template <class F> void for_tiles(const F& f) const {
    for (int block = 0; block < view.blocks; ++block)
      for (int first = 0; first < view.rows; first += k_tile) f(block, first, std::min(first + k_tile, view.rows));
  }
};

/// The largest error of a stage, shown with the test.
struct Worst {
  const char* stage;
  double value = 0.0;
  void add(double error) { value = error <= value ? value : error; }
  ~Worst() { ::testing::Test::RecordProperty(stage, std::to_string(value * 1e9) + " nm"); }
};

template <class T> class WovenKernels : public ::testing::Test {
protected:
  /// f(garment, name) on every target for every garment.
  template <class F> void everywhere(const F& f) {
    for (const std::int64_t target : test::simd_targets()) {
      const test::OnTarget on(target);
      ASSERT_STREQ(woven_kernel<T>().target, hwy::TargetName(target));
      for (const test::WovenCase& one : cases_) {
        SCOPED_TRACE(one.name + " on " + hwy::TargetName(target));
        f(one.garment);
      }
    }
  }
  const std::vector<test::WovenCase> cases_ = [] {
    std::vector<test::WovenCase> all = test::woven_cases();
    for (test::WovenCase& ring : test::uneven_rings()) all.push_back(std::move(ring));
    return all;
  }();
};

using Scalars = ::testing::Types<double, float>;
TYPED_TEST_SUITE(WovenKernels, Scalars);

TYPED_TEST(WovenKernels, LayoutsAreThoseMeant) {
  using T = TypeParam;
  std::vector<int> lanes;
  for (const auto& one : this->cases_) lanes.push_back(WovenSheet<T>(one.garment, false).view().lanes);
  lanes.resize(16); // after them come the same ones, pinned
  EXPECT_EQ(lanes, (std::vector{16, 16, 16, 15, 15, 10, 8, 1, 13, 16, 10, 6, 16, 1, 1, 1}));
}

/// No number of columns costs a ring more blocks than it must.
TYPED_TEST(WovenKernels, RingsOfAnySizeFillTheirLanes) {
  using T = TypeParam;
  for (const bool with_bend : {false, true})
    for (int columns = 6; columns <= 140; ++columns) {
      SCOPED_TRACE(std::to_string(columns) + (with_bend ? " columns" : " columns without bend"));
      Fabric fabric;
      if (!with_bend) fabric.bend = 0.0;
      const Garment garment = test::detail::tube(3, columns, fabric, 0.8, std::nullopt);
      const WovenSheet<T> sheet(garment, false);
      const WovenSheetView<T>& view = sheet.view();
      const int fewest = with_bend ? 3 : 2, most_lanes = std::min(k_lanes, columns / fewest);
      EXPECT_EQ(view.blocks, (columns + most_lanes - 1) / most_lanes);
      int next = 0; // runs follow each other
      for (int lane = 0; lane < k_lanes; ++lane) {
        const int before = next;
        for (int block = 0; block < view.blocks; ++block) {
          const int column = sheet.column_of(block, lane);
          if (column < 0) continue;
          EXPECT_EQ(column, next++);
          EXPECT_EQ(sheet.element_of(2 * columns + column), block * view.block_stride + 2 * k_lanes + lane);
        }
        const int run = view.blocks - (lane >= view.long_lanes ? 1 : 0);
        EXPECT_EQ(next - before, lane < view.lanes ? run : 0);
        if (lane < view.lanes) {
          EXPECT_GE(run, fewest);
        }
      }
      EXPECT_EQ(next, columns);
    }
}

TYPED_TEST(WovenKernels, PredictAndFinish) {
  using T = TypeParam;
  Worst predicted{"predict"}, finished{"finish"};
  this->everywhere([&](const Garment& garment) {
    for (const bool and_predict : {false, true}) {
      Both<T> both(garment, 5);
      both.kernel.predict(both.view, step_of<T>());
      both.twin.predict(step_of<double>());
      predicted.add(both.worst_x());
      predicted.add(both.worst_was());
      EXPECT_LT(both.worst_x(), Bound<T>::predict);
      both.copy();
      for (int i = 0; i < garment.particle_count(); ++i) // something holds them back: some fly, some do not
        both.sheet.move_to(i, both.twin.was[i] + 0.9 * (both.twin.x[i] - both.twin.was[i]));
      both.copy();
      T most = 0;
      double expected = 0.0;
      both.for_tiles([&](int block, int first, int last) {
        const T farthest = both.kernel.farthest(both.view, block, first, last);
        EXPECT_NEAR(static_cast<double>(farthest), both.twin.farthest(block, first, last), 1e-7);
        expected = std::max(expected, both.twin.farthest(block, first, last));
        const auto finish = and_predict ? both.kernel.finish_and_predict : both.kernel.finish;
        most = std::max(most, finish(both.view, step_of<T>(), block, first, last));
      });
      EXPECT_NEAR(static_cast<double>(most), expected, Bound<T>::predict);
      both.twin.finish(step_of<double>());
      if (and_predict) both.twin.predict(step_of<double>());
      finished.add(both.worst_x());
      finished.add(both.worst_v() * k_h);
      EXPECT_LT(both.worst_x(), Bound<T>::predict);
      EXPECT_LT(both.worst_v() * k_h, Bound<T>::finish);
    }
  });
}

TYPED_TEST(WovenKernels, TheAir) {
  using T = TypeParam;
  Worst worst{"air"};
  this->everywhere([&](const Garment& bare) {
    Garment garment = bare;
    garment.fabric.air = Air{1.25, 1.5, 0.5};
    Both<T> both(garment, 17);
    const Vec3 wind(3, -1, 2);
    constexpr double k_long = 1.0 / 60.0; // s: light cloth is taken along
    const auto plain = air_in_step(*garment.fabric.air, wind, k_long);
    const WovenAir<T> air{static_cast<T>(plain.pressure),
                          static_cast<T>(plain.lift),
                          static_cast<T>(plain.friction),
                          {T(wind[0]), T(wind[1]), T(wind[2])}};
    both.kernel.air(both.view, air);
    both.twin.air(wind, k_long);
    worst.add(both.worst_v() * k_h);
    EXPECT_LT(both.worst_v() * k_h, Bound<T>::finish);
    both.copy(); // and nothing else has changed
    both.kernel.predict(both.view, step_of<T>());
    both.twin.predict(step_of<double>());
    EXPECT_LT(both.worst_x(), Bound<T>::predict);
    EXPECT_TRUE(both.kernel.constraints(both.view, step_of<T>()));
  });
}

TYPED_TEST(WovenKernels, Bounds) {
  using T = TypeParam;
  this->everywhere([&](const Garment& garment) {
    Both<T> both(garment, 6);
    both.for_tiles([&](int block, int first, int last) {
      T low[3], high[3];
      both.kernel.bounds(both.view, block, first, last, low, high);
      proxies::Box box;
      for (int row = first; row < last; ++row)
        for (const int column : both.twin.columns_of(block))
          box.extend(both.at(both.view.x, row * garment.columns + column));
      if (box.isEmpty()) return; // a block without a column
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(static_cast<double>(low[axis]), box.min()[axis]);
        EXPECT_EQ(static_cast<double>(high[axis]), box.max()[axis]);
      }
    });
  });
}

TYPED_TEST(WovenKernels, Constraints) {
  using T = TypeParam;
  Worst worst{"constraints"};
  this->everywhere([&](const Garment& garment) {
    for (const auto& [passes, damped] : {std::pair{1, DampedStep{0.7, 0.02}}, {2, {1.25, 0.05}}, {3, {1.0, 0.0}}}) {
      Both<T> both(garment, 7, passes > 1);
      both.predict();
      EXPECT_TRUE(both.kernel.constraints(both.view, step_of<T>(passes, damped))) << passes << " passes";
      EXPECT_TRUE(both.twin.constraints(step_of<double>(passes, damped)));
      worst.add(both.worst_x());
      // Which way an edge pulls may be for rounding to say (k_most_turn, k_most_pull): that moves what is around it.
      EXPECT_LE(both.beyond(Bound<T>::constraints), Bound<T>::k_single ? 6 : 0) << passes << " passes";
      EXPECT_LT(both.worst_x(), Bound<T>::k_single ? 1e-4 : Bound<T>::constraints) << passes << " passes";
    }
  });
}

TYPED_TEST(WovenKernels, OverlongEdgesAreFoundWhereverTheyAre) {
  using T = TypeParam;
  this->everywhere([&](const Garment& garment) {
    for (int i = 0; i < garment.particle_count(); i += 1 + garment.particle_count() / 40) {
      Both<T> both(garment, 8);
      both.sheet.move_to(i, both.sheet.position(i) + Vec3(0, 0, 100.0));
      EXPECT_FALSE(both.kernel.constraints(both.view, step_of<T>())) << i;
      both.sheet.move_to(i, Vec3(0, 0, std::nan("")));
      EXPECT_FALSE(both.kernel.constraints(both.view, step_of<T>())) << i;
    }
  });
}

TYPED_TEST(WovenKernels, TheFirstBrokenEdgeIsLeftAsItWasMet) {
  using T = TypeParam;
  this->everywhere([&](const Garment& garment) {
    for (int i = 0; i < garment.particle_count(); i += 1 + garment.particle_count() / 15) {
      Both<T> both(garment, 16);
      both.sheet.move_to(i, both.sheet.position(i) + Vec3(0, 0, 100.0));
      std::vector<T> room(static_cast<std::size_t>(6 * both.view.block_stride));
      EXPECT_FALSE(both.kernel.constraints_to_break(both.view, step_of<T>(), room.data())) << i;
      double most = 0.0;
      for (const Spring& spring : garment.springs)
        if (spring.kind != SpringKind::bend)
          most = std::max(most,
                          (both.sheet.position(spring.i) - both.sheet.position(spring.j)).norm() / spring.rest_length);
      EXPECT_GT(most, 0.999 * (1.0 + k_diverged_stretch)) << i;
    }
  });
}

/// Near some particles: capsules and spheres that have moved and turned since the substep's start.
std::vector<test::TwinCollider> colliders_near(const std::vector<Vec3>& points, std::mt19937_64& random, int count) {
  std::uniform_int_distribution<std::size_t> pick(0, points.size() - 1);
  std::uniform_real_distribution<double> radius(0.015, 0.08), friction(0.0, 1.0);
  std::vector<test::TwinCollider> colliders;
  for (int k = 0; k < count; ++k) {
    test::TwinCollider collider;
    collider.now.a = points[pick(random)] + test::random_point(random, 0.03);
    collider.now.b = k % 3 == 0 ? collider.now.a : Vec3(collider.now.a + test::random_point(random, 0.25));
    collider.now.radius = radius(random);
    if (k % 4 == 1) {
      const double length = (collider.now.b - collider.now.a).norm(), most = 0.9 * length; // both ends count
      collider.now.taper = std::clamp(radius(random) - collider.now.radius, -most, most);
    }
    collider.before = collider.now;
    const Vec3 move = test::random_point(random, 0.004);
    collider.before.a += move;
    collider.before.b += move;
    if (!collider.is_sphere()) collider.before.b += test::random_point(random, 0.002);
    collider.spin = test::random_point(random, 0.05);
    collider.friction = friction(random);
    collider.push_speed_step = k_push_out_speed * k_h;
    colliders.push_back(collider);
  }
  return colliders;
}

template <class T> WovenCollider<T> as_kernel_wants(const test::TwinCollider& collider, const Vec3& origin) {
  WovenCollider<T> c;
  const proxies::Capsule &now = collider.now, &before = collider.before;
  const Vec3 axis = now.b - now.a;
  const double squared = axis.squaredNorm();
  const Vec3 spin = collider.is_sphere() ? collider.spin : Vec3(axis * axis.dot(collider.spin) / squared);
  const Vec3 on_axis = proxies::normal_on_axis(now);
  for (int k = 0; k < 3; ++k) {
    c.a[k] = static_cast<T>(now.a[k] - origin[k]);
    c.axis[k] = static_cast<T>(axis[k]);
    c.move_a[k] = static_cast<T>(now.a[k] - before.a[k]);
    c.move_axis[k] = static_cast<T>(axis[k] - (before.b[k] - before.a[k]));
    c.spin[k] = static_cast<T>(spin[k]);
    c.on_axis[k] = static_cast<T>(on_axis[k]);
  }
  c.per_axis_squared = collider.is_sphere() ? T(0) : static_cast<T>(1.0 / squared);
  c.radius = static_cast<T>(now.radius);
  c.taper = static_cast<T>(now.taper);
  if (now.taper != 0.0) c.lean = static_cast<T>(now.taper / std::sqrt(squared * (squared - now.taper * now.taper)));
  c.friction = static_cast<T>(collider.friction);
  c.moved = static_cast<T>(collider.moved());
  c.push_speed_step = static_cast<T>(collider.push_speed_step);
  return c;
}

/// m from a collider with `rise`, of the nearest particle of each row of a block.
template <class T>
std::vector<double> nearest_of_rows(const Both<T>& both, int block, int first, int last,
                                    const test::TwinCollider& collider, double rise) {
  std::vector<double> nearest;
  for (int row = first; row < last; ++row) {
    double least = std::numeric_limits<double>::infinity();
    for (int lane = 0; lane < both.view.lanes; ++lane)
      if (const int column = both.sheet.column_of(block, lane); column >= 0)
        least = std::min(
            least,
            proxies::signed_distance(both.twin.x[both.sheet.weave().particle(row, column)], collider.now).distance);
    nearest.push_back(least - rise);
  }
  return nearest;
}

TYPED_TEST(WovenKernels, ParticlesAgainstCapsulesAndSpheres) {
  using T = TypeParam;
  Worst worst{"contact_capsule"};
  int near = 0, far = 0;
  this->everywhere([&](const Garment& garment) {
    Both<T> both(garment, 9);
    both.predict();
    std::mt19937_64 random(10);
    WovenHits<T> hits;
    std::int64_t expected_hits = 0;
    bool mark = false;
    for (const test::TwinCollider& collider : colliders_near(both.twin.x, random, 20)) {
      const WovenCollider<T> c = as_kernel_wants<T>(collider, both.sheet.origin());
      const double rise = 0.002;
      both.for_tiles([&](int block, int first, int last) {
        constexpr double k_within = 0.05;
        const std::vector<double> nearest = nearest_of_rows(both, block, first, last, collider, rise);
        const double expected = both.twin.contact_capsule(block, first, last, collider, rise, &expected_hits);
        std::vector<std::uint8_t> marks(last - first, 2);
        WovenMarks<T> asked = {T(k_within), marks.data(), 0};
        const T gap = both.kernel.contact_capsule(both.view, {block, first, last}, c, rounded<T>(rise),
                                                  mark ? &asked : nullptr, &hits);
        const bool is_full = lanes_in(both.view, block) == k_lanes; // else what fills it up may be marked too
        for (int k = 0; k < last - first; ++k) {
          const bool is_near = nearest[k] < k_within;
          const int wanted = !mark ? 2 : is_near ? 1 : 0;
          if (std::abs(nearest[k] - k_within) > Bound<T>::contact && (is_near || is_full || !mark)) {
            EXPECT_EQ(marks[k], wanted);
          }
          near += marks[k] == 1;
          far += marks[k] == 0;
        }
        mark = !mark;
        if (expected < 1e3) { // there is a free particle
          EXPECT_NEAR(static_cast<double>(gap), expected, Bound<T>::contact);
        } else {
          EXPECT_GT(static_cast<double>(gap), 1e3);
        }
      });
      worst.add(both.worst_x());
      EXPECT_LT(both.worst_x(), Bound<T>::contact);
      both.copy();
      both.sheet.follow();
    }
    EXPECT_GT(hits.count, 0);
    EXPECT_NEAR(static_cast<double>(hits.count), static_cast<double>(expected_hits), Bound<T>::k_single ? 2.0 : 0.0);
  });
  EXPECT_GT(near, 1000);
  EXPECT_GT(far, 1000);
}

TYPED_TEST(WovenKernels, ParticlesAgainstAPlane) {
  using T = TypeParam;
  Worst worst{"contact_plane"};
  this->everywhere([&](const Garment& garment) {
    Both<T> both(garment, 12);
    both.predict();
    std::mt19937_64 random(13);
    WovenHits<T> hits;
    std::int64_t expected_hits = 0;
    for (const double friction : {0.0, 0.3, 2.0}) {
      test::TwinPlane plane;
      plane.plane.normal = (Vec3::UnitY() + test::random_point(random, 0.3)).normalized();
      plane.plane.offset = plane.plane.normal.dot(both.twin.x[garment.particle_count() / 2]) + 0.001;
      plane.friction = friction;
      plane.push_speed_step = k_push_out_speed * k_h;
      WovenPlane<T> p;
      for (int k = 0; k < 3; ++k) p.normal[k] = static_cast<T>(plane.plane.normal[k]);
      p.offset = static_cast<T>(plane.plane.offset - plane.plane.normal.dot(both.sheet.origin()));
      p.friction = static_cast<T>(friction);
      p.push_speed_step = static_cast<T>(plane.push_speed_step);
      both.for_tiles([&](int block, int first, int last) {
        const double expected = both.twin.contact_plane(block, first, last, plane, &expected_hits);
        const T gap = both.kernel.contact_plane(both.view, {block, first, last}, p, &hits);
        if (expected < 1e3) { // there is a free particle
          EXPECT_NEAR(static_cast<double>(gap), expected, Bound<T>::contact);
        } else {
          EXPECT_GT(static_cast<double>(gap), 1e3);
        }
      });
      worst.add(both.worst_x());
      EXPECT_LT(both.worst_x(), Bound<T>::contact);
      both.copy();
      both.sheet.follow();
    }
    EXPECT_NEAR(static_cast<double>(hits.count), static_cast<double>(expected_hits), Bound<T>::k_single ? 2.0 : 0.0);
  });
}

TYPED_TEST(WovenKernels, EdgesAndFaces) {
  using T = TypeParam;
  Worst worst{"contact_cells"};
  std::int64_t all_hits = 0;
  this->everywhere([&](const Garment& garment) {
    Both<T> both(garment, 14);
    both.predict();
    std::mt19937_64 random(15);
    WovenHits<T> hits;
    std::int64_t expected_hits = 0;
    bool high = false;
    for (const test::TwinCollider& collider : colliders_near(both.twin.x, random, 10)) {
      high = !high;
      const WovenCollider<T> c = as_kernel_wants<T>(collider, both.sheet.origin());
      const std::vector<std::uint8_t> asked(garment.rows, 1);
      both.for_tiles([&](int block, int first, int last) {
        both.twin.contact_cells(block, first, last, collider, high, &expected_hits);
        const bool is_copied = needs_halo(both.view, block);
        if (is_copied) both.kernel.fetch_halo(both.view);
        both.kernel.contact_cells(both.view, {block, first, last}, c, {true, high}, asked.data(), &hits);
        if (is_copied) both.kernel.return_halo(both.view);
      });
      worst.add(both.worst_x());
      EXPECT_LT(both.worst_x(), Bound<T>::cells);
      both.copy();
    }
    const std::int64_t undecided = Bound<T>::k_single ? both.twin.grazing : 0;
    EXPECT_LE(std::abs(hits.count - expected_hits), undecided);
    all_hits += hits.count;
  });
  EXPECT_GT(all_hits, 1000);
}

} // namespace
