// The joints of a character: who hangs from whom, and where each rests.
#pragma once

#include "rig/math.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig {

inline constexpr int k_no_parent = -1;

/// A tree of joints in flat arrays, parent before child. Immutable once built; a pose is kept apart: spans of
/// transforms.
struct Skeleton {
  std::vector<std::string> names;    ///< unique
  std::vector<int> parents;          ///< index of the parent joint, smaller than the child's; k_no_parent for roots
  std::vector<Transform> rest_local; ///< parent_from_joint in the rest pose; m

  int joint_count() const { return static_cast<int>(names.size()); }

  /// The joint called `name`: exactly, else the same without a namespace ("mixamorig:Hips", "mixamorig_Hips" and "Hips"
  /// are the same joint), upper and lower case alike. None when there is no such joint, or when it is ambiguous.
  std::optional<int> find(std::string_view name) const;

  /// Throws InputError (naming `file`) unless names are unique and parents stand before children.
  void check(const std::string& file) const;
};

/// A joint name without its namespace: what follows the last ':', or "mixamorig" and its digits and '_' cut off.
std::string_view bare_joint_name(std::string_view name);

/// model_from_joint of every joint, from the local transforms (parent_from_joint). All spans have joint_count()
/// entries.
void model_from_local(const Skeleton& skeleton, std::span<const Transform> local, std::span<Transform> model);

/// model_from_joint of one joint, collected on the way up: for few joints, or where only few have changed.
Transform model_of_joint(const Skeleton& skeleton, std::span<const Transform> local, int joint);

/// The inverse of model_from_local.
void local_from_model(const Skeleton& skeleton, std::span<const Transform> model, std::span<Transform> local);

/// The joints without a parent, rising.
std::vector<int> roots_of(const Skeleton& skeleton);

/// model_from_joint of every joint at rest.
std::vector<Transform> rest_model(const Skeleton& skeleton);

} // namespace tutu::rig
