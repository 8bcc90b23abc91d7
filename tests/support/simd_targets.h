// The vector widths that a kernel was compiled for, one at a time.
#pragma once

#include <cstdint>
#include <hwy/targets.h>
#include <vector>

namespace tutu::test {

/// Every target that was compiled and that this processor runs, best first.
inline std::vector<std::int64_t> simd_targets() {
  std::vector<std::int64_t> all;
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  for (int bit = 0; bit < 63; ++bit)
    if ((supported >> bit) & 1) all.push_back(std::int64_t{1} << bit);
  return all;
}

/// Targets that multiply and add in one rounding: all of x86 from AVX2 on.
inline bool fuses(std::int64_t target) {
  return (target & (HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL)) != 0 || (HWY_ARCH_X86 == 0 && target != HWY_EMU128);
}

/// Kernels dispatch to one target for as long as this lives.
struct OnTarget {
  explicit OnTarget(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~OnTarget() { hwy::SetSupportedTargetsForTest(0); }
};

} // namespace tutu::test
