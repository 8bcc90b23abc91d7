#include "proxies/fit/detail/search.h"

#include <algorithm>
#include <cmath>

namespace tutu::proxies::fit {
namespace {

constexpr int k_split_lanes = 1000;      // on which splits are tried: more gain nothing
constexpr double k_changed = 0.10;       // of a unit's cost: its splits are looked for again
constexpr double k_worth_keeping = 1e-3; // of the cost, that a round of swaps must gain
constexpr int k_settling = 2;            // refinement steps after each change of the layout

} // namespace

Search::Search(const FitPoints& points, const BodyMotion& motion, const Guard& guard, const Cost& cost,
               std::function<bool()> keep_going)
    : points_(&points), motion_(&motion), guard_(&guard), cost_weights_(cost), keep_going_(std::move(keep_going)) {}

void Search::start(std::vector<Unit> units) {
  units_ = std::move(units);
  known_.assign(units_.size(), {});
  look();
}

void Search::look(bool second) { cost_ = cost_of(problem(), units_, shapes_, nearest_, second); }

void Search::set_cost(const Cost& cost) {
  cost_weights_ = cost;
  known_.assign(units_.size(), {});
  look();
}

void Search::refine(int iterations) {
  fit::refine(problem(), units_, iterations);
  look();
}

void Search::replace(int unit, const std::vector<Unit>& by) {
  units_.erase(units_.begin() + unit);
  known_.erase(known_.begin() + unit);
  units_.insert(units_.begin() + unit, by.begin(), by.end());
  known_.insert(known_.begin() + unit, by.size(), {});
}

void Search::update_splits() {
  for (int u = 0; u < static_cast<int>(units_.size()) && keep_going_(); ++u) {
    const Ownership own = owned_by(u, problem(), *points_, units_, shapes_, nearest_, k_split_lanes);
    Known& known = known_[u];
    if (known.cost >= 0.0 && std::abs(own.cost - known.cost) <= k_changed * known.cost) continue;
    known.splits = best_splits(problem(), units_[u], own);
    known.cost = own.cost;
  }
}

bool Search::grow(int room) {
  update_splits();
  int best = -1, way = 0;
  double gain = 0.0;
  for (int u = 0; u < static_cast<int>(units_.size()); ++u)
    for (int added = 0; added <= std::min(room, 2); ++added) {
      const Split& split = known_[u].splits[added];
      if (split.units.empty()) continue;
      // A change of kind costs no shape, and little to be tried.
      const double rate =
          added == 0 ? (split.gain > 0.05 * known_[u].cost ? 4.0 * split.gain : 0.0) : split.gain / added;
      if (rate > gain) gain = rate, best = u, way = added;
    }
  if (best < 0) return false;
  const std::vector<Unit> by = known_[best].splits[way].units;
  replace(best, by);
  refine(k_settling);
  return true;
}

bool Search::shrink(int most) {
  look(true);
  std::vector<double> loss(units_.size(), 0.0);
  for (std::size_t i = 0; i < nearest_.distance.size(); ++i) {
    const double weight = static_cast<double>(points_->blocks.weight[i]);
    if (!(weight > 0.0)) continue;
    const double then = std::min(static_cast<double>(nearest_.second_distance[i]), 1.0);
    loss[shapes_.unit[nearest_.shape[i]]] +=
        weight * (cost_weights_.of(then) - cost_weights_.of(static_cast<double>(nearest_.distance[i])));
  }
  int best = -1;
  for (int u = 0; u < static_cast<int>(units_.size()); ++u) {
    loss[u] = (loss[u] - guard_->cost(units_[u], *motion_, cost_weights_.guard, nullptr, nullptr)) / units_[u].shapes();
    if (units_[u].shapes() <= most && (best < 0 || loss[u] < loss[best])) best = u;
  }
  if (best < 0 || units_.size() < 2) return false;
  replace(best, {});
  refine(k_settling);
  return true;
}

void Search::update_skins() {
  std::vector<Unit> before = units_;
  const double cost_before = cost_;
  for (int u = 0; u < static_cast<int>(units_.size()); ++u) {
    const Ownership own = owned_by(u, problem(), *points_, units_, shapes_, nearest_, k_split_lanes);
    if (own.points.empty()) continue;
    std::vector<Unit> alone = {units_[u]};
    take_skins(alone[0], own.points, *motion_);
    if (alone[0].skin_a == units_[u].skin_a && alone[0].skin_b == units_[u].skin_b) continue;
    alone[0].settle(*motion_);
    const Problem local{own.blocks, *motion_, *guard_, cost_weights_};
    PosedShapes shapes;
    Nearest nearest;
    if (cost_of(local, alone, shapes, nearest) < own.cost) units_[u] = alone[0];
  }
  look();
  if (cost_ < cost_before) return;
  units_ = std::move(before);
  look();
}

void Search::polish(int rounds, int iterations, const std::function<void(double)>& done) {
  const int count = shape_count();
  update_skins();
  refine(iterations);
  int fruitless = 0;
  for (int round = 0; round < rounds && fruitless < 3 && keep_going_(); ++round) {
    done(static_cast<double>(round) / rounds);
    const std::vector<Unit> units = units_;
    const std::vector<Known> known = known_;
    const double cost = cost_;
    const int fewer = 2 + 2 * (round % 2);
    while (shape_count() > count - fewer && shrink(2)) {
    }
    int guard = 0;
    while (shape_count() < count && keep_going_() && ++guard < 20)
      if (!grow(count - shape_count())) break;
    update_skins();
    refine(k_settling + 2);
    if (shape_count() == count && cost_ < (1.0 - k_worth_keeping) * cost) {
      fruitless = 0;
      continue;
    }
    ++fruitless;
    units_ = units;
    known_ = known;
    look();
  }
  update_skins();
  refine(iterations);
}

} // namespace tutu::proxies::fit
