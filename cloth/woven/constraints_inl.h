// What holds a woven sheet together: springs, bending, whole warp threads. For kernel.cpp alone.
#if defined(TUTU_CLOTH_WOVEN_CONSTRAINTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TUTU_CLOTH_WOVEN_CONSTRAINTS_INL_H
#undef TUTU_CLOTH_WOVEN_CONSTRAINTS_INL_H
#else
#define TUTU_CLOTH_WOVEN_CONSTRAINTS_INL_H
#endif

#include "cloth/state/tolerances.h"
#include "cloth/woven/vectors_inl.h"

#include <array>

HWY_BEFORE_NAMESPACE();
namespace tutu::cloth::HWY_NAMESPACE {

/// Rows of two blocks that all passes between them are done with before the next rows: they stay in the nearest cache.
inline constexpr int k_rows_at_once = 15;

// ---- springs

/// What all constraints of a substep share.
template <class T> struct Limits {
  Wide<T> per_h2;    ///< taken / h^2, 1/s^2
  Wide<T> kept;      ///< 1 - taken
  Wide<T> elastic;   ///< WovenStep::elastic
  Wide<T> turn;      ///< k_most_turn
  Wide<T> pull;      ///< k_most_pull
  Wide<T> broken;    ///< length over rest length at which the run has diverged
  Wide<T> bad;       ///< not 0 in lanes that have seen such an edge
  T* room = nullptr; ///< for the positions of two blocks: whole() is to keep them
};

/// Does a part of the solve in which no edge moves what another is measured by: some of the edges of `block`, and those
/// to the next. With room to keep positions in, false when the part met a broken edge, and the positions are those that
/// it was met in.
template <class T, class Part>
HWY_INLINE bool whole(const WovenSheetView<T>& sheet, int block, Limits<T>& limits, const Part& part) {
  if (HWY_LIKELY(!limits.room)) {
    part();
    return true;
  }
  const std::ptrdiff_t count = 2 * sheet.block_stride, from = place(sheet, block, 0);
  for (int axis = 0; axis < 3; ++axis) std::copy_n(sheet.x[axis] + from, count, limits.room + axis * count);
  part();
  if (hn::AllFalse(Tag<T>(), limits.bad > hn::Zero(Tag<T>()))) return true;
  for (int axis = 0; axis < 3; ++axis) std::copy_n(limits.room + axis * count, count, sheet.x[axis] + from);
  return false;
}

/// Edges without a free end cannot break: they may lie in lanes that hold no cloth.
template <class T> HWY_INLINE void note_broken(Wide<T> length, Wide<T> rest, Wide<T> weights, Limits<T>& limits) {
  const Tag<T> d;
  const auto holds = hn::Or(length <= limits.broken * rest, weights <= hn::Zero(d)); // false when no number
  limits.bad = hn::IfThenElse(holds, limits.bad, hn::Set(d, T(1)));
}

/// An edge between two particles a lane, longer or shorter by C than it wants to be.
template <class T> struct WovenEdge {
  Wide<T> squared, length; ///< m2, m; above 0
  Wide<T> change;          ///< what the length has gained since the substep's start, times the length, m2
  Wide<T> residual;        ///< C - kept C(was), times the length, m2

  /// `now`, `was`: from one end to the other, m.
  HWY_INLINE WovenEdge(const Wide3<T>& now, const Wide3<T>& was, Wide<T> rest, const Limits<T>& limits)
      : squared(above_zero<T>(dot(now, now))), length(hn::Sqrt(squared)), change(dot(now, minus(now, was))) {
    // C(was) is C less the change, d . (d - d_was) / length to the first order.
    const Wide<T> excess = length * (length - rest), most = limits.elastic * rest * length;
    residual = hn::NegMulAdd(limits.kept, hn::Min(hn::Max(excess - change, hn::Neg(most)), most), excess);
  }

  HWY_INLINE auto hardly_turned(const Limits<T>& limits) const { return hn::Abs(change) <= limits.turn * squared; }
};

/// One spring a lane between a and b: dlambda = (-(C - kept C(was)) - at lambda) / (w_a + w_b + at) (WovenStep::taken);
/// positive lambda pulls here, along the edge as it was (cloth/damping.h).
template <bool k_repeats, class T>
HWY_INLINE void solve_spring(Wide3<T>& a, Wide3<T>& b, const Wide3<T>& was, Wide<T> wa, Wide<T> wb, Wide<T> rest,
                             Wide<T> compliance, T* multiplier, bool first_pass, Limits<T>& limits) {
  const Wide3<T> now = minus(b, a);
  const WovenEdge<T> edge(now, was, rest, limits);
  const Wide<T> at = compliance * limits.per_h2;
  note_broken<T>(edge.length, rest, wa + wb, limits);
  Wide<T> residual = edge.residual;
  if constexpr (k_repeats)
    if (!first_pass) residual = residual - at * load(multiplier) * edge.length;
  const Wide<T> step = residual / (edge.squared * (wa + wb + at)); // lambda's step over the length
  Wide<T> all = step * edge.length;
  if constexpr (k_repeats) {
    if (!first_pass) all = all + load(multiplier);
    hn::Store(all, Tag<T>(), multiplier);
  }
  const auto as_it_was = hn::And(edge.hardly_turned(limits), hn::Abs(all) * (wa + wb) <= limits.pull * edge.length);
  const Wide3<T> pull = times(step, choose(as_it_was, was, now));
  a = plus_times<T>(a, wa, pull);
  b = minus_times<T>(b, wb, pull);
}

/// Springs of one direction between block and block + 1: row + down_a of the one with row + down_b of the other, for
/// rows first..last-1.
template <bool k_repeats, class T>
void solve_between(const WovenSheetView<T>& sheet, const WovenSprings<T>& springs, T* multipliers, int block,
                   int down_a, int down_b, int first, int last, bool first_pass, Limits<T>& limits) {
  for_columns(sheet, block, first, last, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const std::ptrdiff_t at_a = at + down_a * k_lanes, at_b = at + sheet.block_stride + down_b * k_lanes;
    Wide3<T> a = load(sheet.x, at_a), b = load(sheet.x, at_b);
    solve_spring<k_repeats, T>(a, b, minus(load(sheet.was, at_b), load(sheet.was, at_a)),
                               load(row_of(sheet.inverse_mass, block, row + down_a) + lane),
                               load(row_of(sheet.inverse_mass, block + 1, row + down_b) + lane),
                               load(row_of(springs.length, block, row) + lane),
                               load(row_of(springs.compliance, block, row) + lane),
                               k_repeats ? multipliers + at : nullptr, first_pass, limits);
    store(a, sheet.x, at_a);
    store(b, sheet.x, at_b);
  });
}

// ---- bending

/// Three particles along a thread bent against flatness: the energy B A |c|^2 / (2 l^4), c the second difference, is
/// that of the curvature of a thin plate along the thread [Bergou et al. 2006, quadratic bending, on a grid]. Linear,
/// so no angle and no root. Of c before only what is along c counts: turning as a whole bends nothing.
template <class T>
HWY_INLINE void solve_bend(const WovenSheetView<T>& sheet, const std::array<std::ptrdiff_t, 3>& at,
                           const std::array<Wide<T>, 3>& w, Wide<T> ratio, Wide<T> compliance,
                           const Limits<T>& limits) {
  Wide3<T> a = load(sheet.x, at[0]), b = load(sheet.x, at[1]), c = load(sheet.x, at[2]);
  const auto curve_of = [&](const Wide3<T>& p, const Wide3<T>& q, const Wide3<T>& r)
                            HWY_ATTR { return minus(times(ratio, minus(r, q)), minus(q, p)); };
  const Wide3<T> curve = curve_of(a, b, c);
  const Wide3<T> before = curve_of(load(sheet.was, at[0]), load(sheet.was, at[1]), load(sheet.was, at[2]));
  const Wide<T> middle = set(T(1)) + ratio; // gradients: 1, -(1 + ratio), ratio
  const Wide<T> weights = w[0] + w[1] * middle * middle + w[2] * ratio * ratio + compliance * limits.per_h2;
  const Wide<T> squared = above_zero<T>(dot(curve, curve));
  const Wide3<T> step = times(hn::NegMulAdd(limits.kept, dot(curve, before), squared) / (squared * weights), curve);
  store(minus_times<T>(a, w[0], step), sheet.x, at[0]);
  store(plus_times<T>(b, w[1] * middle, step), sheet.x, at[1]);
  store(minus_times<T>(c, w[2] * ratio, step), sheet.x, at[2]);
}

template <class T> void bend_weft(const WovenSheetView<T>& sheet, int block, const Limits<T>& limits) {
  for_columns(sheet, block, 0, sheet.rows, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const auto weight = [&](int on) HWY_ATTR { return load(row_of(sheet.inverse_mass, block + on, row) + lane); };
    solve_bend<T>(sheet, {at, at + sheet.block_stride, at + 2 * sheet.block_stride}, {weight(0), weight(1), weight(2)},
                  load(row_of(sheet.weft_bend.ratio, block, row) + lane),
                  load(row_of(sheet.weft_bend.compliance, block, row) + lane), limits);
  });
}

template <class T> void bend_warp(const WovenSheetView<T>& sheet, int block, const Limits<T>& limits) {
  const auto bend = [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const auto weight = [&](int down) HWY_ATTR { return load(row_of(sheet.inverse_mass, block, row + down) + lane); };
    solve_bend<T>(sheet, {at, at + k_lanes, at + 2 * k_lanes}, {weight(0), weight(1), weight(2)},
                  load(row_of(sheet.warp_bend.ratio, block, row) + lane),
                  load(row_of(sheet.warp_bend.compliance, block, row) + lane), limits);
  };
  // Every third row: three passes in which no two triples share a particle.
  for (int first = 0; first < sheet.rows - 2; first += k_rows_at_once)
    for (int colour = 0; colour < 3; ++colour)
      for_columns(sheet, block, first + colour, std::min(first + k_rows_at_once, sheet.rows - 2), bend, 3);
}

// ---- warp threads

/// One step of (J M^-1 J^T + at) dlambda = C - kept C(was) - at lambda over the whole threads of a block, positive
/// lambda pulling: tridiagonal, since an edge shares a particle with the next one only. Elimination downwards,
/// substitution upwards. It would be Newton's but for the directions of pulls, which solve_spring() has too; how they
/// differ from J is of second order. `multipliers` counts from the block's first row.
template <class T>
void solve_threads(const WovenSheetView<T>& sheet, int block, T* multipliers, bool first_step, Limits<T>& limits) {
  const auto width = static_cast<int>(hn::Lanes(Tag<T>()));
  const int edges = sheet.rows - 1;
  const std::ptrdiff_t field = sheet.block_stride;
  T* const nx = sheet.workspace;
  T* const n[3] = {nx, nx + field, nx + 2 * field};
  T* const right = nx + 3 * field; // of the eliminated system
  T* const upper = nx + 4 * field; // coupling to the edge below, times m
  T* const scale = nx + 5 * field; // 1 / length of edges that have hardly turned, 0 of others
  for (int lane = 0; lane < lanes_in(sheet, block); lane += width) {
    const std::ptrdiff_t start = place(sheet, block, 0) + lane;
    Wide3<T> above = load(sheet.x, start), was_above = load(sheet.was, start);
    Wide3<T> direction_above = {set(T(0)), set(T(0)), set(T(0))};
    Wide<T> w_above = load(row_of(sheet.inverse_mass, block, 0) + lane);
    Wide<T> m = set(T(0)), d = set(T(0));
    for (int k = 0; k < edges; ++k) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(k) * k_lanes + lane, lower = start + (k + 1) * k_lanes;
      const Wide3<T> below = load(sheet.x, lower), was_below = load(sheet.was, lower);
      const Wide<T> w_below = load(row_of(sheet.inverse_mass, block, k + 1) + lane);
      const Wide<T> rest = load(row_of(sheet.warp.length, block, k) + lane);
      const Wide3<T> now = minus(below, above);
      const WovenEdge<T> edge(now, minus(was_below, was_above), rest, limits);
      note_broken<T>(edge.length, rest, w_above + w_below, limits);
      const Wide<T> per_length = set(T(1)) / edge.length;
      const Wide3<T> direction = times(per_length, now);
      const Wide<T> compliance = load(row_of(sheet.warp.compliance, block, k) + lane) * limits.per_h2;
      Wide<T> residual = per_length * edge.residual;
      if (!first_step) residual = residual - compliance * load(multipliers + at);
      const Wide<T> coupling = hn::Neg(w_above * dot(direction, direction_above)); // 0 for the first edge
      const Wide<T> to_above = coupling * m;
      if (k > 0) hn::Store(to_above, Tag<T>(), upper + at - k_lanes);
      m = set(T(1)) / (w_above + w_below + compliance - coupling * to_above);
      d = (residual - coupling * d) * m;
      store(direction, n, at);
      hn::Store(hn::IfThenElseZero(edge.hardly_turned(limits), per_length), Tag<T>(), scale + at);
      hn::Store(d, Tag<T>(), right + at);
      above = below;
      was_above = was_below;
      w_above = w_below;
      direction_above = direction;
    }
    Wide<T> step_below = set(T(0));
    Wide<T> w_low = w_above;
    Wide3<T> was_low = was_above;
    Wide3<T> pull_below = {set(T(0)), set(T(0)), set(T(0))};
    for (int k = edges - 1; k >= 0; --k) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(k) * k_lanes + lane;
      Wide<T> step = load(right + at);
      if (k + 1 < edges) step = step - load(upper + at) * step_below;
      const Wide<T> all = first_step ? step : load(multipliers + at) + step;
      hn::Store(all, Tag<T>(), multipliers + at);
      const std::ptrdiff_t lower = start + (k + 1) * k_lanes;
      const Wide<T> w = load(row_of(sheet.inverse_mass, block, k) + lane), per_length = load(scale + at);
      const Wide3<T> was = load(sheet.was, lower - k_lanes);
      const auto as_it_was = hn::And(per_length > set(T(0)), hn::Abs(all) * per_length * (w + w_low) <= limits.pull);
      const Wide3<T> pull = times(step, choose(as_it_was, times(per_length, minus(was_low, was)), load(n, at)));
      store(plus(load(sheet.x, lower), times(w_low, minus(pull_below, pull))), sheet.x, lower);
      step_below = step;
      pull_below = pull;
      w_low = w;
      was_low = was;
    }
    store(plus(load(sheet.x, start), times(w_low, pull_below)), sheet.x, start);
  }
}

/// Gauss-Seidel over every other warp edge, from row `first` to the one below `last`.
template <class T>
void sweep_threads(const WovenSheetView<T>& sheet, int block, int first, int last, T* multipliers, Limits<T>& limits) {
  const auto solve = [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    Wide3<T> a = load(sheet.x, at), b = load(sheet.x, at + k_lanes);
    solve_spring<true, T>(
        a, b, minus(load(sheet.was, at + k_lanes), load(sheet.was, at)),
        load(row_of(sheet.inverse_mass, block, row) + lane), load(row_of(sheet.inverse_mass, block, row + 1) + lane),
        load(row_of(sheet.warp.length, block, row) + lane), load(row_of(sheet.warp.compliance, block, row) + lane),
        multipliers + static_cast<std::ptrdiff_t>(row) * k_lanes + lane, false, limits);
    store(a, sheet.x, at);
    store(b, sheet.x, at + k_lanes);
  };
  for_columns(sheet, block, first, last, solve, 2);
}

// ---- tethers

/// Rigid and one-sided [Kim, Chentanez, Mueller 2012, Long Range Attachments].
template <class T> void pull_tethers(const WovenSheetView<T>& sheet, int block, Limits<T>& limits) {
  const Tag<T> tag;
  const hn::RebindToSigned<Tag<T>> elements;
  for_columns(sheet, block, 0, sheet.rows, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const auto anchor = hn::Load(elements, sheet.tethers.anchor + at);
    const Wide3<T> a = {hn::GatherIndex(tag, sheet.x[0], anchor), hn::GatherIndex(tag, sheet.x[1], anchor),
                        hn::GatherIndex(tag, sheet.x[2], anchor)};
    const Wide<T> length = load(sheet.tethers.length + at);
    const Wide3<T> x = load(sheet.x, at), d = minus(x, a);
    const Wide<T> squared = dot(d, d);
    const auto is_free = load(row_of(sheet.own_inverse_mass, block, row) + lane) > hn::Zero(tag);
    const auto is_taut = hn::And(is_free, squared > length * length);
    if (HWY_LIKELY(hn::AllFalse(tag, is_taut))) return;
    const Wide<T> broken = limits.broken * length;
    limits.bad = hn::IfThenElse(hn::And(is_taut, squared > broken * broken), set(T(1)), limits.bad);
    const Wide<T> back = hn::IfThenElseZero(is_taut, set(T(1)) - length / length_of<T>(d));
    store(minus_times<T>(x, back, d), sheet.x, at);
  });
}

// ---- all constraints

/// Diagonals, where asked for, and weft edges between a block and the next; k_repeats: diagonals more than once in a
/// substep, as weft edges always are. True as whole() is.
template <bool k_repeats, class T>
bool solve_across(const WovenSheetView<T>& sheet, int block, bool with_shear, bool first_pass, Limits<T>& limits) {
  const bool is_last = block + 1 == sheet.blocks, ends_short = has_short_lanes(sheet) && block + 2 == sheet.blocks;
  if (ends_short) fetch_short(sheet, sheet.x);
  if (is_last) fetch_halo(sheet, sheet.x, 0);
  bool is_whole = true;
  for (int first = 0; first < sheet.rows && is_whole; first += k_rows_at_once) {
    const int last = std::min(first + k_rows_at_once, sheet.rows), last_cell = std::min(last, sheet.rows - 1);
    const auto between = [&](const WovenSprings<T>& springs, T* multipliers, int down_a, int down_b) HWY_ATTR {
      return whole(sheet, block, limits, [&]() HWY_ATTR {
        solve_between<k_repeats, T>(sheet, springs, multipliers, block, down_a, down_b, first, last_cell, first_pass,
                                    limits);
      });
    };
    is_whole =
        (!with_shear ||
         (between(sheet.falling, sheet.multipliers[2], 0, 1) && between(sheet.rising, sheet.multipliers[3], 1, 0))) &&
        whole(sheet, block, limits, [&]() HWY_ATTR {
          solve_between<true, T>(sheet, sheet.weft, sheet.multipliers[1], block, 0, 0, first, last, first_pass, limits);
        });
  }
  if (ends_short) {
    return_short(sheet, sheet.x);
    clear_short(sheet, sheet.blocks - 1);
  }
  if (is_last) return_halo(sheet, sheet.x, 0);
  return is_whole;
}

/// Newton steps over the whole threads of a block, then sweeps. True as whole() is.
template <class T>
bool solve_down(const WovenSheetView<T>& sheet, const WovenStep<T>& step, int block, T* multipliers, bool first_pass,
                Limits<T>& limits) {
  bool is_whole = true;
  for (int k = 0; k < step.newton_steps && is_whole; ++k)
    is_whole = whole(sheet, block, limits,
                     [&]() HWY_ATTR { solve_threads(sheet, block, multipliers, first_pass && k == 0, limits); });
  for (int k = 0; k < step.closing_sweeps; ++k)
    for (int first = 0; first < sheet.rows - 1; first += k_rows_at_once) {
      const int last = std::min(first + k_rows_at_once, sheet.rows - 1);
      for (int row = first; row < first + 2 && is_whole; ++row)
        is_whole = whole(sheet, block, limits,
                         [&]() HWY_ATTR { sweep_threads(sheet, block, row, last, multipliers, limits); });
    }
  return is_whole;
}

template <class T> void bend_all(const WovenSheetView<T>& sheet, const Limits<T>& limits) {
  const int last = sheet.blocks - 1;
  const bool is_uneven = has_short_lanes(sheet);
  for (int block = 0; block + 2 < sheet.blocks; ++block) {
    if (is_uneven && block + 2 == last) fetch_short(sheet, sheet.x);
    bend_weft(sheet, block, limits);
  }
  fetch_halo(sheet, sheet.x, 0);
  if (is_uneven) fetch_turned(sheet, sheet.x, 1, last + 1, sheet.long_lanes, sheet.lanes);
  bend_weft(sheet, last - 1, limits);
  if (is_uneven) {
    return_short(sheet, sheet.x);
    return_turned(sheet, sheet.x, 1, last + 1, sheet.long_lanes, sheet.lanes);
    clear_short(sheet, last);
    clear_short(sheet, last + 1);
  }
  fetch_halo(sheet, sheet.x, 1); // not before: of three blocks, block 1 is the last but one
  bend_weft(sheet, last, limits);
  return_halo(sheet, sheet.x, 0);
  return_halo(sheet, sheet.x, 1);
  for (int block = 0; block < sheet.blocks; ++block) bend_warp(sheet, block, limits);
}

/// Where the substep began, behind the lanes' ends: as fetch_halo() and fetch_short() have it for where it is.
template <class T> void fetch_starts(const WovenSheetView<T>& sheet) {
  if (has_short_lanes(sheet)) fetch_short(sheet, sheet.was);
  fetch_halo(sheet, sheet.was, 0);
  if (!sheet.has_bend) return;
  if (has_short_lanes(sheet)) fetch_turned(sheet, sheet.was, 1, sheet.blocks, sheet.long_lanes, sheet.lanes);
  fetch_halo(sheet, sheet.was, 1);
}

template <bool k_repeats, class T>
bool all_constraints(const WovenSheetView<T>& sheet, const WovenStep<T>& step, T* room) {
  const Tag<T> tag;
  Limits<T> limits = {set(step.taken / (step.h * step.h)),
                      set(T(1) - step.taken),
                      set(step.elastic),
                      set(T(k_most_turn)),
                      set(T(k_most_pull)),
                      set(T(1.0 + k_diverged_stretch)),
                      hn::Zero(tag),
                      room};
  fetch_starts(sheet);
  if (sheet.has_bend) bend_all(sheet, limits);
  if (sheet.tethers.length)
    for (int block = 0; block < sheet.blocks; ++block)
      if (!whole(sheet, block, limits, [&]() HWY_ATTR { pull_tethers(sheet, block, limits); })) return false;
  for (int pass = 0; pass < step.passes; ++pass) {
    const bool first = pass == 0;
    for (int block = 0; block < sheet.blocks; ++block)
      if (!solve_across<k_repeats>(sheet, block, sheet.has_shear, first, limits)) return false;
    // Weft edges hand a load on by one thread a sweep, warp threads whole. They come before these: what they are still
    // too long by, threads do not have to mend, while what they would pull afterwards would tear threads at contacts.
    for (int k = 0; k < step.weft_sweeps; ++k)
      for (int n = 0; n < sheet.blocks; ++n)
        if (!solve_across<k_repeats>(sheet, k % 2 == 0 ? sheet.blocks - 1 - n : n, false, false, limits)) return false;
    for (int block = 0; block < sheet.blocks; ++block) {
      // With one pass a thread's multipliers are needed no longer than its own solve.
      T* multipliers = sheet.multipliers[0] + (k_repeats ? place(sheet, block, 0) : 0);
      if (!solve_down(sheet, step, block, multipliers, first, limits)) return false;
    }
  }
  return hn::AllFalse(tag, limits.bad > hn::Zero(tag));
}

template <class T> bool constraints_to_break(const WovenSheetView<T>& sheet, const WovenStep<T>& step, T* room) {
  const bool is_whole =
      step.passes > 1 ? all_constraints<true>(sheet, step, room) : all_constraints<false>(sheet, step, room);
  if (has_short_lanes(sheet)) rest_short(sheet);
  return is_whole;
}
template <class T> bool constraints(const WovenSheetView<T>& sheet, const WovenStep<T>& step) {
  return constraints_to_break<T>(sheet, step, nullptr);
}

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
