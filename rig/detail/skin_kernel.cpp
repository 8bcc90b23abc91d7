#include "rig/detail/skin_kernel.h"

#include <cmath>
#include <cstddef>

// Compiled once for each of Highway's targets. No Eigen here: its layout depends on the vector flags, and these differ.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rig/detail/skin_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tutu::rig::HWY_NAMESPACE {

// Squared length below which a normal has none: smaller ones come from exact cancelling only, and their digits are
// lost.
constexpr float k_least_squared_length = 1e-30f;

#if HWY_TARGET == HWY_SCALAR

// Highway's fallback has vectors of one lane only; the same operations in plain floats, in the same order.
template <int k_influences, bool k_with_normals> void skin_range(const SkinKernelArguments& in) {
  const auto last = static_cast<std::size_t>(in.last);
  for (auto vertex = static_cast<std::size_t>(in.first); vertex < last; ++vertex) {
    const float* weights = in.weights + vertex * k_influences;
    const std::uint16_t* slots = in.slots + vertex * k_influences;
    float matrix[16];
    for (int i = 0; i < 16; ++i) {
      float sum = weights[0] * in.palette[std::size_t{16} * slots[0] + i];
      for (int k = 1; k < k_influences; ++k) sum += weights[k] * in.palette[std::size_t{16} * slots[k] + i];
      matrix[i] = sum;
    }
    const auto rotated = [&matrix](const float* v, int row) {
      return (matrix[row] * v[0] + matrix[4 + row] * v[1]) + matrix[8 + row] * v[2];
    };
    for (int row = 0; row < 3; ++row)
      in.positions_out[vertex * 3 + row] = rotated(in.positions + vertex * 3, row) + matrix[12 + row];
    if constexpr (k_with_normals) {
      const float* normal = in.normals + vertex * 3;
      const float x = rotated(normal, 0), y = rotated(normal, 1), z = rotated(normal, 2);
      const float squared = (x * x + y * y) + z * z, scale = 1.0f / std::sqrt(squared);
      const bool has_length = squared > k_least_squared_length;
      in.normals_out[vertex * 3] = has_length ? x * scale : 0.0f;
      in.normals_out[vertex * 3 + 1] = has_length ? y * scale : 1.0f;
      in.normals_out[vertex * 3 + 2] = has_length ? z * scale : 0.0f;
    }
  }
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using Four = hn::FixedTag<float, 4>; // one column: x, y, z, unused
using Column = hn::Vec<Four>;
constexpr Four k_four;

struct Matrix {
  Column x, y, z, translation;
};

/// sum_k w_k M_k for those of the 16 floats that begin at `offset` and fill one vector.
template <int k_influences, class D>
HWY_INLINE hn::Vec<D> blended(D d, const float* HWY_RESTRICT palette, const std::uint16_t* HWY_RESTRICT slots,
                              const float* HWY_RESTRICT weights, std::size_t offset) {
  const auto term = [&](int k) HWY_ATTR {
    return hn::Mul(hn::Set(d, weights[k]), hn::Load(d, palette + std::size_t{16} * slots[k] + offset));
  };
  hn::Vec<D> sum = term(0);
  for (int k = 1; k < k_influences; ++k) sum = hn::Add(sum, term(k));
  return sum;
}

/// The blended matrix in as few vectors as the target allows: one of 16 floats, two of 8 or four of 4.
template <int k_influences, class D>
HWY_INLINE Matrix blended_matrix(D d, const float* HWY_RESTRICT palette, const std::uint16_t* HWY_RESTRICT slots,
                                 const float* HWY_RESTRICT weights) {
  if constexpr (hn::MaxLanes(D()) >= 16) {
    const hn::Half<D> eight;
    const auto all = blended<k_influences>(d, palette, slots, weights, 0);
    const auto low = hn::LowerHalf(eight, all), high = hn::UpperHalf(eight, all);
    return {hn::LowerHalf(k_four, low), hn::UpperHalf(k_four, low), hn::LowerHalf(k_four, high),
            hn::UpperHalf(k_four, high)};
  } else if constexpr (hn::MaxLanes(D()) >= 8) {
    const auto low = blended<k_influences>(d, palette, slots, weights, 0);
    const auto high = blended<k_influences>(d, palette, slots, weights, 8);
    return {hn::LowerHalf(k_four, low), hn::UpperHalf(k_four, low), hn::LowerHalf(k_four, high),
            hn::UpperHalf(k_four, high)};
  } else {
    return {blended<k_influences>(d, palette, slots, weights, 0), blended<k_influences>(d, palette, slots, weights, 4),
            blended<k_influences>(d, palette, slots, weights, 8),
            blended<k_influences>(d, palette, slots, weights, 12)};
  }
}

HWY_INLINE Column rotated(const Matrix& matrix, const float* HWY_RESTRICT v) {
  return hn::Add(hn::Add(hn::Mul(matrix.x, hn::Set(k_four, v[0])), hn::Mul(matrix.y, hn::Set(k_four, v[1]))),
                 hn::Mul(matrix.z, hn::Set(k_four, v[2])));
}

/// 12 bytes, not one more.
HWY_INLINE void store_three(Column v, float* HWY_RESTRICT out) {
  const hn::FixedTag<float, 2> two;
  hn::StoreU(hn::LowerHalf(two, v), two, out);
  hn::StoreU(hn::LowerHalf(hn::FixedTag<float, 1>(), hn::UpperHalf(two, v)), hn::FixedTag<float, 1>(), out + 2);
}

/// Four triples, 48 bytes: each store but the last spills into the place the next one overwrites.
HWY_INLINE void store_twelve(Column a, Column b, Column c, Column d, float* HWY_RESTRICT out) {
  hn::StoreU(a, k_four, out);
  hn::StoreU(b, k_four, out + 3);
  hn::StoreU(c, k_four, out + 6);
  store_three(d, out + 9);
}

/// Normalises four vectors at once: one square root and one division. A vector without length becomes +Y.
HWY_INLINE void normalise(Column& a, Column& b, Column& c, Column& d) {
  const Column aa = hn::Mul(a, a), bb = hn::Mul(b, b), cc = hn::Mul(c, c), dd = hn::Mul(d, d);
  const Column ac_xy = hn::InterleaveLower(k_four, aa, cc), bd_xy = hn::InterleaveLower(k_four, bb, dd);
  const Column ac_z = hn::InterleaveUpper(k_four, aa, cc), bd_z = hn::InterleaveUpper(k_four, bb, dd);
  const Column xx = hn::InterleaveLower(k_four, ac_xy, bd_xy), yy = hn::InterleaveUpper(k_four, ac_xy, bd_xy);
  const Column zz = hn::InterleaveLower(k_four, ac_z, bd_z);
  const Column squared = hn::Add(hn::Add(xx, yy), zz);
  const Column scale = hn::Div(hn::Set(k_four, 1.0f), hn::Sqrt(squared));
  a = hn::Mul(a, hn::Broadcast<0>(scale));
  b = hn::Mul(b, hn::Broadcast<1>(scale));
  c = hn::Mul(c, hn::Broadcast<2>(scale));
  d = hn::Mul(d, hn::Broadcast<3>(scale));

  const auto has_length = hn::Gt(squared, hn::Set(k_four, k_least_squared_length));
  if (HWY_LIKELY(hn::AllTrue(k_four, has_length))) return;
  const float up[4] = {0.0f, 1.0f, 0.0f, 0.0f};
  const Column y = hn::LoadU(k_four, up);
  const Column good = hn::IfThenElseZero(has_length, hn::Set(k_four, 1.0f));
  const auto unless = [&](Column keep, Column v)
                          HWY_ATTR { return hn::IfThenElse(hn::Gt(keep, hn::Zero(k_four)), v, y); };
  a = unless(hn::Broadcast<0>(good), a);
  b = unless(hn::Broadcast<1>(good), b);
  c = unless(hn::Broadcast<2>(good), c);
  d = unless(hn::Broadcast<3>(good), d);
}

template <int k_influences, bool k_with_normals>
HWY_INLINE void skin_one(const SkinKernelArguments& in, std::size_t vertex, Column& position, Column& normal) {
  const Matrix matrix = blended_matrix<k_influences>(
      hn::CappedTag<float, 16>(), in.palette, in.slots + vertex * k_influences, in.weights + vertex * k_influences);
  position = hn::Add(rotated(matrix, in.positions + vertex * 3), matrix.translation);
  if constexpr (k_with_normals) normal = rotated(matrix, in.normals + vertex * 3);
}

template <int k_influences, bool k_with_normals> void skin_range(const SkinKernelArguments& in) {
  const auto last = static_cast<std::size_t>(in.last);
  auto vertex = static_cast<std::size_t>(in.first);
  Column p0 = hn::Zero(k_four), p1 = p0, p2 = p0, p3 = p0, n0 = p0, n1 = p0, n2 = p0, n3 = p0;
  for (; vertex + 4 <= last; vertex += 4) {
    skin_one<k_influences, k_with_normals>(in, vertex, p0, n0);
    skin_one<k_influences, k_with_normals>(in, vertex + 1, p1, n1);
    skin_one<k_influences, k_with_normals>(in, vertex + 2, p2, n2);
    skin_one<k_influences, k_with_normals>(in, vertex + 3, p3, n3);
    store_twelve(p0, p1, p2, p3, in.positions_out + vertex * 3);
    if constexpr (k_with_normals) {
      normalise(n0, n1, n2, n3);
      store_twelve(n0, n1, n2, n3, in.normals_out + vertex * 3);
    }
  }
  for (; vertex < last; ++vertex) {
    skin_one<k_influences, k_with_normals>(in, vertex, p0, n0);
    store_three(p0, in.positions_out + vertex * 3);
    if constexpr (k_with_normals) {
      n1 = n2 = n3 = n0;
      normalise(n0, n1, n2, n3);
      store_three(n0, in.normals_out + vertex * 3);
    }
  }
}

#endif

void skin(const SkinKernelArguments& arguments) {
  const bool with_normals = arguments.normals_out != nullptr;
  if (arguments.influences == 4) with_normals ? skin_range<4, true>(arguments) : skin_range<4, false>(arguments);
  else with_normals ? skin_range<8, true>(arguments) : skin_range<8, false>(arguments);
}

const char* target() { return hwy::TargetName(HWY_TARGET); }

} // namespace tutu::rig::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tutu::rig {

HWY_EXPORT(skin);
HWY_EXPORT(target);

void skin_kernel(const SkinKernelArguments& arguments) { HWY_DYNAMIC_DISPATCH(skin)(arguments); }

const char* skin_kernel_target() { return HWY_DYNAMIC_DISPATCH(target)(); }

} // namespace tutu::rig
#endif
