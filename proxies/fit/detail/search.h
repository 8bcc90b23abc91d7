// Which units there are: grows, shrinks and swaps them.
#pragma once

#include "proxies/fit/detail/split.h"

namespace tutu::proxies::fit {

/// A layout on its way to a number of shapes. What it was made from must outlive it.
class Search {
public:
  /// `keep_going` is asked now and then; once it says no, every function returns at its next good layout.
  Search(const FitPoints& points, const BodyMotion& motion, const Guard& guard, const Cost& cost,
         std::function<bool()> keep_going);

  void start(std::vector<Unit> units);
  /// Adds the split that gains most a shape, with at most `room` new shapes; false when none gains.
  bool grow(int room);
  /// Removes the unit of at most `most` shapes that loses least a shape; its points fall to their second nearest.
  bool shrink(int most);
  /// Rounds of removing a few shapes and growing back, kept where the cost falls; refines at the end.
  void polish(int rounds, int iterations, const std::function<void(double)>& done);
  void refine(int iterations);
  void set_cost(const Cost& cost);

  const std::vector<Unit>& units() const { return units_; }
  const Nearest& nearest() const { return nearest_; }
  const PosedShapes& shapes() const { return shapes_; }
  Problem problem() const { return {points_->blocks, *motion_, *guard_, cost_weights_}; }
  int shape_count() const { return shapes_.count; }
  double cost() const { return cost_; }

private:
  void look(bool second = false);
  void update_splits();
  void update_skins();
  void replace(int unit, const std::vector<Unit>& by);

  const FitPoints* points_;
  const BodyMotion* motion_;
  const Guard* guard_;
  Cost cost_weights_;
  std::function<bool()> keep_going_;
  std::vector<Unit> units_;
  double cost_ = 0.0;
  PosedShapes shapes_;
  Nearest nearest_;
  /// What is known of each unit: its best splits, and the cost it had when they were looked for.
  struct Known {
    std::array<Split, 3> splits;
    double cost = -1.0;
  };
  std::vector<Known> known_;
};

} // namespace tutu::proxies::fit
