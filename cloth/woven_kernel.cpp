#include "cloth/woven_kernel.h"

#include "cloth/tolerances.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Compiled once for each of Highway's targets. No Eigen here: its layout depends on the vector flags, and these differ.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cloth/woven_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tutu::cloth::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// As many lanes as the target has, at most a block's: the same loops serve vectors of 1, 4, 8 and 16.
template <class T> using Tag = hn::CappedTag<T, k_lanes>;
template <class T> using Wide = hn::Vec<Tag<T>>;

template <class T> struct Wide3 { Wide<T> x, y, z; };

template <class T> HWY_INLINE Wide<T> set(T value) { return hn::Set(Tag<T>(), value); }
template <class T> HWY_INLINE Wide<T> load(const T* p) { return hn::Load(Tag<T>(), p); }
template <class T> HWY_INLINE Wide3<T> load(T* const* field, std::ptrdiff_t at) {
  return {load(field[0] + at), load(field[1] + at), load(field[2] + at)};
}
template <class T> HWY_INLINE void store(const Wide3<T>& v, T* const* field, std::ptrdiff_t at) {
  hn::Store(v.x, Tag<T>(), field[0] + at);
  hn::Store(v.y, Tag<T>(), field[1] + at);
  hn::Store(v.z, Tag<T>(), field[2] + at);
}
template <class T> HWY_INLINE Wide3<T> set3(const T* v) { return {set(v[0]), set(v[1]), set(v[2])}; }

template <class T> HWY_INLINE Wide3<T> plus(const Wide3<T>& a, const Wide3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T> HWY_INLINE Wide3<T> minus(const Wide3<T>& a, const Wide3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T> HWY_INLINE Wide3<T> times(Wide<T> s, const Wide3<T>& a) { return {s * a.x, s * a.y, s * a.z}; }
template <class T> HWY_INLINE Wide<T> dot(const Wide3<T>& a, const Wide3<T>& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, a.x * b.x));
}

/// a + s b, fused where the target can.
template <class T> HWY_INLINE Wide3<T> plus_times(const Wide3<T>& a, Wide<T> s, const Wide3<T>& b) {
  return {hn::MulAdd(s, b.x, a.x), hn::MulAdd(s, b.y, a.y), hn::MulAdd(s, b.z, a.z)};
}
template <class T> HWY_INLINE Wide3<T> minus_times(const Wide3<T>& a, Wide<T> s, const Wide3<T>& b) {
  return {hn::NegMulAdd(s, b.x, a.x), hn::NegMulAdd(s, b.y, a.y), hn::NegMulAdd(s, b.z, a.z)};
}

/// Where an element of a table or field is.
template <class T> HWY_INLINE std::ptrdiff_t place(const WovenSheetView<T>& sheet, int block, int row) {
  return block * sheet.block_stride + static_cast<std::ptrdiff_t>(row) * k_lanes;
}
template <class T> HWY_INLINE const T* row_of(const WovenTable<T>& table, int block, int row) {
  return table.data + block * table.block_stride + static_cast<std::ptrdiff_t>(row) * k_lanes;
}

/// Calls f(element, lane) for each vector of the rows first..last-1 of a block: element counts from the field's start.
template <class T, class F>
HWY_INLINE void for_rows(const WovenSheetView<T>& sheet, int block, int first, int last, const F& f) {
  const auto width = static_cast<int>(hn::Lanes(Tag<T>()));
  for (int row = first; row < last; ++row)
    for (int lane = 0; lane < k_lanes; lane += width) f(place(sheet, block, row) + lane, row, lane);
}

// ---- motion
// ----------------------------------------------------------------------------------------------------------

/// The largest of squared lengths, no number when any of them is none.
template <class T> class Farthest {
public:
  HWY_INLINE Farthest() : most_(hn::Zero(Tag<T>())), doubts_(hn::Zero(Tag<T>())) {}
  HWY_INLINE void add(const Wide3<T>& way) {
    const Wide<T> squared = dot(way, way);
    most_ = hn::Max(most_, squared);
    doubts_ = doubts_ + (squared - squared); // Max forgets what is no number, a sum never does
  }
  HWY_INLINE T squared() const {
    return hn::GetLane(hn::MaxOfLanes(Tag<T>(), most_)) + hn::GetLane(hn::SumOfLanes(Tag<T>(), doubts_));
  }

private:
  Wide<T> most_, doubts_;
};

/// A step without constraints, from x with velocity v.
template <class T> class Prediction {
public:
  HWY_INLINE Prediction(const WovenSheetView<T>& sheet, const WovenStep<T>& step)
      : sheet_(sheet), h_(set(step.h)), kept_(set(step.kept)), gain_(times(set(step.h), set3(step.gravity))) {}

  HWY_INLINE void move(std::ptrdiff_t at, const Wide3<T>& x, const Wide3<T>& v, Wide<T> inverse_mass) const {
    const auto is_free = inverse_mass > hn::Zero(Tag<T>());
    const Wide3<T> fallen = times(kept_, plus(v, gain_));
    const Wide3<T> now = {hn::IfThenElseZero(is_free, fallen.x), hn::IfThenElseZero(is_free, fallen.y),
                          hn::IfThenElseZero(is_free, fallen.z)};
    store(x, sheet_.was, at);
    store(now, sheet_.v, at);
    store(plus_times<T>(x, h_, now), sheet_.x, at);
  }

private:
  const WovenSheetView<T>& sheet_;
  Wide<T> h_, kept_;
  Wide3<T> gain_;
};

template <class T> void predict(const WovenSheetView<T>& sheet, const WovenStep<T>& step) {
  const Prediction<T> prediction(sheet, step);
  for (int block = 0; block < sheet.blocks; ++block)
    for_rows(sheet, block, 0, sheet.rows, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
      prediction.move(at, load(sheet.x, at), load(sheet.v, at), load(row_of(sheet.inverse_mass, block, row) + lane));
    });
}

template <bool k_predicts, class T>
T finish(const WovenSheetView<T>& sheet, const WovenStep<T>& step, int block, int first, int last) {
  const Wide<T> h = set(step.h), per_h = set(T(1) / step.h), most = set(step.fastest * step.fastest);
  const Prediction<T> prediction(sheet, step);
  Farthest<T> farthest;
  for_rows(sheet, block, first, last, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const Wide3<T> x = load(sheet.x, at), was = load(sheet.was, at);
    Wide3<T> v = load(sheet.v, at);
    farthest.add(minus(x, was));
    v = plus_times<T>(v, per_h, minus(x, plus_times<T>(was, h, v)));
    const Wide<T> speed = dot(v, v);
    const auto too_fast = speed > most;
    if (HWY_UNLIKELY(!hn::AllFalse(Tag<T>(), too_fast)))
      v = times(hn::IfThenElse(too_fast, hn::Sqrt(most / speed), set(T(1))), v);
    if constexpr (k_predicts) prediction.move(at, x, v, load(row_of(sheet.inverse_mass, block, row) + lane));
    else store(v, sheet.v, at);
  });
  return farthest.squared();
}

template <class T> T farthest(const WovenSheetView<T>& sheet, int block, int first, int last) {
  Farthest<T> farthest;
  for_rows(sheet, block, first, last,
           [&](std::ptrdiff_t at, int, int) HWY_ATTR { farthest.add(minus(load(sheet.x, at), load(sheet.was, at))); });
  return farthest.squared();
}

template <class T> void bounds(const WovenSheetView<T>& sheet, int block, int first, int last, T* low, T* high) {
  for (int axis = 0; axis < 3; ++axis) {
    Wide<T> least = load(sheet.x[axis] + place(sheet, block, first)), most = least;
    for_rows(sheet, block, first, last, [&](std::ptrdiff_t at, int, int) HWY_ATTR {
      const Wide<T> x = load(sheet.x[axis] + at);
      least = hn::Min(least, x);
      most = hn::Max(most, x);
    });
    low[axis] = hn::GetLane(hn::MinOfLanes(Tag<T>(), least));
    high[axis] = hn::GetLane(hn::MaxOfLanes(Tag<T>(), most));
  }
}

// ---- springs
// ---------------------------------------------------------------------------------------------------------

template <class T> struct Limits {
  Wide<T> per_h2;
  Wide<T> broken; ///< length over rest length at which the run has diverged
  Wide<T> bad;    ///< not 0 in lanes that have seen such an edge
};

/// Length of an edge, above 0.
template <class T> HWY_INLINE Wide<T> length_of(const Wide3<T>& d) {
  // Far below any rest length, and its square is still a normal number.
  constexpr T k_least_squared = T(1e-30);
  return hn::Sqrt(dot(d, d) + set(k_least_squared)); // a sum and no maximum, which forgets what is no number
}

/// Edges without a free end cannot break: they may lie in lanes that hold no cloth.
template <class T> HWY_INLINE void note_broken(Wide<T> length, Wide<T> rest, Wide<T> weights, Limits<T>& limits) {
  const Tag<T> d;
  const auto holds = hn::Or(length <= limits.broken * rest, weights <= hn::Zero(d)); // false when no number
  limits.bad = hn::IfThenElse(holds, limits.bad, hn::Set(d, T(1)));
}

/// One spring a lane between a and b: dlambda = (-C - at lambda) / (w_a + w_b + at), at = compliance / h^2
/// [Macklin et al. 2016, XPBD, eq. 18]; positive lambda pulls here.
template <bool k_repeats, class T>
HWY_INLINE void solve_spring(Wide3<T>& a, Wide3<T>& b, Wide<T> wa, Wide<T> wb, Wide<T> rest, Wide<T> compliance,
                             T* multiplier, bool first_pass, Limits<T>& limits) {
  const Wide3<T> d = minus(b, a);
  const Wide<T> length = length_of<T>(d), at = compliance * limits.per_h2;
  note_broken<T>(length, rest, wa + wb, limits);
  Wide<T> residual = length - rest;
  if constexpr (k_repeats)
    if (!first_pass) residual = residual - at * load(multiplier);
  const Wide<T> weights = wa + wb + at;
  const Wide<T> step = residual / (length * weights); // lambda's step over the length
  if constexpr (k_repeats) {
    const Wide<T> gained = step * length;
    hn::Store(first_pass ? gained : load(multiplier) + gained, Tag<T>(), multiplier);
  }
  const Wide3<T> pull = times(step, d);
  a = plus_times<T>(a, wa, pull);
  b = minus_times<T>(b, wb, pull);
}

/// All springs of one direction between block and block + 1: rows row_a of the one with row_b = row_a + down of the
/// other.
template <bool k_repeats, class T>
void solve_between(const WovenSheetView<T>& sheet, const WovenSprings<T>& springs, T* multipliers, int block,
                   int down_a, int down_b, int rows, bool first_pass, Limits<T>& limits) {
  for_rows(sheet, block, 0, rows, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const std::ptrdiff_t at_a = at + down_a * k_lanes, at_b = at + sheet.block_stride + down_b * k_lanes;
    Wide3<T> a = load(sheet.x, at_a), b = load(sheet.x, at_b);
    solve_spring<k_repeats, T>(a, b, load(row_of(sheet.inverse_mass, block, row + down_a) + lane),
                               load(row_of(sheet.inverse_mass, block + 1, row + down_b) + lane),
                               load(row_of(springs.length, block, row) + lane),
                               load(row_of(springs.compliance, block, row) + lane),
                               k_repeats ? multipliers + at : nullptr, first_pass, limits);
    store(a, sheet.x, at_a);
    store(b, sheet.x, at_b);
  });
}

// ---- bending
// ---------------------------------------------------------------------------------------------------------

/// Three particles along a thread bent against flatness: the energy B A |c|^2 / (2 l^4), c the second difference, is
/// that of the curvature of a thin plate along the thread [Bergou et al. 2006, quadratic bending, on a grid]. Linear,
/// so no angle and no root.
template <class T>
HWY_INLINE void solve_bend(Wide3<T>& a, Wide3<T>& b, Wide3<T>& c, Wide<T> wa, Wide<T> wb, Wide<T> wc, Wide<T> ratio,
                           Wide<T> compliance, Wide<T> per_h2) {
  const Wide<T> middle = set(T(1)) + ratio; // gradients: 1, -(1 + ratio), ratio
  const Wide<T> weights = wa + wb * middle * middle + wc * ratio * ratio + compliance * per_h2;
  const Wide3<T> curve = minus(times(ratio, minus(c, b)), minus(b, a));
  const Wide3<T> step = times(set(T(1)) / weights, curve);
  a = minus_times<T>(a, wa, step);
  b = plus_times<T>(b, wb * middle, step);
  c = minus_times<T>(c, wc * ratio, step);
}

template <class T> void bend_weft(const WovenSheetView<T>& sheet, int block, Wide<T> per_h2) {
  for_rows(sheet, block, 0, sheet.rows, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const std::ptrdiff_t at_b = at + sheet.block_stride, at_c = at_b + sheet.block_stride;
    Wide3<T> a = load(sheet.x, at), b = load(sheet.x, at_b), c = load(sheet.x, at_c);
    solve_bend<T>(a, b, c, load(row_of(sheet.inverse_mass, block, row) + lane),
                  load(row_of(sheet.inverse_mass, block + 1, row) + lane),
                  load(row_of(sheet.inverse_mass, block + 2, row) + lane),
                  load(row_of(sheet.weft_bend.ratio, block, row) + lane),
                  load(row_of(sheet.weft_bend.compliance, block, row) + lane), per_h2);
    store(a, sheet.x, at);
    store(b, sheet.x, at_b);
    store(c, sheet.x, at_c);
  });
}

template <class T> void bend_warp(const WovenSheetView<T>& sheet, int block, Wide<T> per_h2) {
  // Every third row: three passes in which no two triples share a particle.
  for (int colour = 0; colour < 3; ++colour)
    for (int row = colour; row + 2 < sheet.rows; row += 3)
      for_rows(sheet, block, row, row + 1, [&](std::ptrdiff_t at, int, int lane) HWY_ATTR {
        const std::ptrdiff_t at_b = at + k_lanes, at_c = at_b + k_lanes;
        Wide3<T> a = load(sheet.x, at), b = load(sheet.x, at_b), c = load(sheet.x, at_c);
        solve_bend<T>(a, b, c, load(row_of(sheet.inverse_mass, block, row) + lane),
                      load(row_of(sheet.inverse_mass, block, row + 1) + lane),
                      load(row_of(sheet.inverse_mass, block, row + 2) + lane),
                      load(row_of(sheet.warp_bend.ratio, block, row) + lane),
                      load(row_of(sheet.warp_bend.compliance, block, row) + lane), per_h2);
        store(a, sheet.x, at);
        store(b, sheet.x, at_b);
        store(c, sheet.x, at_c);
      });
}

// ---- warp threads
// ----------------------------------------------------------------------------------------------------

/// One Newton step of (J M^-1 J^T + at) dlambda = C - at lambda over the whole threads of a block, positive lambda
/// pulling: tridiagonal, since an edge shares a particle with the next one only. Elimination downwards, substitution
/// upwards. `multipliers` counts from the block's first row.
template <class T>
void solve_threads(const WovenSheetView<T>& sheet, int block, T* multipliers, bool first_step, Limits<T>& limits) {
  const auto width = static_cast<int>(hn::Lanes(Tag<T>()));
  const int edges = sheet.rows - 1;
  const std::ptrdiff_t field = sheet.block_stride;
  T* const nx = sheet.workspace;
  T* const n[3] = {nx, nx + field, nx + 2 * field};
  T* const right = nx + 3 * field; // of the eliminated system
  T* const upper = nx + 4 * field; // coupling to the edge below, times m
  for (int lane = 0; lane < k_lanes; lane += width) {
    const std::ptrdiff_t start = place(sheet, block, 0) + lane;
    Wide3<T> above = load(sheet.x, start), direction_above = {set(T(0)), set(T(0)), set(T(0))};
    Wide<T> w_above = load(row_of(sheet.inverse_mass, block, 0) + lane);
    Wide<T> m = set(T(0)), d = set(T(0));
    for (int k = 0; k < edges; ++k) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(k) * k_lanes + lane;
      const Wide3<T> below = load(sheet.x, start + (k + 1) * k_lanes);
      const Wide<T> w_below = load(row_of(sheet.inverse_mass, block, k + 1) + lane);
      const Wide3<T> edge = minus(below, above);
      const Wide<T> length = length_of<T>(edge), rest = load(row_of(sheet.warp.length, block, k) + lane);
      note_broken<T>(length, rest, w_above + w_below, limits);
      const Wide3<T> direction = times(set(T(1)) / length, edge);
      const Wide<T> compliance = load(row_of(sheet.warp.compliance, block, k) + lane) * limits.per_h2;
      Wide<T> residual = length - rest;
      if (!first_step) residual = residual - compliance * load(multipliers + at);
      const Wide<T> coupling = hn::Neg(w_above * dot(direction, direction_above)); // 0 for the first edge
      const Wide<T> to_above = coupling * m;
      if (k > 0) hn::Store(to_above, Tag<T>(), upper + at - k_lanes);
      m = set(T(1)) / (w_above + w_below + compliance - coupling * to_above);
      d = (residual - coupling * d) * m;
      store(direction, n, at);
      hn::Store(d, Tag<T>(), right + at);
      above = below;
      w_above = w_below;
      direction_above = direction;
    }
    Wide<T> step_below = set(T(0));
    Wide3<T> pull_below = {set(T(0)), set(T(0)), set(T(0))};
    for (int k = edges - 1; k >= 0; --k) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(k) * k_lanes + lane;
      Wide<T> step = load(right + at);
      if (k + 1 < edges) step = step - load(upper + at) * step_below;
      hn::Store(first_step ? step : load(multipliers + at) + step, Tag<T>(), multipliers + at);
      const Wide3<T> pull = times(step, load(n, at));
      const std::ptrdiff_t lower = start + (k + 1) * k_lanes;
      const Wide<T> w = load(row_of(sheet.inverse_mass, block, k + 1) + lane);
      store(plus(load(sheet.x, lower), times(w, minus(pull_below, pull))), sheet.x, lower);
      step_below = step;
      pull_below = pull;
    }
    const Wide<T> w = load(row_of(sheet.inverse_mass, block, 0) + lane);
    store(plus(load(sheet.x, start), times(w, pull_below)), sheet.x, start);
  }
}

/// Gauss-Seidel over the warp edges: even ones, then odd ones.
template <class T> void sweep_threads(const WovenSheetView<T>& sheet, int block, T* multipliers, Limits<T>& limits) {
  for (int parity = 0; parity < 2; ++parity)
    for (int row = parity; row + 1 < sheet.rows; row += 2)
      for_rows(sheet, block, row, row + 1, [&](std::ptrdiff_t at, int, int lane) HWY_ATTR {
        Wide3<T> a = load(sheet.x, at), b = load(sheet.x, at + k_lanes);
        solve_spring<true, T>(a, b, load(row_of(sheet.inverse_mass, block, row) + lane),
                              load(row_of(sheet.inverse_mass, block, row + 1) + lane),
                              load(row_of(sheet.warp.length, block, row) + lane),
                              load(row_of(sheet.warp.compliance, block, row) + lane),
                              multipliers + static_cast<std::ptrdiff_t>(row) * k_lanes + lane, false, limits);
        store(a, sheet.x, at);
        store(b, sheet.x, at + k_lanes);
      });
}

// ---- the ring's end
// ---------------------------------------------------------------------------------------------------

/// Halo `number` takes the lanes of block `number` turned by one; lanes without a column those of the last block, next
/// to which nothing is too long.
template <class T> void fetch_halo(const WovenSheetView<T>& sheet, T* const* field, int number) {
  const auto width = static_cast<int>(hn::Lanes(Tag<T>()));
  for (int axis = 0; axis < 3; ++axis) {
    const T* from = field[axis] + place(sheet, number, 0);
    const T* last = field[axis] + place(sheet, sheet.blocks - 1, 0);
    T* to = field[axis] + place(sheet, sheet.blocks + number, 0);
    const int count = sheet.rows * k_lanes;
    for (int k = 0; k < count; k += width) hn::Store(hn::LoadU(Tag<T>(), from + k + 1), Tag<T>(), to + k);
    for (int row = 0; row < count; row += k_lanes) {
      to[row + sheet.lanes - 1] = from[row];
      for (int lane = sheet.lanes; lane < k_lanes; ++lane) to[row + lane] = last[row + lane];
    }
  }
}

/// And back; lanes without a column stay.
template <class T> void return_halo(const WovenSheetView<T>& sheet, T* const* field, int number) {
  const auto width = static_cast<int>(hn::Lanes(Tag<T>()));
  for (int axis = 0; axis < 3; ++axis) {
    T* to = field[axis] + place(sheet, number, 0);
    const T* from = field[axis] + place(sheet, sheet.blocks + number, 0);
    const int count = sheet.rows * k_lanes;
    if (sheet.lanes == k_lanes) {
      // The last lane spills into the next row's first, or into the room behind the block; first lanes are set below.
      for (int k = 0; k < count; k += width) hn::StoreU(load(from + k), Tag<T>(), to + k + 1);
    } else {
      for (int row = 0; row < count; row += k_lanes) std::copy_n(from + row, sheet.lanes - 1, to + row + 1);
    }
    for (int row = 0; row < count; row += k_lanes) to[row] = from[row + sheet.lanes - 1];
  }
}

// ---- all constraints
// -------------------------------------------------------------------------------------------------

template <bool k_repeats, class T> bool all_constraints(const WovenSheetView<T>& sheet, const WovenStep<T>& step) {
  const Tag<T> tag;
  Limits<T> limits = {set(T(1) / (step.h * step.h)), set(T(1.0 + k_diverged_stretch)), hn::Zero(tag)};
  const int last = sheet.blocks - 1;
  for (int pass = 0; pass < step.passes; ++pass) {
    const bool first = pass == 0;
    if (sheet.has_bend && first) {
      for (int block = 0; block + 2 < sheet.blocks; ++block) bend_weft(sheet, block, limits.per_h2);
      fetch_halo(sheet, sheet.x, 0);
      bend_weft(sheet, last - 1, limits.per_h2);
      fetch_halo(sheet, sheet.x, 1); // not before: of three blocks, block 1 is the last but one
      bend_weft(sheet, last, limits.per_h2);
      return_halo(sheet, sheet.x, 0);
      return_halo(sheet, sheet.x, 1);
      for (int block = 0; block < sheet.blocks; ++block) bend_warp(sheet, block, limits.per_h2);
    }
    for (int block = 0; block < sheet.blocks; ++block) {
      if (block == last) fetch_halo(sheet, sheet.x, 0);
      if (sheet.has_shear) {
        solve_between<k_repeats, T>(sheet, sheet.falling, sheet.multipliers[2], block, 0, 1, sheet.rows - 1, first,
                                    limits);
        solve_between<k_repeats, T>(sheet, sheet.rising, sheet.multipliers[3], block, 1, 0, sheet.rows - 1, first,
                                    limits);
      }
      solve_between<k_repeats, T>(sheet, sheet.weft, sheet.multipliers[1], block, 0, 0, sheet.rows, first, limits);
      if (block == last) return_halo(sheet, sheet.x, 0);
    }
    for (int block = 0; block < sheet.blocks; ++block) {
      // With one pass a thread's multipliers are needed no longer than its own solve.
      T* multipliers = sheet.multipliers[0] + (k_repeats ? place(sheet, block, 0) : 0);
      for (int k = 0; k < step.newton_steps; ++k) solve_threads(sheet, block, multipliers, first && k == 0, limits);
      for (int k = 0; k < step.closing_sweeps; ++k) sweep_threads(sheet, block, multipliers, limits);
    }
  }
  return hn::AllFalse(tag, limits.bad > hn::Zero(tag));
}

template <class T> bool constraints(const WovenSheetView<T>& sheet, const WovenStep<T>& step) {
  return step.passes > 1 ? all_constraints<true>(sheet, step) : all_constraints<false>(sheet, step);
}

// ---- contacts
// --------------------------------------------------------------------------------------------------------

/// Points nearer to an axis than this, m, have no direction from it: the rounding of coordinates of a metre or two.
template <class T> constexpr T k_no_direction = sizeof(T) == sizeof(float) ? T(1e-6) : T(1e-12);

/// What a contact moves a point of the cloth by: out of the collider along the normal n, and back along what it slipped
/// over the moving surface, by at most friction * push (Coulomb's law on positions). `slip`: the point's way in this
/// substep less that of the surface under it. `is_hit` lanes only; 0 in the others.
template <class T, class Mask>
HWY_INLINE Wide3<T> response(Mask is_hit, Wide<T> depth, const Wide3<T>& n, const Wide3<T>& way, const Wide3<T>& slip,
                             T surface_moved, T push_speed_step, T friction) {
  // A contact that was made in this substep is no deeper than both sides moved: deeper ones come from a start
  // inside, and are worked out at a bounded speed.
  const Wide<T> most = hn::Sqrt(dot(way, way)) + set(surface_moved + push_speed_step);
  const Wide<T> push = hn::IfThenElseZero(is_hit, hn::Min(depth, most));
  const Wide3<T> out = times(push, n);
  const Wide<T> along = dot(slip, n);
  const Wide3<T> tangential = minus_times<T>(slip, along, n);
  const Wide<T> length = length_of<T>(tangential);
  const Wide<T> share = hn::Min(set(T(1)), set(friction) * push / length);
  return minus_times<T>(out, share, tangential);
}

/// A collider broadcast to all lanes.
template <class T> struct WideCollider {
  Wide3<T> a, axis, move_a, move_axis, spin, on_axis;
  Wide<T> per_axis_squared, radius;
  explicit HWY_INLINE WideCollider(const WovenCollider<T>& c)
      : a(set3(c.a)), axis(set3(c.axis)), move_a(set3(c.move_a)), move_axis(set3(c.move_axis)), spin(set3(c.spin)),
        on_axis(set3(c.on_axis)), per_axis_squared(set(c.per_axis_squared)), radius(set(c.radius)) {}
};

template <class T> HWY_INLINE Wide<T> clamped(Wide<T> t) { return hn::Min(hn::Max(t, set(T(0))), set(T(1))); }

/// The surface of a collider at a point in direction n from the place t of its axis: how far it has moved.
template <class T> HWY_INLINE Wide3<T> surface_move(const WideCollider<T>& c, Wide<T> t, const Wide3<T>& n) {
  const Wide3<T> arm = times(c.radius, n);
  const Wide3<T> turned = {c.spin.y * arm.z - c.spin.z * arm.y, c.spin.z * arm.x - c.spin.x * arm.z,
                           c.spin.x * arm.y - c.spin.y * arm.x};
  return plus(plus_times<T>(c.move_a, t, c.move_axis), turned);
}

/// Direction of q, of squared length `squared`; where it has none, the collider's own.
template <class T> HWY_INLINE Wide3<T> normal_of(const Wide3<T>& q, Wide<T> length, const Wide3<T>& on_axis) {
  const auto has_none = length < set(k_no_direction<T>);
  const Wide3<T> n = times(set(T(1)) / length, q);
  return {hn::IfThenElse(has_none, on_axis.x, n.x), hn::IfThenElse(has_none, on_axis.y, n.y),
          hn::IfThenElse(has_none, on_axis.z, n.z)};
}

template <class T>
T contact_capsule(const WovenSheetView<T>& sheet, int block, int first, int last, const WovenCollider<T>& collider,
                  T rise, std::int64_t* contacts) {
  const Tag<T> tag;
  WideCollider<T> c(collider);
  c.radius = set(collider.radius + rise);
  const Wide<T> far = set(std::numeric_limits<T>::max()), squared_radius = c.radius * c.radius;
  Wide<T> least = far;
  for_rows(sheet, block, first, last, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const Wide3<T> x = load(sheet.x, at), d = minus(x, c.a);
    const Wide<T> t = clamped<T>(dot(d, c.axis) * c.per_axis_squared);
    const Wide3<T> q = minus_times<T>(d, t, c.axis);
    const Wide<T> squared = dot(q, q);
    least = hn::Min(least, squared);
    const auto is_free = load(row_of(sheet.inverse_mass, block, row) + lane) > hn::Zero(tag);
    const auto is_hit = hn::And(is_free, squared < squared_radius);
    if (HWY_LIKELY(hn::AllFalse(tag, is_hit))) return;
    const Wide<T> length = length_of<T>(q);
    const Wide3<T> n = normal_of<T>(q, length, c.on_axis);
    const Wide3<T> way = minus(x, load(sheet.was, at));
    const Wide3<T> slip = minus(way, surface_move<T>(c, t, n));
    store(plus(x, response<T>(is_hit, c.radius - length, n, way, slip, collider.moved, collider.push_speed_step,
                              collider.friction)),
          sheet.x, at);
    *contacts += static_cast<std::int64_t>(hn::CountTrue(tag, is_hit));
  });
  return std::sqrt(hn::GetLane(hn::MinOfLanes(tag, least))) - (collider.radius + rise);
}

template <class T>
T contact_plane(const WovenSheetView<T>& sheet, int block, int first, int last, const WovenPlane<T>& plane,
                std::int64_t* contacts) {
  const Tag<T> tag;
  const Wide3<T> n = set3(plane.normal);
  const Wide<T> offset = set(plane.offset), far = set(std::numeric_limits<T>::max());
  Wide<T> least = far;
  for_rows(sheet, block, first, last, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const Wide3<T> x = load(sheet.x, at);
    const Wide<T> height = dot(x, n) - offset;
    least = hn::Min(least, height);
    const auto is_free = load(row_of(sheet.inverse_mass, block, row) + lane) > hn::Zero(tag);
    const auto is_hit = hn::And(is_free, height < hn::Zero(tag));
    if (HWY_LIKELY(hn::AllFalse(tag, is_hit))) return;
    const Wide3<T> way = minus(x, load(sheet.was, at));
    store(plus(x, response<T>(is_hit, hn::Neg(height), n, way, way, T(0), plane.push_speed_step, plane.friction)),
          sheet.x, at);
    *contacts += static_cast<std::int64_t>(hn::CountTrue(tag, is_hit));
  });
  return hn::GetLane(hn::MinOfLanes(tag, least));
}

// ---- edges and faces
// -------------------------------------------------------------------------------------------------

/// A corner of a cell: where it is kept, its place and its inverse mass.
template <class T> struct Corner {
  std::ptrdiff_t at;
  Wide3<T> x;
  Wide<T> w;
};

template <class T> HWY_INLINE Corner<T> corner(const WovenSheetView<T>& sheet, int block, int row, int lane) {
  const std::ptrdiff_t at = place(sheet, block, row) + lane;
  return {at, load(sheet.x, at), load(row_of(sheet.inverse_mass, block, row) + lane)};
}

/// One vector of cells against one collider.
template <class T> class CellContact {
public:
  using Mask = decltype(Wide<T>() < Wide<T>());

  HWY_INLINE CellContact(const WovenSheetView<T>& sheet, const WovenCollider<T>& collider, const WideCollider<T>& wide)
      : sheet_(sheet), collider_(collider), c_(wide), squared_radius_(wide.radius * wide.radius), touched_(0) {}

  /// Points that hit since the last call.
  HWY_INLINE std::int64_t touched() const { return touched_; }

  /// Segment against segment [Ericson 2005, Real-Time Collision Detection, 5.1.9], the axis being the second.
  HWY_INLINE void edge(Corner<T>& a, Corner<T>& b, Mask exists) {
    const Tag<T> tag;
    const Wide3<T> along = minus(b.x, a.x), r = minus(a.x, c_.a);
    const Wide<T> ee = hn::Max(dot(along, along), set(T(1e-20))), ea = dot(along, c_.axis);
    const Wide<T> er = dot(along, r), ar = dot(c_.axis, r);
    // The line's nearest point to the axis' line; the product with 1 / |axis|^2 keeps the numbers of one size.
    const Wide<T> slant = ea * c_.per_axis_squared, determinant = ee - ea * slant;
    constexpr T k_parallel = sizeof(T) == sizeof(float) ? T(1e-6) : T(1e-12); // squared sine between them
    const Wide<T> on_line = (slant * ar - er) / hn::Max(determinant, set(k_parallel) * ee);
    const Wide<T> t = clamped<T>((ea * clamped<T>(on_line) + ar) * c_.per_axis_squared);
    const Wide<T> s = clamped<T>((t * ea - er) / ee);
    const Wide3<T> q = minus(plus_times<T>(r, s, along), times(t, c_.axis));
    const auto is_hit = hn::And(hn::And(exists, (a.w + b.w) > hn::Zero(tag)), dot(q, q) < squared_radius_);
    if (HWY_LIKELY(hn::AllFalse(tag, is_hit))) return;
    const Wide<T> share_a = set(T(1)) - s;
    const Wide3<T> way =
        plus(times(share_a, minus(a.x, load(sheet_.was, a.at))), times(s, minus(b.x, load(sheet_.was, b.at))));
    const Wide<T> by_a = a.w * share_a, by_b = b.w * s;
    const Wide3<T> moved = moved_point(t, q, way, is_hit, by_a * share_a + by_b * s, hn::Max(by_a, by_b));
    a.x = plus_times<T>(a.x, by_a, moved);
    b.x = plus_times<T>(b.x, by_b, moved);
    touched_ += static_cast<std::int64_t>(hn::CountTrue(tag, is_hit));
  }

  /// The end t (0 or 1) of the axis against the inside of a triangle: its foot on the plane [Ericson 2005, 3.4]. Feet
  /// outside belong to an edge.
  HWY_INLINE void face(T t, Corner<T>& o, Corner<T>& p, Corner<T>& q, Mask exists) {
    const Tag<T> tag;
    const Wide3<T> e = minus(p.x, o.x), f = minus(q.x, o.x), r = minus(plus_times<T>(c_.a, set(t), c_.axis), o.x);
    const Wide<T> ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), re = dot(r, e), rf = dot(r, f);
    const Wide<T> per = set(T(1)) / hn::Max(ee * ff - ef * ef, set(T(1e-20)));
    const Wide<T> v = (ff * re - ef * rf) * per, w = (ee * rf - ef * re) * per, u = set(T(1)) - v - w;
    const Wide3<T> away = minus(plus(times(v, e), times(w, f)), r);
    const auto inside = hn::Min(u, hn::Min(v, w)) >= hn::Zero(tag);
    const auto near = hn::And(dot(away, away) < squared_radius_, (o.w + p.w + q.w) > hn::Zero(tag));
    const auto is_hit = hn::And(exists, hn::And(inside, near));
    if (HWY_LIKELY(hn::AllFalse(tag, is_hit))) return;
    const Wide3<T> way =
        plus(times(u, minus(o.x, load(sheet_.was, o.at))),
             plus(times(v, minus(p.x, load(sheet_.was, p.at))), times(w, minus(q.x, load(sheet_.was, q.at)))));
    const Wide<T> by_o = o.w * u, by_p = p.w * v, by_q = q.w * w;
    const Wide3<T> moved =
        moved_point(set(t), away, way, is_hit, by_o * u + by_p * v + by_q * w, hn::Max(by_o, hn::Max(by_p, by_q)));
    o.x = plus_times<T>(o.x, by_o, moved);
    p.x = plus_times<T>(p.x, by_p, moved);
    q.x = plus_times<T>(q.x, by_q, moved);
    touched_ += static_cast<std::int64_t>(hn::CountTrue(tag, is_hit));
  }

private:
  /// What the contact point, q away from the place t of the axis, has to move by, over the sum of inverse mass times
  /// squared share of its corners: each moves by its own inverse mass times share of that. `most` is the largest of
  /// these products: beside a pinned corner the lever is kept to k_longest_lever.
  HWY_INLINE Wide3<T> moved_point(Wide<T> t, const Wide3<T>& q, const Wide3<T>& way, Mask is_hit, Wide<T> weights,
                                  Wide<T> most) const {
    const Wide<T> length = length_of<T>(q);
    const Wide3<T> n = normal_of<T>(q, length, c_.on_axis);
    const Wide3<T> slip = minus(way, surface_move<T>(c_, t, n));
    const Wide3<T> moved = response<T>(is_hit, c_.radius - length, n, way, slip, collider_.moved,
                                       collider_.push_speed_step, collider_.friction);
    const Wide<T> least = hn::Max(most * set(T(1.0 / k_longest_lever)), set(T(1e-20)));
    return times(set(T(1)) / hn::Max(weights, least), moved);
  }

  const WovenSheetView<T>& sheet_;
  const WovenCollider<T>& collider_;
  const WideCollider<T>& c_;
  Wide<T> squared_radius_;
  std::int64_t touched_;
};

/// Weft edges and diagonals alone, for cells so low that nothing pokes between the two.
template <class T>
void contact_low_cells(const WovenSheetView<T>& sheet, int block, int first, int last, const WovenCollider<T>& collider,
                       const CellFeatures<T>& features, std::int64_t* contacts) {
  const Tag<T> tag;
  const WideCollider<T> c(collider);
  const auto real = set(T(0.5 * k_no_constraint)), half = set(T(0.5));
  const Wide<T> squared_reach = set((collider.radius + features.around) * (collider.radius + features.around));
  const auto width = static_cast<int>(hn::Lanes(tag));
  for (int row = first; row < last; ++row)
    for (int lane = 0; lane < k_lanes; lane += width) {
      const std::ptrdiff_t at_a = place(sheet, block, row) + lane, at_b = place(sheet, block + 1, row) + lane;
      const Wide3<T> m = minus(times(half, plus(load(sheet.x, at_a), load(sheet.x, at_b))), c.a);
      const Wide3<T> away = minus_times<T>(m, clamped<T>(dot(m, c.axis) * c.per_axis_squared), c.axis);
      const auto near =
          dot(away, away) < squared_reach; // each lane for itself: the answer must not depend on how many there are
      if (HWY_LIKELY(hn::AllFalse(tag, near))) continue;
      Corner<T> a = corner(sheet, block, row, lane), b = corner(sheet, block + 1, row, lane);
      const auto exists = hn::And(near, load(row_of(sheet.weft.compliance, block, row) + lane) < real);
      CellContact<T> contact(sheet, collider, c);
      contact.edge(a, b, exists);
      const bool has_below = row + 1 < sheet.rows;
      Corner<T> d = corner(sheet, block, has_below ? row + 1 : row, lane);
      if (has_below) contact.edge(b, d, exists);
      if (contact.touched() == 0) continue;
      *contacts += contact.touched();
      store(a.x, sheet.x, a.at);
      store(b.x, sheet.x, b.at);
      if (has_below) store(d.x, sheet.x, d.at);
    }
}

template <class T>
void contact_cells(const WovenSheetView<T>& sheet, int block, int first, int last, const WovenCollider<T>& collider,
                   const CellFeatures<T>& features, std::int64_t* contacts) {
  if (!features.high) {
    contact_low_cells(sheet, block, first, last, collider, features, contacts);
    return;
  }
  const Tag<T> tag;
  const WideCollider<T> c(collider);
  const int ends = collider.per_axis_squared > T(0) ? 2 : 1;
  const auto real = set(T(0.5 * k_no_constraint)), half = set(T(0.5));
  const auto width = static_cast<int>(hn::Lanes(tag));
  for (int row = first; row < last; ++row)
    for (int lane = 0; lane < k_lanes; lane += width) {
      const bool has_below = row + 1 < sheet.rows;
      Corner<T> a = corner(sheet, block, row, lane), b = corner(sheet, block + 1, row, lane);
      Corner<T> d = has_below ? corner(sheet, block, row + 1, lane) : a;
      Corner<T> e = has_below ? corner(sheet, block + 1, row + 1, lane) : b;
      // A cell lies as far around its middle as its farthest corner. Each lane for itself: the answer must not depend
      // on how many there are.
      const Wide3<T> middle = times(half, plus(b.x, d.x)), m = minus(middle, c.a);
      const Wide3<T> to_b = minus(b.x, middle), to_a = minus(a.x, middle), to_e = minus(e.x, middle);
      const Wide<T> reach =
          c.radius + hn::Sqrt(hn::Max(dot(to_b, to_b), hn::Max(dot(to_a, to_a), dot(to_e, to_e)))) + set(T(1e-6));
      const Wide<T> squared_reach = reach * reach;
      const Wide3<T> away = minus_times<T>(m, clamped<T>(dot(m, c.axis) * c.per_axis_squared), c.axis);
      const auto near = dot(away, away) < squared_reach;
      if (HWY_LIKELY(hn::AllFalse(tag, near))) continue;

      // Each feature is looked at where the ones before it left its corners.
      const auto exists = hn::And(near, load(row_of(sheet.weft.compliance, block, row) + lane) < real);
      CellContact<T> contact(sheet, collider, c);
      contact.edge(a, b, exists);
      if (has_below) {
        contact.edge(a, d, near);
        contact.edge(b, d, exists);
        for (int end = 0; end < ends; ++end) {
          const Wide3<T> to_end = end == 0 ? m : minus(m, c.axis);
          const auto near_end = hn::And(exists, dot(to_end, to_end) < squared_reach); // each lane for itself
          if (hn::AllFalse(tag, near_end)) continue;
          contact.face(static_cast<T>(end), a, d, b, near_end);
          contact.face(static_cast<T>(end), e, b, d, near_end);
        }
      }
      if (contact.touched() == 0) continue;
      *contacts += contact.touched();
      store(a.x, sheet.x, a.at);
      store(b.x, sheet.x, b.at);
      if (!has_below) continue;
      store(d.x, sheet.x, d.at);
      store(e.x, sheet.x, e.at);
    }
}

template <class T> void fetch(const WovenSheetView<T>& sheet) {
  fetch_halo(sheet, sheet.x, 0);
  fetch_halo(sheet, sheet.was, 0);
}
template <class T> void give_back(const WovenSheetView<T>& sheet) { return_halo(sheet, sheet.x, 0); }

template <class T> WovenKernel<T> kernel() {
  return {hwy::TargetName(HWY_TARGET), &predict<T>,      &constraints<T>,   &farthest<T>,
          &finish<false, T>,           &finish<true, T>, &bounds<T>,        &contact_capsule<T>,
          &contact_plane<T>,           &fetch<T>,        &contact_cells<T>, &give_back<T>};
}

WovenKernel<float> single_kernel() { return kernel<float>(); }
WovenKernel<double> double_kernel() { return kernel<double>(); }

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tutu::cloth {

HWY_EXPORT(single_kernel);
HWY_EXPORT(double_kernel);

template <> WovenKernel<float> woven_kernel<float>() { return HWY_DYNAMIC_DISPATCH(single_kernel)(); }
template <> WovenKernel<double> woven_kernel<double>() { return HWY_DYNAMIC_DISPATCH(double_kernel)(); }

} // namespace tutu::cloth
#endif
