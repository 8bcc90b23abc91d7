// Distances of points from posed shapes in single precision, for the search of a fit. No Eigen here: its layout depends
// on the vector flags.
#pragma once

#include <cstddef>

namespace tutu::proxies::fit {

/// Points a block.
inline constexpr int k_lanes = 16;

/// Capsules as structure of arrays, readable k_lanes beyond their end.
struct ShapeArrays {
  const float *ax, *ay, *az, *dx, *dy, *dz; ///< end a, and b - a
  const float* inverse_square;              ///< 1 / |d|^2; 0 for a ball
  const float *radius, *taper;              ///< at a, and what b adds
  const float* lean;                        ///< as CapsuleUnion has it; 0 without taper
};

/// Signed distances of one point from the shapes first .. first + count - 1. `out` has room up to a multiple of
/// k_lanes, where what is beyond count means nothing.
void distances_from_shapes(const ShapeArrays& shapes, std::size_t first, int count, float x, float y, float z,
                           float* out);

/// What is nearest to k_lanes points (x[0..], y, z) of the shapes first + candidates[0..count): signed distance, and
/// the candidate; the first of equals.
void nearest_of_block(const ShapeArrays& shapes, std::size_t first, const int* candidates, int count, const float* x,
                      const float* y, const float* z, float* distance, int* shape);

/// Signed distances of k_lanes points from one shape.
void distances_from_shape(const ShapeArrays& shapes, std::size_t shape, const float* x, const float* y, const float* z,
                          float* out);

} // namespace tutu::proxies::fit
