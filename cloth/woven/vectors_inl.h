// Rows of a woven sheet as vectors of the target: tags, three-dimensional vectors, loops over rows, the halo. For
// kernel.cpp alone, which compiles it once for each target.
#if defined(TUTU_CLOTH_WOVEN_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TUTU_CLOTH_WOVEN_VECTORS_INL_H
#undef TUTU_CLOTH_WOVEN_VECTORS_INL_H
#else
#define TUTU_CLOTH_WOVEN_VECTORS_INL_H
#endif

#include "cloth/woven/kernel.h"

#include <algorithm>
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

template <class T> HWY_INLINE Wide3<T> cross(const Wide3<T>& a, const Wide3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
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

/// Length of an edge, above 0.
template <class T> HWY_INLINE Wide<T> length_of(const Wide3<T>& d) {
  // Far below any rest length, and its square is still a normal number.
  constexpr T k_least_squared = T(1e-30);
  return hn::Sqrt(dot(d, d) + set(k_least_squared)); // a sum and no maximum, which forgets what is no number
}

// ---- the ring's end

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

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
