#include "src/scene/saved_drape.h"

#include "cloth/garment/drape_file.h"
#include "src/run/drape.h"
#include "src/scene/load.h"

namespace tutu::app {

std::optional<GarmentPositions> saved_drape(const LoadedScene& scene, bool* stale) {
  *stale = false;
  std::error_code error; // a name that no file can have, say: then there is none
  if (!std::filesystem::exists(scene.files.drape, error)) return std::nullopt;
  const cloth::Drape saved = cloth::read_drape(scene.files.drape);
  GarmentPositions positions;
  bool fits = saved.fingerprint == drape_fingerprint(scene) && saved.garments.size() == scene.garments.size();
  for (std::size_t g = 0; fits && g < saved.garments.size(); ++g) {
    fits = saved.garments[g].positions.size() == scene.garments[g].rest_positions.size();
    positions.push_back(saved.garments[g].positions);
  }
  *stale = !fits;
  if (!fits) return std::nullopt;
  return positions;
}

} // namespace tutu::app
