// What the contacts of a woven sheet tell who watches. For kernel.cpp alone.
#if defined(TUTU_CLOTH_WOVEN_HITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TUTU_CLOTH_WOVEN_HITS_INL_H
#undef TUTU_CLOTH_WOVEN_HITS_INL_H
#else
#define TUTU_CLOTH_WOVEN_HITS_INL_H
#endif

#include "cloth/woven/arithmetic_inl.h"
#include "cloth/woven/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tutu::cloth::HWY_NAMESPACE {

/// How a contact moves a point of the cloth, m: in all, and the part along the normal.
template <class T> struct Pushed {
  Wide3<T> moved;
  Wide<T> push;
};

/// A vector of hits: WovenHit, all lanes.
template <class T> struct WideHit {
  std::ptrdiff_t cell = 0;
  int corners = 0;
  std::ptrdiff_t corner[3] = {}; ///< of lane 0
  Wide<T> weight[3], lever[3];
  Wide3<T> point, normal;
  Wide<T> depth;
  Pushed<T> pushed;
};

/// Asked for by loops of their own (k_kept): in those of everybody even a branch that is never taken costs registers,
/// 2 to 4 % of a frame's instructions.
template <class T, class Mask> void keep(const WovenHits<T>& hits, Mask is_hit, const WideHit<T>& wide) {
  enum Row {
    k_point = 0,
    k_normal = 3,
    k_moved = 6,
    k_depth = 9,
    k_push,
    k_is_hit,
    k_weights,
    k_levers = 15,
    k_rows = 18
  };
  const Tag<T> tag;
  HWY_ALIGN T lanes[k_rows][k_lanes];
  const auto put = [&](int row, Wide<T> v) HWY_ATTR { hn::Store(v, tag, lanes[row]); };
  const auto put3 = [&](int row, const Wide3<T>& v) HWY_ATTR {
    put(row, v.x);
    put(row + 1, v.y);
    put(row + 2, v.z);
  };
  put3(k_point, wide.point);
  put3(k_normal, wide.normal);
  put3(k_moved, wide.pushed.moved);
  put(k_depth, wide.depth);
  put(k_push, wide.pushed.push);
  put(k_is_hit, hn::IfThenElseZero(is_hit, set(T(1))));
  for (int k = 0; k < wide.corners; ++k) {
    put(k_weights + k, wide.weight[k]);
    put(k_levers + k, wide.lever[k]);
  }
  for (std::size_t lane = 0; lane < hn::Lanes(tag); ++lane) {
    if (lanes[k_is_hit][lane] == T(0)) continue;
    const auto at = static_cast<std::ptrdiff_t>(lane);
    WovenHit<T> hit;
    hit.cell = wide.cell + at;
    for (int axis = 0; axis < 3; ++axis) {
      hit.point[axis] = lanes[k_point + axis][lane];
      hit.normal[axis] = lanes[k_normal + axis][lane];
      hit.moved[axis] = lanes[k_moved + axis][lane];
    }
    hit.depth = lanes[k_depth][lane];
    hit.push = lanes[k_push][lane];
    for (int k = 0; k < wide.corners; ++k) {
      hit.corners[k] = wide.corner[k] + at;
      hit.weights[k] = lanes[k_weights + k][lane];
      hit.levers[k] = lanes[k_levers + k][lane];
    }
    hits.keep(hits.keeper, hit);
  }
}

/// Of free particles.
template <bool k_kept, class T, class Mask>
HWY_INLINE void count_particles(WovenHits<T>& hits, Mask is_hit, std::ptrdiff_t at, const Wide3<T>& x,
                                const Wide3<T>& n, Wide<T> depth, const Pushed<T>& pushed) {
  hits.count += static_cast<std::int64_t>(hn::CountTrue(Tag<T>(), is_hit));
  if constexpr (k_kept) {
    const Wide<T> one = set(T(1));
    keep(hits, is_hit, WideHit<T>{at, 1, {at}, {one, one, one}, {one, one, one}, x, n, depth, pushed});
  }
}

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
