// Unit, up axis and height.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace tutu::rig::import_detail {
namespace {

constexpr double k_least_height = 0.3, k_most_height = 3.0; ///< m: of a person, or what dances like one
constexpr double k_usual_height = 1.7;                      ///< m: a likely unit comes nearest to it
constexpr double k_smallest = 0.05;                         ///< m: below, a body is in the wrong unit

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// Bounds of the skinned body at rest, in file space.
Eigen::AlignedBox3d rest_bounds(const std::vector<Node>& nodes, const Joints& joints,
                                const std::vector<Surface>& surfaces) {
  Eigen::AlignedBox3d box;
  for (const Surface& surface : surfaces) {
    std::vector<Affine> palette;
    for (const Binding& binding : surface.bindings) palette.push_back(carried_at_rest(nodes, joints, binding));
    for (std::size_t v = 0; v < surface.mesh->positions.size(); ++v) {
      const Vec3 vertex = surface.mesh->positions[v].cast<double>();
      Vec3 skinned = Vec3::Zero();
      for (int i = surface.first[v]; i < surface.first[v + 1]; ++i)
        skinned += surface.influences[i].weight * (palette[surface.influences[i].binding] * vertex);
      box.extend(skinned);
    }
  }
  return box;
}

std::optional<Vec3> joint_called(const Joints& joints, std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    for (std::size_t j = 0; j < joints.names.size(); ++j) {
      std::string name(bare_joint_name(joints.names[j]));
      for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (name.find(part) != std::string::npos) return joints.rest[j].translation;
    }
  return std::nullopt;
}

/// For files without a word about their axes: from hips to head and from feet to hips, when joints say so. Both are
/// asked, since the spine of an animal on four legs lies along Z in a file with Y up.
char guess_up_axis(const Joints& joints, ImportReport& report) {
  const auto hips = joint_called(joints, {"pelvis", "hips", "hip"});
  const auto head = joint_called(joints, {"head", "neck"});
  const auto foot = joint_called(joints, {"toe", "foot", "ankle", "leg"});
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

/// How near a height is to that of a person, by its logarithm; 0 is nearest.
double unlikeliness(double height) { return std::abs(std::log(height / k_usual_height)); }

const LengthUnit& nearest_unit(double height) {
  const LengthUnit* best = k_length_units.data();
  for (const LengthUnit& unit : k_length_units)
    if (unlikeliness(height * unit.metres) < unlikeliness(height * best->metres) - 1e-12) best = &unit;
  return *best;
}

/// By how much a height in metres is likely wrong: a unit was left out or applied twice.
double likely_factor(double height) {
  double best = 1.0;
  for (const LengthUnit& unit : k_length_units)
    for (const double factor : {unit.metres, 1.0 / unit.metres})
      if (unlikeliness(height * factor) < unlikeliness(height * best) - 1e-12) best = factor;
  return best;
}

/// "100 times that, 1.75 m, is likelier"
std::string proposal(double height) {
  const double factor = likely_factor(height);
  return number(factor) + " times that, " + number(factor * height) + " m, is likelier";
}

} // namespace

Conversion choose_conversion(const FileScene& scene, const std::vector<Node>& nodes, const Joints& joints,
                             const std::vector<Surface>& surfaces, const ImportOptions& options, ImportReport& report) {
  const char up = scene.up_axis ? *scene.up_axis : guess_up_axis(joints, report);
  report.up_axis = up;
  Conversion conversion;
  if (!scene.already_applied) conversion.rotation = rotation_to_y_up(up);

  const Eigen::AlignedBox3d box = rest_bounds(nodes, joints, surfaces);
  const Vec3 tall = (conversion.rotation * box.diagonal()).cwiseAbs(); // a quarter turn: extents swap places
  const double applied = scene.already_applied ? scene.metres_per_unit.value_or(1.0) : 1.0;
  const double height = tall.y() / applied; // in the file's units
  if (box.isEmpty() || !std::isfinite(height) || !(height > 0.0))
    throw InputError(scene.file, "", "a body without height", "a character that stands upright");

  const std::optional<double> said = options.metres_per_unit ? options.metres_per_unit : scene.metres_per_unit;
  if (options.height) {
    report.metres_per_unit = *options.height / height;
  } else if (said) {
    report.metres_per_unit = *said;
  } else if (!(height >= k_least_height && height <= k_most_height)) {
    const LengthUnit& unit = nearest_unit(height);
    report.metres_per_unit = unit.metres;
    report.notes.push_back("no unit in the file: its height of " + number(height) + " read as " + unit.name);
  }
  report.height = height * report.metres_per_unit;
  if (!(report.height >= k_smallest))
    throw InputError(scene.file, "", "a body " + number(report.height) + " m high; " + proposal(report.height),
                     "at least " + number(k_smallest) +
                         " m, or the height stated: --height, or \"height\" beside the character's file in the scene");
  if (!options.height && !(report.height >= k_least_height && report.height <= k_most_height))
    report.notes.push_back("the body is " + number(report.height) + " m high" + (said ? ", as its unit says" : "") +
                           "; " + proposal(report.height) +
                           ": state --height, or \"height\" beside the character's file in the scene");
  conversion.scale = report.metres_per_unit / applied;
  return conversion;
}

} // namespace tutu::rig::import_detail
