// What every backend refuses before it computes: non-finite numbers and solids without a radius.
// FCL answers such input with "far away", with -1, or by ending the process.
#pragma once

#include "proxies/shapes.h"

#include <optional>
#include <span>

namespace tutu::proxies {

/// Each throws std::invalid_argument with the offending values at full precision, so that the case can be pasted into a
/// test.
void require_usable(const Capsule& capsule, int index);
void require_usable(const std::optional<Plane>& ground);
void require_usable(const Vec3& point);
void require_usable(std::span<const Vec3> points, double reach);
void require_usable(std::span<const Box> boxes); ///< also refuses an empty box

} // namespace tutu::proxies
