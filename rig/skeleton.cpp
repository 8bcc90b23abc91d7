#include "rig/skeleton.h"

#include "rig/error.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace tutu::rig {
namespace {

bool same_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

} // namespace

std::string_view bare_joint_name(std::string_view name) {
  if (const std::size_t colon = name.rfind(':'); colon != std::string_view::npos) return name.substr(colon + 1);
  constexpr std::string_view k_mixamo =
      "mixamorig"; // exporters that cannot write ':' give "mixamorig_" or "mixamorig1_"
  if (name.starts_with(k_mixamo)) {
    std::size_t start = k_mixamo.size();
    while (start < name.size() && (std::isdigit(static_cast<unsigned char>(name[start])) || name[start] == '_'))
      ++start;
    if (start < name.size()) return name.substr(start);
  }
  return name;
}

std::optional<int> Skeleton::find(std::string_view name) const {
  if (const auto exact = std::find(names.begin(), names.end(), name); exact != names.end())
    return static_cast<int>(exact - names.begin());
  const std::string_view bare = bare_joint_name(name);
  std::optional<int> match;
  for (int j = 0; j < joint_count(); ++j) {
    if (!same_ignoring_case(bare_joint_name(names[j]), bare)) continue;
    if (match) return std::nullopt;
    match = j;
  }
  return match;
}

void Skeleton::check(const std::string& file) const {
  std::set<std::string> seen;
  for (int j = 0; j < joint_count(); ++j) {
    const std::string place = "joint " + names[j];
    if (!seen.insert(names[j]).second) throw InputError(file, place, "the name twice", "every joint name once");
    if (parents[j] < k_no_parent || parents[j] >= j)
      throw InputError(file, place, "parent " + std::to_string(parents[j]), "a parent that stands before its child");
    if (!is_finite(rest_local[j])) throw InputError(file, place, "a non-finite rest transform", "finite numbers");
  }
}

void model_from_local(const Skeleton& skeleton, std::span<const Transform> local, std::span<Transform> model) {
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const int parent = skeleton.parents[j];
    model[j] = parent == k_no_parent ? local[j] : model[parent] * local[j];
  }
}

Transform model_of_joint(const Skeleton& skeleton, std::span<const Transform> local, int joint) {
  Transform model = local[joint];
  for (int above = skeleton.parents[joint]; above != k_no_parent; above = skeleton.parents[above])
    model = local[above] * model;
  return model;
}

void local_from_model(const Skeleton& skeleton, std::span<const Transform> model, std::span<Transform> local) {
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const int parent = skeleton.parents[j];
    local[j] = parent == k_no_parent ? model[j] : model[parent].inverse() * model[j];
  }
}

std::vector<int> roots_of(const Skeleton& skeleton) {
  std::vector<int> roots;
  for (int j = 0; j < skeleton.joint_count(); ++j)
    if (skeleton.parents[j] == k_no_parent) roots.push_back(j);
  return roots;
}

std::vector<Transform> rest_model(const Skeleton& skeleton) {
  std::vector<Transform> model(skeleton.joint_count());
  model_from_local(skeleton, skeleton.rest_local, model);
  return model;
}

} // namespace tutu::rig
