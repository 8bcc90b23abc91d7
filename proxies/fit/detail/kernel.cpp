#include "proxies/fit/detail/kernel.h"

#include <limits>

// Compiled once for each of Highway's targets, each lane the same operations: same bits on all.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "proxies/fit/detail/kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tutu::proxies::fit::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, k_lanes>;
using Wide = hn::Vec<Tag>;

/// For the closed forms. Never fused, so that the bits are those of every target.
struct UnfusedArithmetic {
  using Real = Wide;
  struct Vector {
    Wide x, y, z;
  };
  static HWY_INLINE Wide set(double x) { return hn::Set(Tag(), static_cast<float>(x)); }
  static HWY_INLINE Wide min(Wide x, Wide y) { return hn::Min(x, y); }
  static HWY_INLINE Wide max(Wide x, Wide y) { return hn::Max(x, y); }
  static HWY_INLINE Wide dot(const Vector& v, const Vector& w) { return (v.x * w.x + v.y * w.y) + v.z * w.z; }
  static HWY_INLINE Wide length(const Vector& v) { return hn::Sqrt(dot(v, v)); }
  static HWY_INLINE Vector minus_times(const Vector& v, Wide s, const Vector& w) {
    return {v.x - s * w.x, v.y - s * w.y, v.z - s * w.z};
  }
};

#include "proxies/distance/closed_forms_inl.h"

using Forms = ClosedForms<UnfusedArithmetic>;
using Shapes = RoundCone<UnfusedArithmetic>; // one a lane; may be the same in all

template <bool k_tapered> HWY_INLINE Wide distances(const Shapes& s, Wide x, Wide y, Wide z) {
  const UnfusedArithmetic::Vector d = {x - s.a.x, y - s.a.y, z - s.a.z};
  const Wide t = Forms::nearest_on_axis<k_tapered>(s, d);
  const Wide distance = UnfusedArithmetic::length(UnfusedArithmetic::minus_times(d, t, s.axis)) - s.radius;
  if constexpr (k_tapered) return distance - t * s.taper;
  return distance;
}

HWY_INLINE Wide load(const float* from) { return hn::LoadU(Tag(), from); }

/// What `lanes` makes of each array.
template <class Lanes> HWY_INLINE Shapes shapes_of(const ShapeArrays& a, const Lanes& lanes) {
  return {{lanes(a.ax), lanes(a.ay), lanes(a.az)},
          {lanes(a.dx), lanes(a.dy), lanes(a.dz)},
          lanes(a.inverse_square),
          lanes(a.radius),
          lanes(a.taper),
          lanes(a.lean)};
}

/// One shape in all lanes.
HWY_INLINE Shapes same(const ShapeArrays& a, std::size_t i) {
  return shapes_of(a, [i](const float* of) HWY_ATTR { return hn::Set(Tag(), of[i]); });
}

void from_shapes(const ShapeArrays& a, std::size_t first, int count, float x, float y, float z, float* out) {
  const Tag tag;
  const auto width = static_cast<int>(hn::Lanes(tag));
  const Wide wide_x = hn::Set(tag, x), wide_y = hn::Set(tag, y), wide_z = hn::Set(tag, z);
  for (int k = 0; k < count; k += width) {
    const std::size_t i = first + k;
    const Shapes shapes = shapes_of(a, [i](const float* of) HWY_ATTR { return load(of + i); });
    hn::StoreU(distances<true>(shapes, wide_x, wide_y, wide_z), tag, out + k);
  }
}

void nearest(const ShapeArrays& a, std::size_t first, const int* candidates, int count, const float* x, const float* y,
             const float* z, float* distance, int* shape) {
  const Tag tag;
  const hn::RebindToSigned<Tag> index_tag;
  const auto width = static_cast<int>(hn::Lanes(tag));
  for (int lane = 0; lane < k_lanes; lane += width) {
    const Wide wide_x = load(x + lane), wide_y = load(y + lane), wide_z = load(z + lane);
    Wide best = hn::Set(tag, std::numeric_limits<float>::infinity());
    auto which = hn::Set(index_tag, -1);
    for (int c = 0; c < count; ++c) {
      const std::size_t i = first + candidates[c];
      const Shapes one = same(a, i);
      const Wide d = a.lean[i] != 0.0f ? distances<true>(one, wide_x, wide_y, wide_z)
                                       : distances<false>(one, wide_x, wide_y, wide_z);
      const auto nearer = d < best;
      best = hn::IfThenElse(nearer, d, best);
      which = hn::IfThenElse(hn::RebindMask(index_tag, nearer), hn::Set(index_tag, candidates[c]), which);
    }
    hn::StoreU(best, tag, distance + lane);
    hn::StoreU(which, index_tag, shape + lane);
  }
}

void from_shape(const ShapeArrays& a, std::size_t shape, const float* x, const float* y, const float* z, float* out) {
  const Tag tag;
  const Shapes one = same(a, shape);
  for (int lane = 0; lane < k_lanes; lane += static_cast<int>(hn::Lanes(tag)))
    hn::StoreU(distances<true>(one, load(x + lane), load(y + lane), load(z + lane)), tag, out + lane);
}

} // namespace tutu::proxies::fit::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tutu::proxies::fit {

HWY_EXPORT(from_shapes);
HWY_EXPORT(nearest);
HWY_EXPORT(from_shape);

void distances_from_shapes(const ShapeArrays& shapes, std::size_t first, int count, float x, float y, float z,
                           float* out) {
  HWY_DYNAMIC_DISPATCH(from_shapes)(shapes, first, count, x, y, z, out);
}

void nearest_of_block(const ShapeArrays& shapes, std::size_t first, const int* candidates, int count, const float* x,
                      const float* y, const float* z, float* distance, int* shape) {
  HWY_DYNAMIC_DISPATCH(nearest)(shapes, first, candidates, count, x, y, z, distance, shape);
}

void distances_from_shape(const ShapeArrays& shapes, std::size_t shape, const float* x, const float* y, const float* z,
                          float* out) {
  HWY_DYNAMIC_DISPATCH(from_shape)(shapes, shape, x, y, z, out);
}

} // namespace tutu::proxies::fit
#endif
