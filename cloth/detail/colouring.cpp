#include "cloth/detail/colouring.h"

#include <algorithm>

namespace tutu::cloth {

Colouring colour(std::span<const int> elements, int arity, int particle_count) {
  const int count = static_cast<int>(elements.size()) / arity;
  std::vector<int> colour_of(count, 0);
  std::vector<std::vector<bool>> taken(particle_count); // [particle][colour]
  int colours = 0;
  for (int e = 0; e < count; ++e) {
    const auto particles = elements.subspan(static_cast<std::size_t>(e) * arity, arity);
    const auto is_free = [&](int c) {
      return std::none_of(particles.begin(), particles.end(),
                          [&](int p) { return c < static_cast<int>(taken[p].size()) && taken[p][c]; });
    };
    int chosen = 0;
    while (!is_free(chosen)) ++chosen;
    for (const int p : particles) {
      if (chosen >= static_cast<int>(taken[p].size())) taken[p].resize(chosen + 1, false);
      taken[p][chosen] = true;
    }
    colour_of[e] = chosen;
    colours = std::max(colours, chosen + 1);
  }
  Colouring result;
  result.begin.assign(colours + 1, 0);
  for (const int c : colour_of) ++result.begin[c + 1];
  for (int c = 0; c < colours; ++c) result.begin[c + 1] += result.begin[c];
  result.order.resize(count);
  std::vector<int> next = result.begin;
  for (int e = 0; e < count; ++e) result.order[next[colour_of[e]]++] = e;
  return result;
}

} // namespace tutu::cloth
