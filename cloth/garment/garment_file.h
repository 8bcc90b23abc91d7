// Garments on disk: JSON, schema in assets/schema/garment.schema.json.
#pragma once

#include "cloth/garment/garment.h"

#include <filesystem>

namespace tutu::cloth {

/// Throws InputError with file, JSON pointer, found and expected.
///
/// "fabric" is the name of a fabric ("cotton": NAME.json in the folder fabrics beside the garment's own folder), a path
/// that ends in .json (from the garment's folder), or an object: the keys of a fabric file and "base", one of the
/// above.
GarmentDescription read_garment(const std::filesystem::path& file);

/// A fabric file. Throws like read_garment.
Fabric read_fabric(const std::filesystem::path& file);

} // namespace tutu::cloth
