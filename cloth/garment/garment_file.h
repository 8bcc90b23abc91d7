// Garments on disk: JSON, schema in assets/schema/garment.schema.json.
#pragma once

#include "cloth/garment/garment.h"

#include <filesystem>
#include <vector>

namespace tutu::cloth {

/// Throws InputError with file, JSON pointer, found and expected.
///
/// "fabric" is the name of a fabric ("cotton": NAME.json in the folder fabrics beside the garment's own folder), a path
/// that ends in .json (from the garment's folder), or an object: the keys of a fabric file and "base", one of the
/// above.
GarmentDescription read_garment(const std::filesystem::path& file);

/// The files a garment's file names, as read_garment finds them: its mesh, its fabric. Throws like read_garment.
std::vector<std::filesystem::path> files_named_by_garment(const std::filesystem::path& file);

/// A fabric file. Throws like read_garment.
Fabric read_fabric(const std::filesystem::path& file);

} // namespace tutu::cloth
