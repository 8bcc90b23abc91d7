// How a run on a map of stability ends.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tutu::app {

enum class Outcome : std::uint8_t {
  held,
  diverged,  ///< not finite, thrown out of the world, or an edge beyond the length at which a solver stops
  stretched, ///< at the end edges are longer than load and fabric explain
  tunnelled, ///< a collider went through the cloth, or is stuck in it
  unsettled  ///< at the end still in motion, or still inside a collider
};
inline constexpr std::size_t k_outcomes = 5;

/// In the order of Outcome: for files, for people, and a letter that a map's cell shows.
inline constexpr std::array<std::string_view, k_outcomes> k_outcome_names = {"held", "non_finite", "stretch",
                                                                             "tunnelled", "unsettled"};
inline constexpr std::array<std::string_view, k_outcomes> k_outcome_words = {"holds", "non-finite", "stretched",
                                                                             "tunnelled", "never settles"};
inline constexpr std::array<char, k_outcomes> k_outcome_letters = {' ', 'N', 'S', 'T', 'U'};

constexpr std::size_t index_of(Outcome outcome) { return static_cast<std::size_t>(outcome); }

} // namespace tutu::app
