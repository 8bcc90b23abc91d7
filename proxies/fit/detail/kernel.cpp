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

/// Capsules against points, one of each a lane; either may be the same in all lanes.
struct Shapes {
  Wide ax, ay, az, dx, dy, dz, inverse_square, radius, taper, lean;
};

HWY_INLINE Wide dot(Wide ax, Wide ay, Wide az, Wide bx, Wide by, Wide bz) { return (ax * bx + ay * by) + az * bz; }

template <bool k_tapered> HWY_INLINE Wide distances(const Shapes& s, Wide x, Wide y, Wide z) {
  const Tag tag;
  const Wide px = x - s.ax, py = y - s.ay, pz = z - s.az;
  Wide t = dot(px, py, pz, s.dx, s.dy, s.dz) * s.inverse_square;
  if constexpr (k_tapered) {
    const Wide ux = px - t * s.dx, uy = py - t * s.dy, uz = pz - t * s.dz;
    t = t + hn::Sqrt(dot(ux, uy, uz, ux, uy, uz)) * s.lean;
  }
  t = hn::Min(hn::Max(t, hn::Zero(tag)), hn::Set(tag, 1.0f));
  const Wide vx = px - t * s.dx, vy = py - t * s.dy, vz = pz - t * s.dz;
  const Wide distance = hn::Sqrt(dot(vx, vy, vz, vx, vy, vz)) - s.radius;
  if constexpr (k_tapered) return distance - t * s.taper;
  return distance;
}

/// One shape in all lanes.
HWY_INLINE Shapes same(const ShapeArrays& a, std::size_t i) {
  const Tag tag;
  return {hn::Set(tag, a.ax[i]),
          hn::Set(tag, a.ay[i]),
          hn::Set(tag, a.az[i]),
          hn::Set(tag, a.dx[i]),
          hn::Set(tag, a.dy[i]),
          hn::Set(tag, a.dz[i]),
          hn::Set(tag, a.inverse_square[i]),
          hn::Set(tag, a.radius[i]),
          hn::Set(tag, a.taper[i]),
          hn::Set(tag, a.lean[i])};
}

HWY_INLINE Wide load(const float* from) { return hn::LoadU(Tag(), from); }

void from_shapes(const ShapeArrays& a, std::size_t first, int count, float x, float y, float z, float* out) {
  const Tag tag;
  const auto width = static_cast<int>(hn::Lanes(tag));
  const Wide wide_x = hn::Set(tag, x), wide_y = hn::Set(tag, y), wide_z = hn::Set(tag, z);
  for (int k = 0; k < count; k += width) {
    const std::size_t i = first + k;
    const Shapes shapes = {load(a.ax + i),
                           load(a.ay + i),
                           load(a.az + i),
                           load(a.dx + i),
                           load(a.dy + i),
                           load(a.dz + i),
                           load(a.inverse_square + i),
                           load(a.radius + i),
                           load(a.taper + i),
                           load(a.lean + i)};
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
