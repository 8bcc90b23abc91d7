// Reading a character: the order of the steps. Each step has a file of its own (rig/import/*.cpp).
#include "rig/import/import.h"
#include "rig/error.h"
#include "rig/import/detail/isolated.h"
#include "rig/import/detail/parts.h"

#include <algorithm>
#include <cassert>
#include <set>

namespace tutu::rig {
namespace {

int joints_without_weight(const Character& character) {
  std::set<int> weighted;
  for (std::size_t i = 0; i < character.skin.weights.size(); ++i)
    if (character.skin.weights[i] > 0.0f) weighted.insert(character.skin.slot_joint[character.skin.slots[i]]);
  return character.skeleton.joint_count() - static_cast<int>(weighted.size());
}

Import import_loaded(const import_detail::FileScene& scene, const ImportOptions& options) {
  using namespace import_detail;
  Import result;
  ImportReport& report = result.report;
  report.format = scene.format;
  report.notes = scene.notes;
  result.character.file = scene.file;

  std::vector<Node> nodes = walk(scene);
  std::vector<Surface> surfaces = skinned_surfaces(scene, nodes, report);
  Joints joints = choose_joints(scene, nodes, surfaces, report);
  if (options.rest == RestPose::bind) rest_in_bind_pose(nodes, surfaces, joints, report);
  const Conversion conversion = choose_conversion(scene, nodes, joints, surfaces, options, report);
  result.character.skeleton = build_skeleton(scene.file, joints, conversion);

  std::vector<Surface> rigid = rigid_surfaces(scene, nodes, report);
  surfaces.insert(surfaces.end(), std::make_move_iterator(rigid.begin()), std::make_move_iterator(rigid.end()));
  build_mesh(nodes, surfaces, conversion, options, result.character, report);
  report.joints_without_weight = joints_without_weight(result.character);
  result.clips = build_clips(scene, nodes, joints, conversion, report);
  clean_names(result);
  return result;
}

} // namespace

RestPose rest_pose_named(std::string_view name) {
  const auto found = std::ranges::find(k_rest_pose_names, name);
  assert(found != k_rest_pose_names.end());
  return static_cast<RestPose>(found - k_rest_pose_names.begin());
}

Import import_character(const std::filesystem::path& file, const ImportOptions& options) {
  if (options.max_influences != 4 && options.max_influences != 8)
    throw std::invalid_argument("import_character: max_influences is 4 or 8");
  for (const auto& length : {options.height, options.metres_per_unit})
    if (length && !(*length > 0.0 && *length <= k_largest_number))
      throw std::invalid_argument("import_character: height and unit are positive lengths");
  using namespace import_detail;
  try {
    const Bounds bounds = bounds_for(check_acceptable(file));
    const std::string answer = isolated_answer(file.string(), bounds, k_expected_character, [&](Packer& packer) {
      Import import = import_loaded(read_scene_of(file), options);
      pass(packer, import);
    });
    return unpack_import(answer, file.string());
  } catch (...) {
    rethrow_as_input_error(file.string(), k_expected_character);
  }
}

} // namespace tutu::rig
