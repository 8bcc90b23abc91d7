// How far joints may turn, on disk.
#pragma once

#include "rig/ik.h"

#include <filesystem>
#include <vector>

namespace tutu::app {

/// {"limits": [{"joint": "LeftLeg", "axis": [1, 0, 0], "swing_degrees": 0, "twist_degrees": [0, 150]}]}
/// (assets/schema/limits.schema.json, rig::JointLimit). Throws InputError with file, JSON pointer, found and expected.
std::vector<rig::JointLimit> read_joint_limits(const std::filesystem::path& file, const rig::Skeleton& skeleton);

} // namespace tutu::app
