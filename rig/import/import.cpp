// Reading a character: the order of the steps. Each step has a file of its own (rig/import_*.cpp).
#include "rig/import/import.h"
#include "rig/error.h"
#include "rig/import/detail/isolated.h"
#include "rig/import/detail/parts.h"

#include <set>

namespace tutu::rig {
namespace {

int joints_without_weight(const Character& character) {
  std::set<int> weighted;
  for (std::size_t i = 0; i < character.skin.weights.size(); ++i)
    if (character.skin.weights[i] > 0.0f) weighted.insert(character.skin.slot_joint[character.skin.slots[i]]);
  return character.skeleton.joint_count() - static_cast<int>(weighted.size());
}

Import import_loaded(const import_detail::Source& source, const ImportOptions& options) {
  using namespace import_detail;
  Import result;
  ImportReport& report = result.report;
  report.format = source.format;
  result.character.file = source.file;

  std::vector<Node> nodes = walk(source);
  std::vector<Surface> surfaces = skinned_surfaces(source, nodes, report);
  const Joints joints = choose_joints(source, nodes, surfaces, report);
  std::vector<Surface> rigid = rigid_surfaces(source, nodes, report);
  surfaces.insert(surfaces.end(), std::make_move_iterator(rigid.begin()), std::make_move_iterator(rigid.end()));

  const Conversion conversion = choose_conversion(source, nodes, joints, surfaces, report);
  result.character.skeleton = build_skeleton(source, nodes, joints, conversion);
  build_mesh(source, nodes, surfaces, conversion, options, result.character, report);
  report.joints_without_weight = joints_without_weight(result.character);
  result.clips = build_clips(source, nodes, joints, conversion, report);
  note_outside_textures(source, report);
  clean_names(result);
  return result;
}

} // namespace

Import import_character(const std::filesystem::path& file, const ImportOptions& options) {
  if (options.max_influences != 4 && options.max_influences != 8)
    throw std::invalid_argument("import_character: max_influences is 4 or 8");
  using namespace import_detail;
  try {
    const Bounds bounds = bounds_for(check_acceptable(file));
    const std::string answer = isolated_answer(file.string(), bounds, k_expected_character, [&](Packer& packer) {
      Import import = import_loaded(load(file), options);
      pass(packer, import);
    });
    return unpack_import(answer, file.string());
  } catch (...) {
    rethrow_as_input_error(file.string(), k_expected_character);
  }
}

} // namespace tutu::rig
