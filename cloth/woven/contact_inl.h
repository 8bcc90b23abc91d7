// A woven sheet against colliders: particles, then the edges and faces of cells. For kernel.cpp alone.
#if defined(TUTU_CLOTH_WOVEN_CONTACT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TUTU_CLOTH_WOVEN_CONTACT_INL_H
#undef TUTU_CLOTH_WOVEN_CONTACT_INL_H
#else
#define TUTU_CLOTH_WOVEN_CONTACT_INL_H
#endif

#include "cloth/state/tolerances.h"
#include "cloth/woven/arithmetic_inl.h"
#include "cloth/woven/hits_inl.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tutu::cloth::HWY_NAMESPACE {

// ---- contacts

/// Points nearer to an axis than this, m, have no direction from it: the rounding of coordinates of a metre or two.
template <class T> constexpr T k_no_direction = sizeof(T) == sizeof(float) ? T(1e-6) : T(1e-12);

/// What a contact moves a point of the cloth by: out of the collider along the normal n by `push`, and back along what
/// it slipped over the moving surface, by at most friction * push (Coulomb's law on positions). `slip`: the point's way
/// in this substep less that of the surface under it. `is_hit` lanes only; 0 in the others.
template <class T, class Mask>
HWY_INLINE Pushed<T> response(Mask is_hit, Wide<T> depth, const Wide3<T>& n, const Wide3<T>& way, const Wide3<T>& slip,
                              const WovenSurface<T>& surface) {
  // A contact that was made in this substep is no deeper than both sides moved: deeper ones come from a start
  // inside, and are worked out at a bounded speed.
  const Wide<T> most = hn::Sqrt(dot(way, way)) + set(surface.moved + surface.push_speed_step);
  const Wide<T> push = hn::IfThenElseZero(is_hit, hn::Min(depth, most));
  return {rubbed<WideArithmetic<T>>(times(push, n), slip, n, set(surface.friction) * push), push};
}

template <class T> using Forms = ClosedForms<WideArithmetic<T>>;

/// A collider broadcast to all lanes.
template <class T> struct WideCollider : RoundCone<WideArithmetic<T>> {
  Wide3<T> move_a, move_axis, spin, on_axis;
  explicit HWY_INLINE WideCollider(const WovenCollider<T>& c)
      : RoundCone<WideArithmetic<T>>{set3(c.a),     set3(c.axis), set(c.per_axis_squared),
                                     set(c.radius), set(c.taper), set(c.lean)},
        move_a(set3(c.move_a)), move_axis(set3(c.move_axis)), spin(set3(c.spin)), on_axis(set3(c.on_axis)) {}
};

/// The surface of a collider at a point in direction n from the place t of its axis, where its radius is given: how far
/// it has moved.
template <class T>
HWY_INLINE Wide3<T> surface_move(const WideCollider<T>& c, Wide<T> t, Wide<T> radius, const Wide3<T>& n) {
  const Wide3<T> arm = times(radius, n);
  return plus(plus_times<T>(c.move_a, t, c.move_axis), cross(c.spin, arm));
}

/// Direction of q, of length `length`; where it has none, the collider's own.
template <class T> HWY_INLINE Wide3<T> normal_of(const Wide3<T>& q, Wide<T> length, const Wide3<T>& on_axis) {
  const auto has_none = length < set(k_no_direction<T>);
  const Wide3<T> n = times(set(T(1)) / length, q);
  return {hn::IfThenElse(has_none, on_axis.x, n.x), hn::IfThenElse(has_none, on_axis.y, n.y),
          hn::IfThenElse(has_none, on_axis.z, n.z)};
}

template <bool k_tapered, bool k_kept, bool k_marks, class T>
T contact_capsule_as(const WovenSheetView<T>& sheet, const WovenRows& rows, const WovenCollider<T>& collider, T rise,
                     WovenMarks<T>* marks, WovenHits<T>* hits) {
  const Tag<T> tag;
  WideCollider<T> c(collider);
  c.radius = set(collider.radius + rise);
  const Wide<T> far = set(std::numeric_limits<T>::max()), squared_radius = c.radius * c.radius;
  Wide<T> least = far;                 // distance from the surface; of a plain capsule squared distance from the axis
  Wide<T> nearest = far, marked = far; // the same of all particles, and within which rows are marked
  if constexpr (k_marks) {
    const T reach = collider.radius + rise + marks->within;
    marked = set(k_tapered ? marks->within : reach * reach);
    std::fill_n(marks->rows, rows.last - rows.first, std::uint8_t{0});
  }
  for_rows(sheet, rows.block, rows.first, rows.last, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const Wide3<T> x = load(sheet.x, at), d = minus(x, c.a);
    const Wide<T> t = Forms<T>::template nearest_on_axis<k_tapered>(c, d);
    const Wide<T> radius = Forms<T>::template radius_at<k_tapered>(c, t);
    const Wide3<T> q = minus_times<T>(d, t, c.axis);
    const Wide<T> squared = dot(q, q), length = k_tapered ? length_of<T>(q) : squared;
    const Wide<T> beyond = k_tapered ? length - radius : squared;
    if constexpr (k_marks) {
      nearest = hn::Min(nearest, beyond);
      if (!hn::AllFalse(tag, beyond < marked)) marks->rows[row - rows.first] = 1;
    }
    const auto is_free = load(row_of(sheet.own_inverse_mass, rows.block, row) + lane) > hn::Zero(tag);
    least = hn::Min(least, hn::IfThenElse(is_free, beyond, far));
    const auto is_hit = hn::And(is_free, k_tapered ? beyond < hn::Zero(tag) : squared < squared_radius);
    if (HWY_LIKELY(hn::AllFalse(tag, is_hit))) return;
    const Wide<T> from_axis = k_tapered ? length : length_of<T>(q);
    const Wide3<T> n = normal_of<T>(q, from_axis, c.on_axis);
    const Wide3<T> way = minus(x, load(sheet.was, at));
    const Wide3<T> slip = minus(way, surface_move<T>(c, t, radius, n));
    const Wide<T> depth = radius - from_axis;
    const Pushed<T> pushed = response<T>(is_hit, depth, n, way, slip, collider);
    store(plus(x, pushed.moved), sheet.x, at);
    count_particles<k_kept>(*hits, is_hit, at, x, n, depth, pushed);
  });
  const auto gap = [&](Wide<T> all) HWY_ATTR {
    const T one = hn::GetLane(hn::MinOfLanes(tag, all));
    return k_tapered ? one : std::sqrt(one) - (collider.radius + rise);
  };
  if constexpr (k_marks) marks->nearest = gap(nearest);
  return gap(least);
}

template <bool k_tapered, bool k_kept, class T>
T contact_capsule_marking(const WovenSheetView<T>& sheet, const WovenRows& rows, const WovenCollider<T>& collider,
                          T rise, WovenMarks<T>* marks, WovenHits<T>* hits) {
  return marks ? contact_capsule_as<k_tapered, k_kept, true>(sheet, rows, collider, rise, marks, hits)
               : contact_capsule_as<k_tapered, k_kept, false>(sheet, rows, collider, rise, marks, hits);
}

template <class T>
T contact_capsule(const WovenSheetView<T>& sheet, const WovenRows& rows, const WovenCollider<T>& collider, T rise,
                  WovenMarks<T>* marks, WovenHits<T>* hits) {
  const bool is_tapered = collider.taper != T(0);
  const auto contact =
      hits->keep ? (is_tapered ? contact_capsule_marking<true, true, T> : contact_capsule_marking<false, true, T>)
                 : (is_tapered ? contact_capsule_marking<true, false, T> : contact_capsule_marking<false, false, T>);
  return contact(sheet, rows, collider, rise, marks, hits);
}

template <bool k_kept, class T>
T contact_plane_as(const WovenSheetView<T>& sheet, const WovenRows& rows, const WovenPlane<T>& plane,
                   WovenHits<T>* hits) {
  const Tag<T> tag;
  const Wide3<T> n = set3(plane.normal);
  const Wide<T> offset = set(plane.offset), far = set(std::numeric_limits<T>::max());
  Wide<T> least = far;
  for_rows(sheet, rows.block, rows.first, rows.last, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const Wide3<T> x = load(sheet.x, at);
    const Wide<T> height = Forms<T>::height(n, offset, x);
    const auto is_free = load(row_of(sheet.own_inverse_mass, rows.block, row) + lane) > hn::Zero(tag);
    least = hn::Min(least, hn::IfThenElse(is_free, height, far));
    const auto is_hit = hn::And(is_free, height < hn::Zero(tag));
    if (HWY_LIKELY(hn::AllFalse(tag, is_hit))) return;
    const Wide3<T> way = minus(x, load(sheet.was, at));
    const Pushed<T> pushed = response<T>(is_hit, hn::Neg(height), n, way, way, plane);
    store(plus(x, pushed.moved), sheet.x, at);
    count_particles<k_kept>(*hits, is_hit, at, x, n, hn::Neg(height), pushed);
  });
  return hn::GetLane(hn::MinOfLanes(tag, least));
}

template <class T>
T contact_plane(const WovenSheetView<T>& sheet, const WovenRows& rows, const WovenPlane<T>& plane, WovenHits<T>* hits) {
  const auto contact = hits->keep ? contact_plane_as<true, T> : contact_plane_as<false, T>;
  return contact(sheet, rows, plane, hits);
}

// ---- edges and faces

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
template <bool k_tapered, bool k_kept, class T> class CellContact {
public:
  using Mask = decltype(Wide<T>() < Wide<T>());

  /// `cell`: the element of the first corner.
  HWY_INLINE CellContact(const WovenSheetView<T>& sheet, const WovenCollider<T>& collider, const WideCollider<T>& wide,
                         const WovenHits<T>& hits, std::ptrdiff_t cell)
      : sheet_(sheet), collider_(collider), c_(wide), hits_(hits), cell_(cell), touched_(0) {}

  /// Points that hit since the last call.
  HWY_INLINE std::int64_t touched() const { return touched_; }

  HWY_INLINE void edge(Corner<T>& a, Corner<T>& b, Mask exists) {
    const Tag<T> tag;
    const Wide3<T> along = minus(b.x, a.x), r = minus(a.x, c_.a);
    const Wide<T> ee = hn::Max(dot(along, along), set(T(1e-20)));
    const auto [s, t] = k_tapered ? Forms<T>::template nearest_of_cone<true>(c_, along, r, ee)
                                  : Forms<T>::nearest_of_segments(c_, along, r, ee);
    const Wide3<T> q = minus(plus_times<T>(r, s, along), times(t, c_.axis));
    const auto is_hit = hn::And(hn::And(exists, (a.w + b.w) > hn::Zero(tag)), dot(q, q) < squared_radius(t));
    if (HWY_LIKELY(hn::AllFalse(tag, is_hit))) return;
    const Wide<T> share_a = set(T(1)) - s;
    const Wide3<T> way =
        plus(times(share_a, minus(a.x, load(sheet_.was, a.at))), times(s, minus(b.x, load(sheet_.was, b.at))));
    const Wide<T> by_a = a.w * share_a, by_b = b.w * s;
    const Out out = way_out(t, q, way, is_hit, by_a * share_a + by_b * s, hn::Max(by_a, by_b));
    a.x = plus_times<T>(a.x, by_a, out.per_lever);
    b.x = plus_times<T>(b.x, by_b, out.per_lever);
    if constexpr (k_kept)
      keep(hits_, is_hit,
           WideHit<T>{cell_,
                      2,
                      {a.at, b.at},
                      {share_a, s, s},
                      {by_a * out.per_weight, by_b * out.per_weight, s},
                      on_cloth(t, q),
                      out.n,
                      out.depth,
                      out.pushed});
    touched_ += static_cast<std::int64_t>(hn::CountTrue(tag, is_hit));
  }

  /// The end t (0 or 1) of the axis against the inside of a triangle. Feet outside belong to an edge.
  HWY_INLINE void face(T t, Corner<T>& o, Corner<T>& p, Corner<T>& q, Mask exists) {
    const Tag<T> tag;
    const Wide3<T> e = minus(p.x, o.x), f = minus(q.x, o.x), r = minus(plus_times<T>(c_.a, set(t), c_.axis), o.x);
    const auto [u, v, w] = Forms<T>::foot_on_plane(e, f, r, set(T(1e-20)));
    const Wide3<T> away = minus(plus(times(v, e), times(w, f)), r);
    const auto inside = hn::Min(u, hn::Min(v, w)) >= hn::Zero(tag);
    const auto near = hn::And(dot(away, away) < squared_radius(set(t)), (o.w + p.w + q.w) > hn::Zero(tag));
    const auto is_hit = hn::And(exists, hn::And(inside, near));
    if (HWY_LIKELY(hn::AllFalse(tag, is_hit))) return;
    const Wide3<T> way =
        plus(times(u, minus(o.x, load(sheet_.was, o.at))),
             plus(times(v, minus(p.x, load(sheet_.was, p.at))), times(w, minus(q.x, load(sheet_.was, q.at)))));
    const Wide<T> by_o = o.w * u, by_p = p.w * v, by_q = q.w * w;
    const Out out =
        way_out(set(t), away, way, is_hit, by_o * u + by_p * v + by_q * w, hn::Max(by_o, hn::Max(by_p, by_q)));
    o.x = plus_times<T>(o.x, by_o, out.per_lever);
    p.x = plus_times<T>(p.x, by_p, out.per_lever);
    q.x = plus_times<T>(q.x, by_q, out.per_lever);
    if constexpr (k_kept)
      keep(hits_, is_hit,
           WideHit<T>{cell_,
                      3,
                      {o.at, p.at, q.at},
                      {u, v, w},
                      {by_o * out.per_weight, by_p * out.per_weight, by_q * out.per_weight},
                      on_cloth(set(t), away),
                      out.n,
                      out.depth,
                      out.pushed});
    touched_ += static_cast<std::int64_t>(hn::CountTrue(tag, is_hit));
  }

private:
  HWY_INLINE Wide<T> squared_radius(Wide<T> t) const {
    const Wide<T> radius = Forms<T>::template radius_at<k_tapered>(c_, t);
    return radius * radius;
  }

  /// What the contact point, q away from the place t of the axis, has to move by. A corner's lever is its inverse mass
  /// times share over the sum of inverse mass times squared share; `most` is the largest of the products: beside a
  /// pinned corner the lever is kept to k_longest_lever.
  struct Out {
    Wide3<T> per_lever; ///< what a corner moves by over its inverse mass times share
    Wide<T> per_weight; ///< lever over the same
    Wide3<T> n;
    Wide<T> depth;
    Pushed<T> pushed;
  };
  HWY_INLINE Out way_out(Wide<T> t, const Wide3<T>& q, const Wide3<T>& way, Mask is_hit, Wide<T> weights,
                         Wide<T> most) const {
    const Wide<T> length = length_of<T>(q), radius = Forms<T>::template radius_at<k_tapered>(c_, t);
    const Wide3<T> n = normal_of<T>(q, length, c_.on_axis);
    const Wide3<T> slip = minus(way, surface_move<T>(c_, t, radius, n));
    const Wide<T> depth = radius - length;
    const Pushed<T> pushed = response<T>(is_hit, depth, n, way, slip, collider_);
    const Wide<T> least = hn::Max(most * set(T(1.0 / k_longest_lever)), set(T(1e-20)));
    const Wide<T> per_weight = set(T(1)) / hn::Max(weights, least);
    return {times(per_weight, pushed.moved), per_weight, n, depth, pushed};
  }

  HWY_INLINE Wide3<T> on_cloth(Wide<T> t, const Wide3<T>& q) const { return plus(plus_times<T>(c_.a, t, c_.axis), q); }

  const WovenSheetView<T>& sheet_;
  const WovenCollider<T>& collider_;
  const WideCollider<T>& c_;
  const WovenHits<T>& hits_;
  std::ptrdiff_t cell_;
  std::int64_t touched_;
};

/// The corners of a cell around the middle of two of them: `b` and the one opposite to it.
template <class T> class CellAround {
public:
  HWY_INLINE CellAround(const Wide3<T>& middle, const Wide3<T>& a, const Wide3<T>& b, const Wide3<T>& e)
      : to_a_(minus(a, middle)), to_b_(minus(b, middle)), to_e_(minus(e, middle)) {}

  /// Whether any of the cell may be within `radius` of what is convex and from which its middle is `away`, at the
  /// nearest. Distance from that is convex too: nowhere is it less than what it grows to by its slope at the middle,
  /// |away| + away . to / |away|, which is least at a corner. Each lane answers for itself: the answer must not depend
  /// on how many there are.
  HWY_INLINE auto may_be_within(Wide<T> radius, const Wide3<T>& away) const {
    const Wide<T> squared = dot(away, away);
    const Wide<T> least = hn::Min(hn::Neg(hn::Abs(dot(away, to_b_))), hn::Min(dot(away, to_a_), dot(away, to_e_)));
    return squared + least <= radius * hn::Sqrt(squared);
  }

private:
  Wide3<T> to_a_, to_b_, to_e_;
};

/// m from the axis of a collider that nothing of it is beyond, with more than the rounding of what is asked.
template <class T> T reach_of(const WovenCollider<T>& c) {
  return c.radius + (c.taper > T(0) ? c.taper : T(0)) + T(1e-6);
}

/// Weft edges and diagonals alone, for cells so low that nothing pokes between the two.
template <bool k_tapered, bool k_kept, class T>
void contact_low_cells(const WovenSheetView<T>& sheet, const WovenRows& rows, const WovenCollider<T>& collider,
                       const std::uint8_t* asked, WovenHits<T>* hits) {
  const Tag<T> tag;
  const WideCollider<T> c(collider);
  const int block = rows.block;
  const auto real = set(T(0.5 * k_no_constraint)), half = set(T(0.5));
  const auto width = static_cast<int>(hn::Lanes(tag));
  const int cells = lanes_in(sheet, block);
  const Wide<T> radius = set(reach_of(collider));
  for (int row = rows.first; row < rows.last; ++row) {
    if (!asked[row - rows.first]) continue;
    for (int lane = 0; lane < cells; lane += width) {
      const bool has_below = row + 1 < sheet.rows;
      Corner<T> a = corner(sheet, block, row, lane), b = corner(sheet, block + 1, row, lane);
      Corner<T> d = corner(sheet, block, has_below ? row + 1 : row, lane);
      const Wide3<T> middle = times(half, plus(a.x, b.x)), m = minus(middle, c.a);
      const Wide3<T> away = minus_times<T>(m, Forms<T>::template nearest_on_axis<false>(c, m), c.axis);
      const auto is_cell = hn::Iota(tag, lane) < set(static_cast<T>(cells));
      const auto near = hn::And(CellAround<T>(middle, d.x, b.x, d.x).may_be_within(radius, away), is_cell);
      if (HWY_LIKELY(hn::AllFalse(tag, near))) continue;
      const auto exists = hn::And(near, load(row_of(sheet.weft.compliance, block, row) + lane) < real);
      CellContact<k_tapered, k_kept, T> contact(sheet, collider, c, *hits, a.at);
      contact.edge(a, b, exists);
      if (has_below) contact.edge(b, d, exists);
      if (contact.touched() == 0) continue;
      hits->count += contact.touched();
      store(a.x, sheet.x, a.at);
      store(b.x, sheet.x, b.at);
      if (has_below) store(d.x, sheet.x, d.at);
    }
  }
}

template <bool k_tapered, bool k_kept, class T>
void contact_cells_as(const WovenSheetView<T>& sheet, const WovenRows& rows, const WovenCollider<T>& collider,
                      CellFeatures features, const std::uint8_t* asked, WovenHits<T>* hits) {
  if (!features.high) {
    contact_low_cells<k_tapered, k_kept>(sheet, rows, collider, asked, hits);
    return;
  }
  const Tag<T> tag;
  const WideCollider<T> c(collider);
  const int ends = collider.per_axis_squared > T(0) ? 2 : 1;
  const int block = rows.block;
  const auto real = set(T(0.5 * k_no_constraint)), half = set(T(0.5));
  const auto width = static_cast<int>(hn::Lanes(tag));
  const int cells = lanes_in(sheet, block);
  const Wide<T> radius = set(reach_of(collider));
  for (int row = rows.first; row < rows.last; ++row) {
    if (!asked[row - rows.first]) continue;
    for (int lane = 0; lane < cells; lane += width) {
      const bool has_below = row + 1 < sheet.rows;
      Corner<T> a = corner(sheet, block, row, lane), b = corner(sheet, block + 1, row, lane);
      Corner<T> d = has_below ? corner(sheet, block, row + 1, lane) : a;
      Corner<T> e = has_below ? corner(sheet, block + 1, row + 1, lane) : b;
      const Wide3<T> middle = times(half, plus(b.x, d.x)), m = minus(middle, c.a);
      const Wide3<T> away = minus_times<T>(m, Forms<T>::template nearest_on_axis<false>(c, m), c.axis);
      const auto is_cell = hn::Iota(tag, lane) < set(static_cast<T>(cells));
      const auto near = hn::And(CellAround<T>(middle, a.x, b.x, e.x).may_be_within(radius, away), is_cell);
      if (HWY_LIKELY(hn::AllFalse(tag, near))) continue;

      // Each feature is looked at where the ones before it left its corners.
      const auto exists = hn::And(near, load(row_of(sheet.weft.compliance, block, row) + lane) < real);
      CellContact<k_tapered, k_kept, T> contact(sheet, collider, c, *hits, a.at);
      contact.edge(a, b, exists);
      if (has_below) {
        contact.edge(a, d, near);
        contact.edge(b, d, exists);
        const Wide3<T> now = times(half, plus(b.x, d.x)), from_a = minus(now, c.a); // edges may have moved all corners
        const CellAround<T> around_now(now, a.x, b.x, e.x);
        for (int end = 0; end < ends; ++end) {
          const auto near_end =
              hn::And(exists, around_now.may_be_within(radius, end == 0 ? from_a : minus(from_a, c.axis)));
          if (hn::AllFalse(tag, near_end)) continue;
          contact.face(static_cast<T>(end), a, d, b, near_end);
          contact.face(static_cast<T>(end), e, b, d, near_end);
        }
      }
      if (contact.touched() == 0) continue;
      hits->count += contact.touched();
      store(a.x, sheet.x, a.at);
      store(b.x, sheet.x, b.at);
      if (!has_below) continue;
      store(d.x, sheet.x, d.at);
      store(e.x, sheet.x, e.at);
    }
  }
}

template <class T>
void contact_cells(const WovenSheetView<T>& sheet, const WovenRows& rows, const WovenCollider<T>& collider,
                   CellFeatures features, const std::uint8_t* asked, WovenHits<T>* hits) {
  const bool is_tapered = collider.taper != T(0);
  const auto contact = hits->keep ? (is_tapered ? contact_cells_as<true, true, T> : contact_cells_as<false, true, T>)
                                  : (is_tapered ? contact_cells_as<true, false, T> : contact_cells_as<false, false, T>);
  contact(sheet, rows, collider, features, asked, hits);
}

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
