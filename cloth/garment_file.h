// Garments on disk: JSON, schema in assets/schema/garment.schema.json.
#pragma once

#include "cloth/garment.h"

#include <filesystem>

namespace tutu::cloth {

/// Throws InputError with file, JSON pointer, found and expected.
GarmentDescription read_garment(const std::filesystem::path& file);

} // namespace tutu::cloth
