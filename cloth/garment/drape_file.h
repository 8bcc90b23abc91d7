// Settled garments on disk, so that a scene need not settle them again.
#pragma once

#include "rig/math.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tutu::cloth {

/// Where the particles of one garment came to rest.
struct DrapedGarment {
  std::string name;
  std::vector<Vec3> positions; ///< world, m, in the garment's order
};

/// All garments of a scene, and what they were draped for.
struct Drape {
  std::uint64_t fingerprint = 0; ///< of everything the result depends on; another one means the file is out of date
  std::vector<DrapedGarment> garments;
};

/// JSON, to the last bit of every number. Reading throws InputError with file, JSON pointer, found and expected.
Drape read_drape(const std::filesystem::path& file);
void write_drape(const Drape& drape, const std::filesystem::path& file);

} // namespace tutu::cloth
