// A validation for machines and for a terminal.
#pragma once

#include "src/measure/validation.h"

#include <nlohmann/json.hpp>
#include <string>

namespace tutu::app {

/// What a stated tolerance is held against, on both sides.
enum class Judge {
  max, ///< the greatest error that any point could have (the bound)
  p99,
  p95
};
inline constexpr std::array<std::string_view, 3> k_judge_names = {"max", "p99", "p95"};

/// A tolerance and whether it is met.
struct Verdict {
  double tolerance = 0.0; ///< m
  Judge judge = Judge::max;
  bool in_reach = false;          ///< of what garments can reach only
  double under = 0.0, over = 0.0; ///< m, what was held against it

  bool met() const { return under <= tolerance && over <= tolerance; }
  std::string text() const; ///< one sentence
};

Verdict judge(const Validation& validation, double tolerance, Judge judge, bool in_reach);

/// `validate --json`. Lengths in mm where the name says so. `verdict`: where a tolerance was stated.
nlohmann::ordered_json validation_json(const Validation& validation, const Scene& scene,
                                       const std::optional<Verdict>& verdict);

/// The same for a person: some lines, the worst first.
std::string validation_text(const Validation& validation, const Scene& scene, const std::optional<Verdict>& verdict);

/// What cloth goes through, as a line of a table: "skirt, the body".
struct CrossingLine {
  std::string what;
  const CrossingTally* tally;
};

/// Of each garment body, proxies and itself; then garments with each other, where there are several. Of a validation
/// with cloth, which must outlive it.
std::vector<CrossingLine> crossing_lines(const Validation& validation, const Scene& scene);

/// Proxies that meet the mesh in no frame, by name.
std::vector<std::string> never_touching(const Validation& validation);

/// Indices into `groups`, the worst first: by the larger of the two p95, then of the two largest errors.
std::vector<int> worst_first(const std::vector<GroupErrors>& groups);

} // namespace tutu::app
