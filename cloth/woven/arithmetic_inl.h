// The closed forms, Coulomb's law and the air on vectors of the target. For kernel.cpp alone.
#if defined(TUTU_CLOTH_WOVEN_ARITHMETIC_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TUTU_CLOTH_WOVEN_ARITHMETIC_INL_H
#undef TUTU_CLOTH_WOVEN_ARITHMETIC_INL_H
#else
#define TUTU_CLOTH_WOVEN_ARITHMETIC_INL_H
#endif

#include "cloth/woven/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace tutu::cloth::HWY_NAMESPACE {

/// What proxies/distance/closed_forms_inl.h asks of an arithmetic. Products are fused with sums where the target can.
template <class T> struct WideArithmetic {
  using Real = Wide<T>;
  using Vector = Wide3<T>;
  static constexpr double k_share = sizeof(T) == sizeof(float) ? 1e-6 : 1e-12; ///< above the rounding of a square
  static constexpr double k_least_square = 1e-30, k_steep = k_share, k_parallel = k_share;
  static constexpr bool k_one_lane = false;

  static HWY_INLINE Real set(double x) { return HWY_NAMESPACE::set(static_cast<T>(x)); }
  static HWY_INLINE Real min(Real x, Real y) { return hn::Min(x, y); }
  static HWY_INLINE Real max(Real x, Real y) { return hn::Max(x, y); }
  static HWY_INLINE Real abs(Real x) { return hn::Abs(x); }
  static HWY_INLINE Real sqrt(Real x) { return hn::Sqrt(x); }
  template <class Mask> static HWY_INLINE Real select(Mask which, Real x, Real y) {
    return hn::IfThenElse(which, x, y);
  }
  static HWY_INLINE Real dot(const Vector& v, const Vector& w) { return HWY_NAMESPACE::dot(v, w); }
  static HWY_INLINE Vector cross(const Vector& v, const Vector& w) { return HWY_NAMESPACE::cross(v, w); }
  static HWY_INLINE Real length(const Vector& v) { return length_of<T>(v); }
  static HWY_INLINE Vector plus_times(const Vector& v, Real s, const Vector& w) {
    return HWY_NAMESPACE::plus_times<T>(v, s, w);
  }
  static HWY_INLINE Vector minus_times(const Vector& v, Real s, const Vector& w) {
    return HWY_NAMESPACE::minus_times<T>(v, s, w);
  }
};

#include "cloth/air/air_inl.h"
#include "cloth/contact/coulomb_inl.h"
#include "proxies/distance/closed_forms_inl.h"

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
