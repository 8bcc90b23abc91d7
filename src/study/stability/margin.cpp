#include "src/study/stability/margin.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

/// Looks outwards from the own cell along one axis, both ways.
void look_along(const StabilityMap& map, bool along_x, Margin& margin) {
  const MapAxis& axis = along_x ? map.x : map.y;
  const std::size_t own = along_x ? margin.ix : margin.iy;
  for (std::size_t k = 0; k < axis.values.size(); ++k) {
    const MapCell& cell = along_x ? map.cell(k, margin.iy) : map.cell(margin.ix, k);
    if (k == own || cell.failed() == 0) continue;
    const double ratio = std::max(axis.values[k] / *axis.own, *axis.own / axis.values[k]);
    if (!margin.nearest || ratio < margin.nearest->ratio)
      margin.nearest = Margin::Nearest{along_x, axis.values[k], ratio, cell.worst()};
  }
}

std::string rounded(double number) {
  return number >= 1000.0 ? fmt::format("{:.0f}", number) : fmt::format("{:.3g}", number);
}

} // namespace

std::string in_words(const MapAxis& axis, double value) {
  return rounded(axis.scale * value) + (axis.unit.empty() ? "" : " ") + axis.unit;
}

std::optional<Margin> margin_of(const StabilityMap& map, double step) {
  if (!map.x.own || !map.y.own) return std::nullopt;
  const std::optional<double> x = map.x.place(*map.x.own), y = map.y.place(*map.y.own);
  if (!x || !y) return std::nullopt;
  Margin margin;
  margin.ix = static_cast<std::size_t>(std::max(0L, std::lround(*x)));
  margin.iy = static_cast<std::size_t>(std::max(0L, std::lround(*y)));
  const MapCell& own = map.cell(margin.ix, margin.iy);
  if (map.of_steps) {
    margin.largest = own.largest_step;
    margin.holds = own.largest_step && *own.largest_step >= step;
    return margin;
  }
  margin.holds = own.failed() == 0;
  look_along(map, true, margin);
  look_along(map, false, margin);
  return margin;
}

std::string in_words(const StabilityMap& map, double step) {
  const std::optional<Margin> margin = margin_of(map, step);
  if (!margin) return map.x.own && map.y.own ? "is beyond the edge of this map" : map.no_place;
  const MapCell& own = map.cell(margin->ix, margin->iy);
  if (map.of_steps) {
    if (!margin->largest || *margin->largest <= 0.0) return "FAILS: no step holds at its own place";
    const double ratio = *margin->largest / step;
    return fmt::format("{}: the largest step is {:.3g} ms, the scene's {:.3g} ms is {} times {}",
                       margin->holds ? "holds" : "FAILS", 1e3 * *margin->largest, 1e3 * step,
                       rounded(std::max(ratio, 1.0 / ratio)), margin->holds ? "below" : "above");
  }
  std::string text = margin->holds ? "holds"
                                   : fmt::format("FAILS at its own place: {} of {} starts, mostly {}", own.failed(),
                                                 own.starts, k_outcome_words[index_of(own.worst())]);
  if (!margin->holds) return text;
  if (!margin->nearest) return text + "; nothing fails along either axis of the map";
  const MapAxis& axis = margin->nearest->along_x ? map.x : map.y;
  return text + fmt::format("; the nearest failure is at {} {}, {} times {} its own {} ({})", axis.name,
                            in_words(axis, margin->nearest->value), rounded(margin->nearest->ratio),
                            margin->nearest->value > *axis.own ? "above" : "below", in_words(axis, *axis.own),
                            k_outcome_words[index_of(margin->nearest->how)]);
}

} // namespace tutu::app
