#include "src/study/plan/plan_search.h"

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
    for (int round = 0; round < k_rounds; ++round) {
      levels_ = own_;
      result_.trials.clear();
      descend();
      if (!is_good(levels_) || verified(levels_) || result_.interrupted) break;
    }
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
  /// Searches, each knowing that the last one's result is wrong. What has been measured is not measured again.
  static constexpr int k_rounds = 4;

  void descend() {
    make_good();
    if (is_good(levels_))
      for (std::size_t axis = 0; axis < axes_.size(); ++axis) make_cheaper(axis);
  }

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
    if (!measured(levels) || !seen_.at(levels).good()) return false;
    if (verified_.contains(levels)) return true;
    if (!go_on()) return false;
    const double excess = measurer_->verify(levels);
    if (!go_on()) return false;
    PlanFigures& seen = seen_[levels];
    seen.excess = std::max(seen.excess, excess);
    verified_.insert(levels);
    return seen.good();
  }

  double ratio_of(const PlanLevels& levels, const PlanLevels& other) {
    const auto found = ratios_.find({levels, other});
    if (found != ratios_.end()) return found->second;
    return ratios_[{levels, other}] = measurer_->cost_ratio(levels, other);
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

  /// More exact: by what helps if that is enough, else each time on the axis that helps the most, until it is good or
  /// nothing helps.
  void make_good() {
    if (is_good(levels_)) return;
    if (const auto helped = good_with_help(levels_, axes_.size())) {
      std::size_t axis = 0;
      while ((*helped)[axis] == levels_[axis]) ++axis;
      note(static_cast<int>(axis), *helped, seen_.at(*helped), PlanTrial::End::kept);
    }
    while (!is_good(levels_)) {
      if (!seen_.contains(levels_)) return;
      double least = seen_.at(levels_).excess;
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

  /// These levels, or more of what helps; nothing when that is not enough. `axis` itself does not help. First a level
  /// at a time while it gets less wrong; where that ends too soon (one error falls by this, another by that) all of it,
  /// then less while that is enough.
  std::optional<PlanLevels> good_with_help(const PlanLevels& without, std::size_t axis) {
    std::vector<std::size_t> helpers;
    for (std::size_t h = 0; h < axes_.size(); ++h)
      if (axes_[h].helps && h != axis) helpers.push_back(h);
    PlanLevels levels = without;
    auto now = measured(levels);
    while (now && !now->good()) {
      std::optional<PlanLevels> best;
      PlanFigures least = *now;
      for (const std::size_t h : helpers) {
        if (levels[h] + 1 >= axes_[h].values || least.good()) continue;
        const PlanLevels more = stepped(levels, h, 1);
        const auto figures = measured(more);
        if (!figures) return {};
        if (figures->excess >= least.excess) continue;
        best = more;
        least = *figures;
      }
      if (!best) break;
      levels = *best;
      now = least;
    }
    if (!now || now->good()) return now ? std::optional(levels) : std::nullopt;

    PlanLevels all = without;
    for (const std::size_t h : helpers) all[h] = axes_[h].values - 1;
    const auto with_all = measured(all);
    if (!with_all || !with_all->good()) return {};
    for (const std::size_t h : helpers)
      while (all[h] > without[h]) {
        const auto less = measured(stepped(all, h, -1));
        if (!less || !less->good()) break;
        --all[h];
      }
    return all;
  }

  void make_cheaper(std::size_t axis) {
    PlanLevels good = levels_;
    int lowest = 0;
    while (lowest < good[axis]) {
      PlanLevels candidate = levels_;
      candidate[axis] = (lowest + good[axis]) / 2;
      const auto helped = good_with_help(candidate, axis);
      if (result_.interrupted) return;
      if (helped) {
        good = *helped;
      } else {
        note(static_cast<int>(axis), candidate, seen_.at(candidate), PlanTrial::End::not_good);
        lowest = candidate[axis] + 1;
      }
    }
    if (good == levels_ || !go_on()) return;
    const double ratio = ratio_of(good, levels_);
    if (!go_on()) return;
    const bool cheaper = axes_[axis].counts || ratio < 1.0 - k_least_saving;
    note(static_cast<int>(axis), good, seen_.at(good), cheaper ? PlanTrial::End::kept : PlanTrial::End::not_cheaper,
         ratio);
  }

  /// Makes what does not hold when it is verified more exact: by one level that is enough, of what helps if there is
  /// one, else of what was made cheaper, else of all of that.
  void mend() {
    const auto enough = [&](std::size_t axis) {
      const PlanLevels more = stepped(levels_, axis, 1);
      if (more[axis] >= axes_[axis].values || !verified(more)) return false;
      note(static_cast<int>(axis), more, seen_.at(more), PlanTrial::End::kept);
      return true;
    };
    while (is_good(levels_) && !verified(levels_) && !result_.interrupted) {
      for (std::size_t axis = 0; axis < axes_.size(); ++axis)
        if (axes_[axis].helps && enough(axis)) return;
      bool reduced = false;
      for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        if (levels_[axis] >= own_[axis]) continue;
        reduced = true;
        if (enough(axis)) return;
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
  std::map<std::pair<PlanLevels, PlanLevels>, double> ratios_;
  PlanResult result_;
};

} // namespace

PlanResult find_plan(std::span<const PlanAxis> axes, const PlanMeasurer& measurer, std::optional<double> budget_ms) {
  return Search(axes, measurer).run(budget_ms);
}

} // namespace tutu::app
