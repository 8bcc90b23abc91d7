#include "rig/import/gltf/meshes.h"

#include "rig/import/detail/parts.h"

#include <algorithm>

namespace tutu::rig::import_detail {
namespace {

/// Weights that are 0 at the end say nothing.
std::vector<double> default_weights(const GltfValue& node, const GltfValue& mesh) {
  std::optional<GltfValue> given = node.find("weights");
  if (!given) given = mesh.find("weights");
  if (!given) return {};
  std::vector<double> weights = given->numbers();
  while (!weights.empty() && weights.back() == 0.0) weights.pop_back();
  return weights;
}

} // namespace

GltfMeshes::GltfMeshes(GltfAccessors& accessors, GltfSkins& skins, FileScene& scene)
    : accessors_(accessors), skins_(skins), scene_(scene), users_(accessors.document().count("accessors"), 0) {
  const GltfDocument& document = accessors.document();
  for (const GltfValue& mesh : document.root().items("meshes"))
    for (const GltfValue& primitive : mesh.at("primitives").items())
      if (const std::optional<GltfValue> positions = primitive.at("attributes").find("POSITION"))
        ++users_[document.target_index(*positions, "accessors")];
}

void GltfMeshes::draw(const GltfValue& node, int index) {
  const std::optional<GltfValue> reference = node.find("mesh");
  if (!reference) return;
  const GltfDocument& document = accessors_.document();
  const GltfValue mesh = document.target(*reference, "meshes");
  const std::optional<GltfValue> skin_reference = node.find("skin");
  const std::vector<Binding>* skin = skin_reference ? &skins_.skin(*skin_reference) : nullptr;
  for (const Part& part : parts_of(mesh, document.target_index(*reference, "meshes"), default_weights(node, mesh))) {
    FileInstance instance{.mesh = part.mesh, .node = index, .skin = {}};
    if (skin && part.has_influences) {
      if (part.highest_joint >= skin->size())
        throw InputError(document.file(), part.place,
                         "joint index " + std::to_string(part.highest_joint) + " for vertex " +
                             std::to_string(part.highest_joint_vertex),
                         "an index below " + std::to_string(skin->size()) + ", the joints of " +
                             skin_reference->pointer());
      instance.skin = *skin;
    }
    accessors_.memory().take(sizeof instance + instance.skin.size() * sizeof(Binding), node.pointer());
    scene_.instances.push_back(std::move(instance));
  }
}

const std::vector<GltfMeshes::Part>& GltfMeshes::parts_of(const GltfValue& mesh, std::size_t index,
                                                          const std::vector<double>& weights) {
  const auto [found, is_new] = parts_.try_emplace({index, weights});
  if (!is_new) return found->second;
  std::string name = mesh.text_or("name", "");
  if (name.empty()) name = "mesh " + std::to_string(index);
  const std::vector<GltfValue> primitives = mesh.at("primitives").items();
  for (std::size_t p = 0; p < primitives.size(); ++p)
    found->second.push_back(
        part_of(primitives[p], primitives.size() > 1 ? name + "-" + std::to_string(p) : name, weights));
  if (const auto morphed = std::count_if(weights.begin(), weights.end(), [](double w) { return w != 0.0; });
      morphed > 0)
    scene_.notes.push_back("mesh " + name + " has the shape of " +
                           count_of(static_cast<std::size_t>(morphed), "morph target") +
                           " in it, by their default weights");
  return found->second;
}

GltfMeshes::Part GltfMeshes::part_of(const GltfValue& primitive, const std::string& name,
                                     const std::vector<double>& weights) {
  GltfPrimitive made = read_primitive(primitive, weights, accessors_);
  if (const std::optional<GltfValue> positions = primitive.at("attributes").find("POSITION");
      positions && users_[accessors_.document().target_index(*positions, "accessors")] > 1)
    keep_used_vertices(made.mesh);
  made.mesh.name = name;
  made.mesh.colour = colour_of(primitive);
  for (const std::string& note : made.notes)
    if (Left& left = left_out_[note]; ++left.count == 1) left.first_place = made.place;
  const Part part{.mesh = static_cast<int>(scene_.meshes.size()),
                  .has_influences = made.has_influences(),
                  .highest_joint = made.highest_joint,
                  .highest_joint_vertex = made.highest_joint_vertex,
                  .place = std::move(made.place)};
  scene_.meshes.push_back(std::move(made.mesh));
  return part;
}

void GltfMeshes::note() const {
  for (const auto& [what, left] : left_out_)
    scene_.notes.push_back(count_of(left.count, "primitive") + " " + what + " (" +
                           (left.count == 1 ? "" : "the first: ") + left.first_place + ")");
}

std::array<float, 3> GltfMeshes::colour_of(const GltfValue& primitive) const {
  const std::optional<GltfValue> reference = primitive.find("material");
  if (!reference) return FileMesh{}.colour;
  const GltfValue material = accessors_.document().target(*reference, "materials");
  std::optional<GltfValue> factor;
  if (const auto shading = material.find("pbrMetallicRoughness")) factor = shading->find("baseColorFactor");
  else if (const auto older = material.extension("KHR_materials_pbrSpecularGlossiness"))
    factor = older->find("diffuseFactor");
  std::array<float, 3> colour = {1.0f, 1.0f, 1.0f};
  if (!factor) return colour;
  const std::vector<double> given = factor->numbers(4);
  for (std::size_t k = 0; k < 3; ++k) colour[k] = static_cast<float>(std::clamp(given[k], 0.0, 1.0));
  return colour;
}

} // namespace tutu::rig::import_detail
