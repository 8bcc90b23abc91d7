// Clips on disk: JSON for people, and the three texts of the 2021 report. Both round trip without loss.
#pragma once

#include "rig/clip.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tutu::rig {

/// JSON (assets/schema/clip.schema.json); the name defaults to the file's, extrapolation to loop, interpolation to
/// nlerp. Rotations up to 10 % off unit length are normalised, which `notes` (may be null) receives as one sentence.
/// Throws InputError with file, JSON pointer, found and expected.
RawClip read_clip(const std::filesystem::path& file, std::vector<std::string>* notes = nullptr);
void write_clip(const RawClip& clip, const std::filesystem::path& file);

/// The report's form, blanks between numbers, no names: `translations` (3 numbers a joint) and `rotations` (x y z w a
/// joint) with one pose a line, `times` on one line. Joints come in skeleton order, or in that of `joints`: a file with
/// one `index parent name` a line.
struct ThreeTexts {
  std::filesystem::path translations, rotations, times;
  std::optional<std::filesystem::path> joints;
};

/// Reads a clip from the three texts. Translations in another unit than the skeleton's metres are recognised by the
/// bone lengths (median over joints and poses of file length to rest length, within 10 % of m, dm, cm, mm, inches or
/// feet) and converted. Rotations up to 10 % off unit length are normalised. Of either `notes` (may be null) receives
/// one sentence when it happened. Throws InputError with file and line; also on translations in no known unit.
RawClip read_three_texts(const ThreeTexts& files, const Skeleton& skeleton, std::vector<std::string>* notes);

/// Writes every joint of every key (what is not given is as at rest) in skeleton order, and that order to
/// `files.joints` where given; names of keys, extrapolation, interpolation and flights have no place. Shortest decimal
/// form that reads back to the same bits.
void write_three_texts(const RawClip& clip, const Skeleton& skeleton, const ThreeTexts& files);

} // namespace tutu::rig
