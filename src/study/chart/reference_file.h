// References on disk: JSON, written and read by the program alone.
#pragma once

#include "rig/io/json_file.h"
#include "src/study/chart/reference.h"

namespace tutu::app {

/// Positions are rounded to a micrometre, those of the start are exact.
void write_reference(const Reference& reference, const std::filesystem::path& file);

/// Throws InputError with file, place, found and expected: on damage (a syntax error, a number missing, a checksum that
/// does not fit), and on a reference of another scene or plan than `fingerprint`.
Reference read_reference(const std::filesystem::path& file, const std::string& scene, const std::string& fingerprint);

/// What a file says, whatever its fingerprint and checksum. Throws InputError on what is no reference.
Reference reference_of(const JsonValue& json);

} // namespace tutu::app
