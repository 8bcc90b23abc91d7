// The air on the cells of a woven sheet. For kernel.cpp alone.
#if defined(TUTU_CLOTH_WOVEN_AIR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TUTU_CLOTH_WOVEN_AIR_INL_H
#undef TUTU_CLOTH_WOVEN_AIR_INL_H
#else
#define TUTU_CLOTH_WOVEN_AIR_INL_H
#endif

#include "cloth/woven/arithmetic_inl.h"

HWY_BEFORE_NAMESPACE();
namespace tutu::cloth::HWY_NAMESPACE {

/// A corner of a cell as the air meets it.
template <class T> struct Slowed {
  Wide3<T> x, v;
  Wide<T> w;
};

template <class T> HWY_INLINE Slowed<T> slowed(const WovenSheetView<T>& sheet, int block, int row, int lane) {
  const std::ptrdiff_t at = place(sheet, block, row) + lane;
  return {load(sheet.x, at), load(sheet.v, at), load(row_of(sheet.inverse_mass, block, row) + lane)};
}

/// Both triangles of the cells between a block and the next, row by row. A vector of cells shares its lower corners
/// with those below, which stay in registers.
template <class T> void slow_cells(const WovenSheetView<T>& sheet, int block, const AirInStep<WideArithmetic<T>>& air) {
  const Tag<T> tag;
  const auto real = set(T(0.5 * k_no_constraint)), cells = set(static_cast<T>(lanes_in(sheet, block)));
  const auto width = static_cast<int>(hn::Lanes(tag));
  for (int lane = 0; lane < lanes_in(sheet, block); lane += width) {
    const auto has_column = hn::Iota(tag, lane) < cells; // what lies beyond depends on the target
    Slowed<T> a = slowed(sheet, block, 0, lane), b = slowed(sheet, block + 1, 0, lane);
    for (int row = 0; row + 1 < sheet.rows; ++row) {
      Slowed<T> d = slowed(sheet, block, row + 1, lane), e = slowed(sheet, block + 1, row + 1, lane);
      const auto exists = hn::And(has_column, load(row_of(sheet.weft.compliance, block, row) + lane) < real);
      const AirInStep<WideArithmetic<T>> here = {hn::IfThenElseZero(exists, air.pressure),
                                                 hn::IfThenElseZero(exists, air.lift),
                                                 hn::IfThenElseZero(exists, air.friction), air.wind};
      slow_triangle(here, a.x, d.x, b.x, a.v, d.v, b.v, a.w, d.w, b.w);
      slow_triangle(here, e.x, b.x, d.x, e.v, b.v, d.v, e.w, b.w, d.w);
      store(a.v, sheet.v, place(sheet, block, row) + lane);
      store(b.v, sheet.v, place(sheet, block + 1, row) + lane);
      a = d;
      b = e;
    }
    store(a.v, sheet.v, place(sheet, block, sheet.rows - 1) + lane);
    store(b.v, sheet.v, place(sheet, block + 1, sheet.rows - 1) + lane);
  }
}

template <class T> void air(const WovenSheetView<T>& sheet, const WovenAir<T>& step) {
  const AirInStep<WideArithmetic<T>> wide = {set(step.pressure), set(step.lift), set(step.friction), set3(step.wind)};
  const bool is_uneven = has_short_lanes(sheet);
  const int last = sheet.blocks - 1;
  for (int block = 0; block < last - is_uneven; ++block) slow_cells(sheet, block, wide);
  for (T* const* field : {sheet.x, sheet.v}) {
    if (is_uneven) fetch_short(sheet, field);
    fetch_halo(sheet, field, 0);
  }
  if (is_uneven) slow_cells(sheet, last - 1, wide);
  slow_cells(sheet, last, wide);
  return_halo(sheet, sheet.v, 0);
  if (!is_uneven) return;
  return_short(sheet, sheet.v);
  rest_short(sheet);
}

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
