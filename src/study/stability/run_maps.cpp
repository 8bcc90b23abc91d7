#include "src/study/stability/maps.h"

#include "src/base/workers.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

namespace tutu::app {

std::optional<double> MapAxis::place(double value) const {
  if (values.size() < 2 || !(value > 0.0)) return std::nullopt;
  std::size_t k = 0; // the pair of values that it lies between, or next to
  while (k + 2 < values.size() && value > values[k + 1]) ++k;
  const double place = static_cast<double>(k) + std::log(value / values[k]) / std::log(values[k + 1] / values[k]);
  if (!(place >= -0.5 && place <= static_cast<double>(values.size()) - 0.5)) return std::nullopt;
  return place;
}

Outcome MapCell::worst() const {
  const auto most = std::max_element(outcomes.begin() + 1, outcomes.end());
  return *most > 0 ? static_cast<Outcome>(most - outcomes.begin()) : Outcome::held;
}

bool run_maps(std::vector<StabilityMap>& maps, const MapOptions& options,
              const std::function<bool(int done, int total)>& progress) {
  struct Place {
    StabilityMap* map;
    std::size_t ix, iy;
  };
  std::vector<Place> places;
  for (StabilityMap& map : maps) {
    map.cells.assign(map.x.values.size() * map.y.values.size(), {});
    for (std::size_t iy = 0; iy < map.y.values.size(); ++iy)
      for (std::size_t ix = 0; ix < map.x.values.size(); ++ix) places.push_back({&map, ix, iy});
  }
  const int total = static_cast<int>(places.size()) * options.starts;
  std::atomic<bool> go_on = true;
  std::mutex telling;
  int done = 0;
  Workers(options.threads).for_each(places.size(), [&](std::size_t k) {
    const Place& place = places[k];
    MapCell& cell = place.map->cell(place.ix, place.iy);
    for (int start = 1; start <= options.starts && go_on; ++start) {
      place.map->run(place.map->x.values[place.ix], place.map->y.values[place.iy], static_cast<std::uint64_t>(start),
                     cell);
      ++cell.starts;
      const std::lock_guard lock(telling);
      if (!progress(++done, total)) go_on = false;
    }
  });
  return go_on;
}

} // namespace tutu::app
