// The inner loop of skinning on plain arrays: what skin.cpp hands to the code that is compiled once for each SIMD
// target.
#pragma once

#include <cstdint>

namespace tutu::rig {

/// All arrays are packed: 3 floats a position or normal, 16 floats a palette matrix (columns x, y, z, translation of
/// 4).
struct SkinKernelArguments {
  const float* positions;     ///< bind pose, model space, m
  const float* normals;       ///< bind pose, unit; unused without normals_out
  const std::uint16_t* slots; ///< [vertex * influences + k]
  const float* weights;       ///< [vertex * influences + k]
  const float* palette;       ///< 16 floats a slot, aligned to 64 bytes
  int influences;             ///< 4 or 8
  int first, last;            ///< vertices first..last-1 are read and written, nothing beyond
  float* positions_out;
  float* normals_out; ///< may be null
};

/// Every target computes each vertex by the same operations in the same order, none of them fused: the result has the
/// same bits on every processor, and does not depend on where a range begins.
void skin_kernel(const SkinKernelArguments& arguments);

/// The SIMD target that skin_kernel runs on here, as Highway calls it: "AVX2", say.
const char* skin_kernel_target();

} // namespace tutu::rig
