// The search for the least model that is good enough: greedy, one choice at a time, over whatever can be measured.
//
//   own --if it is not good enough: more exact, a level at a time--> good enough --each axis cheaper--> least
//   --verify-->
//
// It knows no scene: models are levels on axes, and a measurer says what each costs and how wrong it is.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace tutu::app {

/// One kind of choice, its values in order: 0 the cheapest, the last the most exact.
struct PlanAxis {
  int values = 1;
  int own = 0; ///< where the search starts
  /// More of it costs little: what is not good in itself may be with some levels more of this.
  bool helps = false;
  /// Less of it is a lesser model, whether a clock can tell or not.
  bool counts = false;
};

/// One value on each axis.
using PlanLevels = std::vector<int>;

struct PlanFigures {
  double excess = std::numeric_limits<double>::infinity(); ///< the worst error over what is allowed of it; <= 1 is good
  double ms = 0.0;                                         ///< a frame

  bool good() const { return excess <= 1.0; }
};

/// How the search asks. Every function may take long; the search asks nothing twice.
struct PlanMeasurer {
  std::function<PlanFigures(const PlanLevels&)> measure; ///< quick, of one run
  std::function<double(const PlanLevels&)> verify;       ///< excess of several runs over everything
  /// Cost of the first over that of the second, measured side by side.
  std::function<double(const PlanLevels&, const PlanLevels&)> cost_ratio;
  std::function<bool()> go_on; ///< asked before each of these
};

/// What was tried, in the order it was tried.
struct PlanTrial {
  enum class End {
    kept,       ///< from here the search went on
    not_good,   ///< too wrong
    not_cheaper ///< good, but cost as much
  };
  int axis = 0;
  PlanLevels from, to;
  PlanFigures figures;              ///< of `to`
  std::optional<double> cost_ratio; ///< to over from; only where it was good and cheaper was asked for
  End end = End::not_good;
};

struct PlanResult {
  PlanLevels levels;        ///< the best that was found
  PlanFigures own;          ///< of the start
  double excess = 0.0;      ///< of `levels`: verified where it could be, else as measured
  double ms = 0.0;          ///< of `levels`
  bool good = false;        ///< verified, and not wrong by more than allowed
  bool in_budget = true;    ///< or no budget was given
  bool interrupted = false; ///< before it was verified; it is the best so far
  std::vector<PlanTrial> trials;
};

/// A change that saves less than this share is not worth a choice, and is near what a clock can tell.
inline constexpr double k_least_saving = 0.03;

/// Axes are tried in their order, each by bisection, with the axes that help: where a cheaper value is good all between
/// it and the own are taken to be. Where verifying finds the result wrong it searches again with that known;
/// what is wrong even then is mended by help, then by taking choices back. With a budget (ms a frame) that the least
/// good model exceeds, the most exact model within it is looked for instead. Never returns a model that is not good
/// when one that is (and is within the budget) was measured, unless verifying said otherwise.
PlanResult find_plan(std::span<const PlanAxis> axes, const PlanMeasurer& measurer, std::optional<double> budget_ms);

} // namespace tutu::app
