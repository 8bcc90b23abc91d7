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

template <class T> HWY_INLINE Wide3<T> choose(hn::Mask<Tag<T>> which, const Wide3<T>& yes, const Wide3<T>& no) {
  return {hn::IfThenElse(which, yes.x, no.x), hn::IfThenElse(which, yes.y, no.y), hn::IfThenElse(which, yes.z, no.z)};
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

/// Calls f(element, row, lane) for each vector of every `stride`-th of the rows first..last-1 of a block: element
/// counts from the field's start.
template <class T, class F>
HWY_INLINE void for_rows(const WovenSheetView<T>& sheet, int block, int first, int last, const F& f, int stride = 1) {
  const auto width = static_cast<int>(hn::Lanes(Tag<T>()));
  for (int row = first; row < last; row += stride)
    for (int lane = 0; lane < k_lanes; lane += width) f(place(sheet, block, row) + lane, row, lane);
}

/// The same but for vectors in whose lanes the block has no column. How many these are depends on the target: for what
/// such lanes have no say in.
template <class T, class F>
HWY_INLINE void for_columns(const WovenSheetView<T>& sheet, int block, int first, int last, const F& f,
                            int stride = 1) {
  const auto width = static_cast<int>(hn::Lanes(Tag<T>()));
  if (width == k_lanes || lanes_in(sheet, block) > k_lanes - width) {
    for_rows(sheet, block, first, last, f, stride); // a loop whose count the compiler knows
    return;
  }
  for (int row = first; row < last; row += stride)
    for (int lane = 0; lane < lanes_in(sheet, block); lane += width) f(place(sheet, block, row) + lane, row, lane);
}

/// A square that may be divided by.
template <class T> HWY_INLINE Wide<T> above_zero(Wide<T> squared) {
  // Far below that of any rest length, and still a normal number.
  constexpr T k_least_squared = T(1e-30);
  return squared + set(k_least_squared); // a sum and no maximum, which forgets what is no number
}
/// Length of an edge, above 0.
template <class T> HWY_INLINE Wide<T> length_of(const Wide3<T>& d) { return hn::Sqrt(above_zero<T>(dot(d, d))); }

// ---- the ring's end

/// Calls f(at, mask) for each vector of lanes first..last-1 in all rows of a block: `at` counts from its start.
template <class T, class F> HWY_INLINE void for_lanes(const WovenSheetView<T>& sheet, int first, int last, const F& f) {
  const Tag<T> tag;
  const auto width = static_cast<int>(hn::Lanes(tag));
  for (int lane = first / width * width; lane < last; lane += width) {
    const Wide<T> numbers = hn::Iota(tag, lane);
    const auto mask = hn::And(numbers >= set(static_cast<T>(first)), numbers < set(static_cast<T>(last)));
    const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(sheet.rows) * k_lanes;
    for (std::ptrdiff_t at = lane; at < count; at += k_lanes) f(at, mask);
  }
}

/// Lanes first..last-1 of a block become copies of those one lane on in block `source`.
template <class T>
void fetch_turned(const WovenSheetView<T>& sheet, T* const* field, int source, int block, int first, int last) {
  const Tag<T> tag;
  for (int axis = 0; axis < 3; ++axis) {
    const T* from = field[axis] + place(sheet, source, 0);
    T* to = field[axis] + place(sheet, block, 0);
    for_lanes(sheet, first, last, [&](std::ptrdiff_t at, auto mask) HWY_ATTR {
      hn::Store(hn::IfThenElse(mask, hn::LoadU(tag, from + at + 1), load(to + at)), tag, to + at);
    });
    if (last == sheet.lanes)
      for (int row = 0; row < sheet.rows; ++row) to[row * k_lanes + last - 1] = from[row * k_lanes];
  }
}

/// And back.
template <class T>
void return_turned(const WovenSheetView<T>& sheet, T* const* field, int source, int block, int first, int last) {
  const Tag<T> tag;
  for (int axis = 0; axis < 3; ++axis) {
    T* to = field[axis] + place(sheet, source, 0);
    const T* from = field[axis] + place(sheet, block, 0);
    for_lanes(sheet, first + 1, std::min(last + 1, sheet.lanes), [&](std::ptrdiff_t at, auto mask) HWY_ATTR {
      hn::Store(hn::IfThenElse(mask, hn::LoadU(tag, from + at - 1), load(to + at)), tag, to + at);
    });
    if (last == sheet.lanes)
      for (int row = 0; row < sheet.rows; ++row) to[row * k_lanes] = from[row * k_lanes + last - 1];
  }
}

/// Behind the ends of short lanes: the last block's places become copies of what comes next, (block 0, next lane).
template <class T> void fetch_short(const WovenSheetView<T>& sheet, T* const* field) {
  fetch_turned(sheet, field, 0, sheet.blocks - 1, sheet.long_lanes, sheet.lanes);
}
template <class T> void return_short(const WovenSheetView<T>& sheet, T* const* field) {
  return_turned(sheet, field, 0, sheet.blocks - 1, sheet.long_lanes, sheet.lanes);
}

/// Puts all of short lanes' places in a block to one point: no edge there is long, none pulls, nothing is bent. That is
/// how they pass through what only the long ones have.
template <class T> void clear_short(const WovenSheetView<T>& sheet, int block) {
  const Tag<T> tag;
  for (T* x : sheet.x) {
    T* to = x + place(sheet, block, 0);
    for_lanes(sheet, sheet.long_lanes, sheet.lanes, [&](std::ptrdiff_t at, auto mask) HWY_ATTR {
      hn::Store(hn::IfThenZeroElse(mask, load(to + at)), tag, to + at);
    });
  }
}

/// Their places in the last block, which hold no cloth, go where lane 0 is, and rest there.
template <class T> void rest_short(const WovenSheetView<T>& sheet) {
  const Tag<T> tag;
  for (int axis = 0; axis < 3; ++axis) {
    T* const x = sheet.x[axis] + place(sheet, sheet.blocks - 1, 0);
    T* const was = sheet.was[axis] + place(sheet, sheet.blocks - 1, 0);
    for_lanes(sheet, sheet.long_lanes, sheet.lanes, [&](std::ptrdiff_t at, auto mask) HWY_ATTR {
      const Wide<T> there = set(x[at / k_lanes * k_lanes]);
      hn::Store(hn::IfThenElse(mask, there, load(x + at)), tag, x + at);
      hn::Store(hn::IfThenElse(mask, there, load(was + at)), tag, was + at);
    });
  }
}

/// Halo `number` takes the lanes of block `number` turned by one; lanes without a column in the last block what that
/// holds, next to which nothing is too long.
template <class T> void fetch_halo(const WovenSheetView<T>& sheet, T* const* field, int number) {
  const auto width = static_cast<int>(hn::Lanes(Tag<T>()));
  for (int axis = 0; axis < 3; ++axis) {
    const T* from = field[axis] + place(sheet, number, 0);
    const T* last = field[axis] + place(sheet, sheet.blocks - 1, 0);
    T* to = field[axis] + place(sheet, sheet.blocks + number, 0);
    const int count = sheet.rows * k_lanes;
    if (sheet.long_lanes == k_lanes) {
      for (int k = 0; k < count; k += width) hn::Store(hn::LoadU(Tag<T>(), from + k + 1), Tag<T>(), to + k);
      for (int row = 0; row < count; row += k_lanes) to[row + k_lanes - 1] = from[row];
      continue;
    }
    for_lanes(sheet, 0, k_lanes,
              [&](std::ptrdiff_t at, auto) HWY_ATTR { hn::Store(load(last + at), Tag<T>(), to + at); });
  }
  if (sheet.long_lanes < k_lanes) fetch_turned(sheet, field, number, sheet.blocks + number, 0, sheet.long_lanes);
}

/// And back; lanes without a column there stay.
template <class T> void return_halo(const WovenSheetView<T>& sheet, T* const* field, int number) {
  if (sheet.long_lanes < k_lanes) {
    return_turned(sheet, field, number, sheet.blocks + number, 0, sheet.long_lanes);
    return;
  }
  const auto width = static_cast<int>(hn::Lanes(Tag<T>()));
  for (int axis = 0; axis < 3; ++axis) {
    T* to = field[axis] + place(sheet, number, 0);
    const T* from = field[axis] + place(sheet, sheet.blocks + number, 0);
    const int count = sheet.rows * k_lanes;
    // The last lane spills into the next row's first, or into the room behind the block; first lanes are set below.
    for (int k = 0; k < count; k += width) hn::StoreU(load(from + k), Tag<T>(), to + k + 1);
    for (int row = 0; row < count; row += k_lanes) to[row] = from[row + k_lanes - 1];
  }
}

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
