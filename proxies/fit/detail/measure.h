// What fit_measure.cpp shares with fit.cpp.
#pragma once

#include "proxies/fit/detail/model.h"

namespace tutu::proxies::fit {

/// Enabled proxies in each pose; each is a unit of its own.
PosedShapes place(std::span<const Proxy> proxies, const std::vector<std::vector<Transform>>& poses);

} // namespace tutu::proxies::fit
