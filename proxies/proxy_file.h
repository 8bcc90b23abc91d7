// Proxies on disk: JSON, schema in assets/schema/proxies.schema.json.
//
//   { "proxies": [
//     { "name": "head", "sphere": { "joint": "Head", "center": [0, 0.09, 0.01], "radius": 0.095 } },
//     { "capsule": { "joint": "LeftLeg", "a": [0, 0, 0], "b": [0, -0.4, 0], "radius": [0.07, 0.04] }, "friction": 0.3,
//       "enabled": true },
//     { "capsule": { "a": { "between": ["LeftUpLeg", "LeftLeg"], "at": 0.5 }, "radius": 0.07,
//                    "b": { "point": [0.1, 0.9, 0], "joints": [["Hips", 0.7], ["LeftUpLeg", 0.3]] } } }
//   ] }
//
// Points are in the frame of `joint` (m); "between" blends two joint origins; "point" is in model space at rest and
// follows its joints by weight (normalised; at most 4). An end may name its own joint: { "joint": "LeftLeg", "at": [0,
// 0, 0] }. A sphere's center takes every form that an end takes. The shape's own "joint" is for bare points [x, y, z]:
// required where there is one, refused where there is none. A capsule with both ends at one point is refused: it is a
// sphere. A capsule has one radius, or two: [at a, at b].
#pragma once

#include "proxies/collider.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tutu::proxies {

/// What `tutu fit` says in the file about the proxies it made: "fit". Lengths in mm, as in the file.
struct FitNote {
  struct Side {
    double p95 = 0.0, max = 0.0, bound = 0.0;
  };
  std::string character, motion, region; ///< file names; "strong poses" where no clip was given
  int poses = 0;                         ///< in which it was measured
  Side under_mm, over_mm;                ///< FitError of fit.h
};

/// Throws InputError with file, JSON pointer, found and expected: unknown joint or key, radius <= 0, two proxies with
/// one name, both or neither shape. A proxy without a name is called after its joint and place in the list.
std::vector<Proxy> read_proxies(const std::filesystem::path& file, const rig::Skeleton& skeleton);

/// Writes what read_proxies reads back (to 1e-15): anchors on one joint as joint points, blends of two origins as
/// "between", others as points with weights. Throws std::invalid_argument, before it touches the file, on proxies that
/// no file can say. Names the schema where the file comes to stand beside it, as in assets/.
void write_proxies(const std::filesystem::path& file, const std::vector<Proxy>& proxies, const rig::Skeleton& skeleton,
                   const std::optional<FitNote>& fit = {});

/// The file's "fit", where it has one. Throws InputError as read_proxies.
std::optional<FitNote> read_fit_note(const std::filesystem::path& file);

} // namespace tutu::proxies
