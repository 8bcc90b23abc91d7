// One posed proxy fitted to the skin it is nearest to, while all others stay.
#pragma once

#include "src/view/proxy_edit/proxy_figures.h"

namespace tutu::app {

/// Sum over the skin of area * d^2, d the signed distance from the union of the shapes, m4.
double skin_cost(std::span<const SkinSpot> spots, std::span<const proxies::Capsule> shapes);

/// shapes[one], changed so that skin_cost of all shapes is less, or as it was: Levenberg-Marquardt on ends and radius,
/// or both radii where it has two, in which each step is kept only when the cost falls. A sphere (a == b) stays one.
/// Derivatives as in proxies/fit_refine.h. Radii stay at k_least_radius or above.
proxies::Capsule fit_one(std::span<const SkinSpot> spots, std::span<const proxies::Capsule> shapes, int one,
                         bool sphere);

} // namespace tutu::app
