#include "cloth/woven/kernel.h"

// Compiled once for each of Highway's targets. No Eigen here: its layout depends on the vector flags, and these differ.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cloth/woven/kernel.cpp"
#include <hwy/foreach_target.h>

#include "cloth/woven/air_inl.h"
#include "cloth/woven/constraints_inl.h"
#include "cloth/woven/contact_inl.h"
#include "cloth/woven/motion_inl.h"

HWY_BEFORE_NAMESPACE();
namespace tutu::cloth::HWY_NAMESPACE {

template <class T> void fetch(const WovenSheetView<T>& sheet) {
  for (T* const* field : {sheet.x, sheet.was}) {
    if (has_short_lanes(sheet)) fetch_short(sheet, field);
    fetch_halo(sheet, field, 0);
  }
}
template <class T> void give_back(const WovenSheetView<T>& sheet) {
  return_halo(sheet, sheet.x, 0);
  if (!has_short_lanes(sheet)) return;
  return_short(sheet, sheet.x);
  rest_short(sheet);
}

template <class T> WovenKernel<T> kernel() {
  return {
      hwy::TargetName(HWY_TARGET), &air<T>,           &predict<T>,       &constraints<T>,   &constraints_to_break<T>,
      &predict_again<T>,           &farthest<T>,      &finish<false, T>, &finish<true, T>,  &bounds<T>,
      &contact_capsule<T>,         &contact_plane<T>, &fetch<T>,         &contact_cells<T>, &give_back<T>};
}

WovenKernel<float> single_kernel() { return kernel<float>(); }
WovenKernel<double> double_kernel() { return kernel<double>(); }

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tutu::cloth {

HWY_EXPORT(single_kernel);
HWY_EXPORT(double_kernel);

template <> WovenKernel<float> woven_kernel<float>() { return HWY_DYNAMIC_DISPATCH(single_kernel)(); }
template <> WovenKernel<double> woven_kernel<double>() { return HWY_DYNAMIC_DISPATCH(double_kernel)(); }

} // namespace tutu::cloth
#endif
