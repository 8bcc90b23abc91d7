#include "src/plan/plan_search.h"

#include <algorithm>
#include <map>
#include <set>

namespace tutu::app {
namespace {

class Search {
public:
  Search(std::span<const PlanAxis> axes, const PlanMeasurer& measurer) : axes_(axes), measurer_(&measurer) {
    for (const PlanAxis& axis : axes) own_.push_back(axis.own);
    levels_ = own_;
  }

  PlanResult run(std::optional<double> budget) {
    if (const auto own = measured(own_)) result_.own = *own;
    make_good();
    if (is_good(levels_))
      for (std::size_t axis = 0; axis < axes_.size(); ++axis) make_cheaper(static_cast<int>(axis));
    mend();
    if (!is_good(levels_) && !result_.interrupted) { // it looked good and was not
      make_good();
      mend();
    }
    if (budget && !(is_good(levels_) && within(levels_, *budget))) fit_budget(*budget);
    choose(budget);
    return std::move(result_);
  }

private:
  bool go_on() {
    if (!result_.interrupted && !measurer_->go_on()) result_.interrupted = true;
    return !result_.interrupted;
  }

  /// Nothing after an interrupt.
  std::optional<PlanFigures> measured(const PlanLevels& levels) {
    if (const auto found = seen_.find(levels); found != seen_.end()) return found->second;
    if (!go_on()) return {};
    const PlanFigures figures = measurer_->measure(levels);
    if (!go_on()) return {}; // cut short
    return seen_[levels] = figures;
  }

  /// From then on the excess is what verifying found, where that is more.
  bool verified(const PlanLevels& levels) {
    const auto figures = measured(levels);
    if (!figures || !figures->good()) return false;
    if (verified_.contains(levels)) return true;
    if (!go_on()) return false;
    const double excess = measurer_->verify(levels);
    if (!go_on()) return false;
    PlanFigures& seen = seen_[levels];
    seen.excess = std::max(seen.excess, excess);
    verified_.insert(levels);
    return seen.good();
  }

  bool is_good(const PlanLevels& levels) const {
    const auto found = seen_.find(levels);
    return found != seen_.end() && found->second.good();
  }
  bool within(const PlanLevels& levels, double budget) const { return seen_.at(levels).ms <= budget; }

  void note(int axis, const PlanLevels& to, const PlanFigures& figures, PlanTrial::End end,
            std::optional<double> ratio = {}) {
    result_.trials.push_back({axis, levels_, to, figures, ratio, end});
    if (end == PlanTrial::End::kept) levels_ = to;
  }

  /// More exact, each time on the axis that helps the most, until it is good or nothing helps.
  void make_good() {
    while (!is_good(levels_)) {
      const auto now = seen_.find(levels_);
      if (now == seen_.end()) return;
      double least = now->second.excess;
      std::optional<int> best;
      for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        if (levels_[axis] + 1 >= axes_[axis].values) continue;
        const PlanLevels more = stepped(levels_, axis, 1);
        const auto figures = measured(more);
        if (!figures) return;
        if (figures->excess < least) {
          least = figures->excess;
          best = static_cast<int>(axis);
        } else {
          note(static_cast<int>(axis), more, *figures, PlanTrial::End::not_good);
        }
        if (figures->good()) break;
      }
      if (!best) return;
      const PlanLevels more = stepped(levels_, static_cast<std::size_t>(*best), 1);
      note(*best, more, seen_.at(more), PlanTrial::End::kept);
    }
  }

  void make_cheaper(int axis) {
    PlanLevels candidate = levels_;
    int lowest = 0, good = levels_[axis];
    while (lowest < good) {
      candidate[axis] = (lowest + good) / 2;
      const auto figures = measured(candidate);
      if (!figures) return;
      if (figures->good()) {
        good = candidate[axis];
      } else {
        note(axis, candidate, *figures, PlanTrial::End::not_good);
        lowest = candidate[axis] + 1;
      }
    }
    if (good == levels_[axis]) return;
    candidate[axis] = good;
    if (!go_on()) return;
    const double ratio = measurer_->cost_ratio(candidate, levels_);
    if (!go_on()) return;
    const bool cheaper = ratio < 1.0 - k_least_saving;
    note(axis, candidate, seen_.at(candidate), cheaper ? PlanTrial::End::kept : PlanTrial::End::not_cheaper, ratio);
  }

  /// Takes back what does not hold when it is verified: first the one level that is enough, else one on every axis.
  void mend() {
    while (is_good(levels_) && !verified(levels_) && !result_.interrupted) {
      bool reduced = false;
      for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        if (levels_[axis] >= own_[axis]) continue;
        reduced = true;
        const PlanLevels more = stepped(levels_, axis, 1);
        if (!verified(more)) continue;
        note(static_cast<int>(axis), more, seen_.at(more), PlanTrial::End::kept);
        return;
      }
      if (!reduced || result_.interrupted) return;
      for (std::size_t axis = 0; axis < axes_.size(); ++axis) levels_[axis] += levels_[axis] < own_[axis];
      if (!measured(levels_)) return;
    }
  }

  /// Cheaper a level at a time, each time where it does the least harm, until it is within the budget.
  void fit_budget(double budget) {
    while (seen_.contains(levels_) && !within(levels_, budget)) {
      std::optional<int> best;
      PlanFigures least;
      for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        if (levels_[axis] == 0) continue;
        const auto figures = measured(stepped(levels_, axis, -1));
        if (!figures) return;
        if (figures->ms >= seen_.at(levels_).ms) continue;
        if (best && figures->excess >= least.excess) continue;
        best = static_cast<int>(axis);
        least = *figures;
      }
      if (!best) return;
      note(*best, stepped(levels_, static_cast<std::size_t>(*best), -1), least, PlanTrial::End::kept);
    }
  }

  /// Among all that was measured: within the budget before not, good before not, then the one the search came to, then
  /// the least wrong. (Of good ones none is looked for that is cheaper: each was measured alone.)
  void choose(std::optional<double> budget) {
    const auto fits = [&](const PlanFigures& f) { return !budget || f.ms <= *budget; };
    const PlanFigures* best = nullptr;
    const auto better = [&](const PlanLevels& levels, const PlanFigures& f) {
      if (!best) return true;
      if (fits(f) != fits(*best)) return fits(f);
      if (f.good() != best->good()) return f.good();
      if (result_.levels == levels_ && best->good()) return false;
      return (levels == levels_ && f.good()) || f.excess < best->excess;
    };
    result_.levels = own_;
    for (const auto& [levels, figures] : seen_)
      if (better(levels, figures)) {
        best = &figures;
        result_.levels = levels;
      }
    if (!best) return; // interrupted before the first was measured
    // The one within the budget that others stand behind may not have been verified yet.
    if (best->good() && !verified_.contains(result_.levels) && !result_.interrupted && !verified(result_.levels) &&
        !result_.interrupted)
      return choose(budget);
    const PlanFigures& chosen = seen_.at(result_.levels);
    result_.excess = chosen.excess;
    result_.ms = chosen.ms;
    result_.good = chosen.good() && verified_.contains(result_.levels);
    result_.in_budget = fits(chosen);
  }

  static PlanLevels stepped(PlanLevels levels, std::size_t axis, int by) {
    levels[axis] += by;
    return levels;
  }

  std::span<const PlanAxis> axes_;
  const PlanMeasurer* measurer_;
  PlanLevels own_, levels_; ///< where it began, and where it is
  std::map<PlanLevels, PlanFigures> seen_;
  std::set<PlanLevels> verified_;
  PlanResult result_;
};

} // namespace

PlanResult find_plan(std::span<const PlanAxis> axes, const PlanMeasurer& measurer, std::optional<double> budget_ms) {
  return Search(axes, measurer).run(budget_ms);
}

} // namespace tutu::app
