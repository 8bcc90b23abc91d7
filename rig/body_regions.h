// Which part of a human body a joint belongs to, by its name.
#pragma once

#include "rig/mesh.h"
#include "rig/skeleton.h"
#include "rig/skin.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace tutu::rig {

enum class BodyRegion : std::uint8_t { head, torso, arms, hands, legs, feet, other };

inline constexpr std::array<std::string_view, 7> k_region_names = {"head", "torso", "arms", "hands",
                                                                   "legs", "feet",  "other"};

/// [joint] Names are searched, upper and lower case alike, for the words of common rigs ("LeftForeArm", "Bip01 L
/// Calf"). A joint that says nothing is where its parent is; where no joint above says anything, `other`. Shoulders and
/// collar bones are torso.
std::vector<BodyRegion> body_regions(const Skeleton& skeleton);

/// The joint with most of the weight at a point of a triangle: `weights` barycentric; the first of equals.
int main_joint(const Skin& skin, const Triangle& triangle, const Vec3& weights);

} // namespace tutu::rig
