// tutu inspect: what the importer understood of a character file.
#include "rig/character.h"
#include "rig/import/import.h"
#include "rig/io/file_io.h"
#include "src/base/json_text.h"
#include "src/base/outputs.h"
#include "src/commands/commands.h"
#include "src/options/import_options.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

namespace tutu::app {
namespace {

using nlohmann::ordered_json;

std::vector<bool> joints_with_weight(const rig::Character& character) {
  std::vector<bool> weighted(character.skeleton.names.size(), false);
  for (std::size_t i = 0; i < character.skin.weights.size(); ++i)
    if (character.skin.weights[i] > 0.0f) weighted[character.skin.slot_joint[character.skin.slots[i]]] = true;
  return weighted;
}

std::vector<std::vector<int>> children_of(const rig::Skeleton& skeleton) {
  std::vector<std::vector<int>> children(skeleton.names.size() + 1); // the last: roots
  for (int j = 0; j < skeleton.joint_count(); ++j)
    children[skeleton.parents[j] == rig::k_no_parent ? skeleton.names.size() : skeleton.parents[j]].push_back(j);
  return children;
}

struct ClipFigures {
  std::string name;
  double seconds = 0.0;
  std::size_t keys = 0, joints = 0;
};

std::vector<ClipFigures> figures_of(const std::vector<rig::ChannelClip>& clips) {
  std::vector<ClipFigures> figures;
  for (const rig::ChannelClip& clip : clips) {
    std::set<double> times;
    for (const rig::ChannelClip::Joint& joint : clip.joints)
      for (const auto* keys : {&joint.translation.times, &joint.rotation.times})
        times.insert(keys->begin(), keys->end());
    figures.push_back({clip.name, clip.duration(), times.size(), clip.joints.size()});
  }
  return figures;
}

void print_joint_tree(const rig::Skeleton& skeleton, const std::vector<bool>& weighted) {
  const auto children = children_of(skeleton);
  const std::vector<Transform> rest = rig::rest_model(skeleton);
  std::vector<std::pair<int, int>> open; // joint, depth
  std::size_t width = 16;
  std::vector<std::pair<int, int>> order;
  for (auto root = children.back().rbegin(); root != children.back().rend(); ++root) open.emplace_back(*root, 0);
  while (!open.empty()) {
    const auto [joint, depth] = open.back();
    open.pop_back();
    order.emplace_back(joint, depth);
    width = std::max(width, skeleton.names[joint].size() + 2 * static_cast<std::size_t>(depth));
    for (auto child = children[joint].rbegin(); child != children[joint].rend(); ++child)
      open.emplace_back(*child, depth + 1);
  }
  fmt::print("\n  {:<{}}  {:>8} {:>8} {:>8}  skin\n", "joint at rest, m", width, "x", "y", "z");
  for (const auto& [joint, depth] : order) {
    const Vec3& p = rest[joint].translation;
    fmt::print("  {:<{}}  {:8.3f} {:8.3f} {:8.3f}  {}\n",
               std::string(2 * static_cast<std::size_t>(depth), ' ') + skeleton.names[joint], width, p.x(), p.y(),
               p.z(), weighted[joint] ? "yes" : "-");
  }
}

void print_import(const rig::Import& import) {
  const rig::Character& character = import.character;
  const rig::ImportReport& report = import.report;
  fmt::print("{}\n", character.file);
  fmt::print("  format      {}\n", report.format);
  fmt::print("  unit        1 = {:g} m, {} up\n", report.metres_per_unit, report.up_axis);
  fmt::print("  height      {:.3f} m\n", report.height);
  fmt::print("  meshes      {} in the file, {} part{} kept\n", report.file_meshes, character.mesh.parts.size(),
             character.mesh.parts.size() == 1 ? "" : "s");
  fmt::print("  skeletons   {} in the file{}\n", report.file_skeletons,
             report.file_skeletons > 1 ? ", put in common" : "");
  fmt::print("  joints      {}, {} of them without skin\n", character.skeleton.joint_count(),
             report.joints_without_weight);
  fmt::print("  vertices    {} in the file, {} welded\n", report.file_vertices, character.mesh.vertex_count());
  fmt::print("  triangles   {}\n", character.mesh.triangles.size());
  fmt::print("  influences  at most {} a vertex in the file, {} kept", report.largest_influences,
             character.skin.influences);
  if (report.cut_vertices > 0)
    fmt::print("; {} vertices cut, at most {:.2f} % lost", report.cut_vertices, 100.0 * report.largest_cut);
  fmt::print("\n  bindings    {} (joints with an inverse bind)\n", character.skin.slot_count());
  for (const rig::MeshPart& part : character.mesh.parts)
    fmt::print("  part        {}: {} triangles\n", part.name, part.triangle_count);
  if (import.clips.empty()) fmt::print("  clips       none\n");
  for (const ClipFigures& clip : figures_of(import.clips))
    fmt::print("  clip        {}: {:.3f} s, {} joint{}, keys at {} time{}\n", clip.name, clip.seconds, clip.joints,
               clip.joints == 1 ? "" : "s", clip.keys, clip.keys == 1 ? "" : "s");
  for (const std::string& note : report.notes) fmt::print("  note        {}\n", note);
  print_joint_tree(character.skeleton, joints_with_weight(character));
}

ordered_json json_of(const rig::Import& import) {
  const rig::Character& character = import.character;
  const rig::ImportReport& report = import.report;
  ordered_json json = {{"file", character.file},
                       {"format", report.format},
                       {"metres_per_unit", report.metres_per_unit},
                       {"up_axis", report.up_axis},
                       {"height", report.height},
                       {"file_meshes", report.file_meshes},
                       {"file_skeletons", report.file_skeletons},
                       {"joints_without_weight", report.joints_without_weight},
                       {"file_vertices", report.file_vertices},
                       {"vertices", character.mesh.vertex_count()},
                       {"triangles", character.mesh.triangles.size()},
                       {"largest_influences", report.largest_influences},
                       {"influences", character.skin.influences},
                       {"cut_vertices", report.cut_vertices},
                       {"largest_cut", report.largest_cut},
                       {"bindings", character.skin.slot_count()}};
  json["parts"] = ordered_json::array();
  for (const rig::MeshPart& part : character.mesh.parts)
    json["parts"].push_back({{"name", part.name}, {"triangles", part.triangle_count}, {"colour", part.colour}});
  json["clips"] = ordered_json::array();
  for (const ClipFigures& clip : figures_of(import.clips))
    json["clips"].push_back(
        {{"name", clip.name}, {"seconds", clip.seconds}, {"joints", clip.joints}, {"keys", clip.keys}});
  json["notes"] = report.notes;
  json["joints"] = ordered_json::array();
  const std::vector<bool> weighted = joints_with_weight(character);
  const std::vector<Transform> rest = rig::rest_model(character.skeleton);
  for (int j = 0; j < character.skeleton.joint_count(); ++j) {
    const int parent = character.skeleton.parents[j];
    const Vec3& p = rest[j].translation;
    json["joints"].push_back(
        {{"name", character.skeleton.names[j]},
         {"parent", parent == rig::k_no_parent ? ordered_json() : ordered_json(character.skeleton.names[parent])},
         {"rest", {p.x(), p.y(), p.z()}},
         {"skin", static_cast<bool>(weighted[j])}});
  }
  return json;
}

struct Options {
  std::string file, json;
  rig::ImportOptions import;
};

} // namespace

void add_inspect(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("inspect", "Show what the importer understood of a character file");
  auto options = std::make_shared<Options>();
  command->add_option("FILE", options->file, "Rigged character: .dae .gltf .glb .vrm .fbx .x")->required();
  command->add_option("--json", options->json, "Write the same for machines");
  add_import_options(*command, options->import);
  command->callback([options, &status] {
    check_outputs({{"--json", options->json}}, {options->file});
    const rig::Import import = rig::import_character(options->file, options->import);
    if (!options->json.empty()) // names come from the file and need not be UTF-8
      write_file(options->json, json_text(json_of(import)));
    print_import(import);
    status = k_ok;
  });
}

} // namespace tutu::app
