// Proxies on disk: JSON, schema in assets/schema/proxies.schema.json.
//
//   { "proxies": [
//     { "name": "head", "sphere": { "joint": "Head", "center": [0, 0.09, 0.01], "radius": 0.095 } },
//     { "capsule": { "joint": "LeftUpLeg", "a": [0,0,0], "b": [0,-0.4,0], "radius": 0.07 }, "friction": 0.3, "enabled": true },
//     { "capsule": { "a": { "between": ["LeftUpLeg", "LeftLeg"], "at": 0.5 },
//                    "b": { "point": [0.1, 0.9, 0], "joints": [["Hips", 0.7], ["LeftUpLeg", 0.3]] }, "radius": 0.07 } } ] }
//
// Points are in the frame of `joint` (m); "between" blends two joint origins; "point" is in model space at rest and follows its
// joints by weight (normalised; at most 4). An end may name its own joint: { "joint": "LeftLeg", "at": [0, 0, 0] }.
#pragma once

#include "proxies/collider.h"

#include <filesystem>
#include <vector>

namespace tutu::proxies {

/// Throws InputError with file, JSON pointer, found and expected: unknown joint or key, radius <= 0, two proxies with one
/// name, both or neither shape. A proxy without a name is called after its joint and place in the list.
std::vector<Proxy> read_proxies(const std::filesystem::path& file, const rig::Skeleton& skeleton);

/// Writes what read_proxies reads back exactly (anchors on one joint as joint points, others as points with weights).
void write_proxies(const std::filesystem::path& file, const std::vector<Proxy>& proxies, const rig::Skeleton& skeleton);

} // namespace tutu::proxies
