// Starts that are not symmetric. Cloth that is pressed along its plane to the last bit stays in it, or leaves it where
// rounding and the order of a sweep push it: how it buckles would then be no property of the cloth.
#pragma once

#include "cloth/garment/garment.h"

#include <random>
#include <span>

namespace tutu::cloth {

/// m, of charts and benches: what decides between folds, and far below any error that matters.
inline constexpr double k_unevenness = 1e-4;

/// Moves each free particle by up to `most` (m) along each axis, evenly distributed. The generator alone decides: the
/// same on every machine. Rest lengths stay those of the even design: particles begin that much off, nothing is cut
/// uneven.
void make_uneven(const Garment& garment, double most, std::mt19937_64& random, std::span<Vec3> positions);

} // namespace tutu::cloth
