// Ways to take a unit apart, each tried on the points it owns.
#pragma once

#include "proxies/fit/detail/refine.h"
#include "proxies/fit/detail/start.h"

namespace tutu::proxies::fit {

/// What is nearest to one unit: its points, folded, and its lanes as blocks of their own.
struct Ownership {
  std::vector<UnitPoint> points; ///< one each, whatever the number of poses
  PointBlocks blocks;            ///< at most about k_most_lanes lanes, evenly taken, weights made up for it
  double cost = 0.0;             ///< of those lanes, and the unit's guard
};
Ownership owned_by(int unit, const Problem& problem, const FitPoints& points, std::span<const Unit> units,
                   const PosedShapes& shapes, const Nearest& nearest, int most_lanes);

/// Units in place of one.
struct Split {
  std::vector<Unit> units;
  int added = 0;     ///< shapes more than before
  double gain = 0.0; ///< of the cost, on the points of the unit
};

/// The best ways that add 0, 1 and 2 shapes (index), refined alone; those that gain nothing have no units.
std::array<Split, 3> best_splits(const Problem& problem, const Unit& unit, const Ownership& own);

} // namespace tutu::proxies::fit
