// Unit, up axis and height.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <assimp/mesh.h>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace tutu::rig::import_detail {
namespace {

constexpr double k_least_height = 0.3, k_most_height = 3.0; ///< m: inside, the file's unit is believed
constexpr double k_usual_height = 1.7;                      ///< m: a guessed unit comes nearest to it
constexpr double k_smallest = 0.01, k_largest = 100.0;      ///< m: outside, it is no character

struct Unit {
  const char* name;
  double metres;
};
constexpr Unit k_units[] = {{"metres", 1.0},    {"centimetres", 0.01}, {"millimetres", 0.001},
                            {"inches", 0.0254}, {"feet", 0.3048},      {"decimetres", 0.1}};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// Bounds of the skinned rest pose in file space.
Eigen::AlignedBox3d rest_bounds(const std::vector<Node>& nodes, const std::vector<Surface>& surfaces) {
  Eigen::AlignedBox3d box;
  for (const Surface& surface : surfaces) {
    std::vector<Affine> palette;
    for (const Binding& binding : surface.bindings)
      palette.push_back(nodes[binding.node].global * binding.inverse_bind);
    for (unsigned v = 0; v < surface.mesh->mNumVertices; ++v) {
      const aiVector3D& p = surface.mesh->mVertices[v];
      const Vec3 vertex(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
      Vec3 skinned = Vec3::Zero();
      for (int i = surface.first[v]; i < surface.first[v + 1]; ++i)
        skinned += surface.influences[i].weight * (palette[surface.influences[i].binding] * vertex);
      box.extend(skinned);
    }
  }
  return box;
}

std::optional<Vec3> joint_called(const std::vector<Node>& nodes, const Joints& joints,
                                 std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    for (std::size_t j = 0; j < joints.names.size(); ++j) {
      std::string name(bare_joint_name(joints.names[j]));
      for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (name.find(part) != std::string::npos) return nodes[joints.nodes[j]].global.translation();
    }
  return std::nullopt;
}

/// For files without a word about their axes: from hips to head and from feet to hips, when joints say so. Both are
/// asked, since the spine of an animal on four legs lies along Z in a file with Y up.
char guess_up_axis(const std::vector<Node>& nodes, const Joints& joints, ImportReport& report) {
  const auto hips = joint_called(nodes, joints, {"pelvis", "hips", "hip"});
  const auto head = joint_called(nodes, joints, {"head", "neck"});
  const auto foot = joint_called(nodes, joints, {"toe", "foot", "ankle", "leg"});
  if (!hips || !head || !foot) return 'Y';
  const auto stands_along_z = [](const Vec3& v) { return v.z() > 2.0 * std::abs(v.y()) && v.z() > std::abs(v.x()); };
  if (!stands_along_z(*head - *hips) || !stands_along_z(*hips - *foot)) return 'Y';
  report.notes.push_back("the head is above the hips and these above the feet along Z: read as Z up");
  return 'Z';
}

Quat rotation_to_y_up(char axis) {
  constexpr double k_quarter = std::numbers::pi / 2;
  if (axis == 'Z') return Quat(Eigen::AngleAxisd(-k_quarter, Vec3::UnitX()));
  if (axis == 'X') return Quat(Eigen::AngleAxisd(k_quarter, Vec3::UnitZ()));
  return Quat::Identity();
}

const Unit& nearest_unit(double height) {
  const Unit* best = k_units;
  for (const Unit& unit : k_units)
    if (std::abs(std::log(height * unit.metres / k_usual_height)) <
        std::abs(std::log(height * best->metres / k_usual_height)) - 1e-12)
      best = &unit;
  return *best;
}

} // namespace

Conversion choose_conversion(const Source& source, const std::vector<Node>& nodes, const Joints& joints,
                             const std::vector<Surface>& surfaces, ImportReport& report) {
  const char up = source.up_axis ? *source.up_axis : guess_up_axis(nodes, joints, report);
  report.up_axis = up;
  Conversion conversion;
  if (!source.already_applied) conversion.rotation = rotation_to_y_up(up);

  const Eigen::AlignedBox3d box = rest_bounds(nodes, surfaces);
  const Vec3 tall = (conversion.rotation * box.diagonal()).cwiseAbs(); // a quarter turn: extents swap places
  const double declared = source.metres_per_unit.value_or(1.0);
  const double applied = source.already_applied ? declared : 1.0;
  const double height = tall.y() / applied; // in the file's units
  if (box.isEmpty() || !std::isfinite(height) || !(height > 0.0))
    throw InputError(source.file, "", "a body without height", "a character that stands upright");
  report.metres_per_unit = declared;
  if (!(height * declared >= k_least_height && height * declared <= k_most_height)) {
    const Unit& unit = nearest_unit(height);
    report.metres_per_unit = unit.metres;
    report.notes.push_back("height " + number(height) + " read as " + unit.name +
                           (source.metres_per_unit
                                ? ", since the file's own unit would make it " + number(height * declared) + " m"
                                : ""));
  }
  report.height = height * report.metres_per_unit;
  if (!(report.height >= k_smallest && report.height <= k_largest))
    throw InputError(source.file, "",
                     "a height of " + number(height) + " units, which is no character in any usual unit",
                     "between 0.01 and 100 m");
  conversion.scale = report.metres_per_unit / applied;
  return conversion;
}

} // namespace tutu::rig::import_detail
