// [Collada 1.4.1]: asset, effects, materials, geometries, controllers, one visual scene.
#include "rig/mannequin/mannequin.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

namespace tutu::rig {
namespace {

/// The shortest digits that read back the same float: no locale, no choice.
void append(std::string& text, float value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value + 0.0f).ptr; // + 0 turns -0 into 0
  text.append(digits, end);
}

void append(std::string& text, long value) { text += std::to_string(value); }

template <class Value> std::string listed(const std::vector<Value>& values) {
  std::string text;
  for (const Value& value : values) {
    if (!text.empty()) text += ' ';
    append(text, value);
  }
  return text;
}

std::string quoted(std::string_view name, const std::string& value) {
  std::string text(1, ' ');
  return text.append(name).append("=\"").append(value).append("\"");
}

std::string number_of(std::size_t n) { return std::to_string(n); }

/// <source> of floats with an accessor: `parameters` name the columns, one that is "TRANSFORM" is a 4x4 matrix.
std::string float_source(const std::string& id, const std::vector<float>& values,
                         std::initializer_list<const char*> parameters) {
  const bool matrix = std::string_view(*parameters.begin()) == "TRANSFORM";
  const std::size_t stride = matrix ? 16 : parameters.size();
  std::string text = "<source" + quoted("id", id) + "><float_array" + quoted("id", id + "-array") +
                     quoted("count", number_of(values.size())) + ">" + listed(values) + "</float_array>\n";
  text += "<technique_common><accessor" + quoted("source", "#" + id + "-array") +
          quoted("count", number_of(values.size() / stride)) + quoted("stride", number_of(stride)) + ">";
  for (const char* parameter : parameters)
    text += "<param" + quoted("name", parameter) + quoted("type", matrix ? "float4x4" : "float") + "/>";
  return text + "</accessor></technique_common></source>\n";
}

std::vector<float> flat(const std::vector<Vec3f>& vectors, float steps_in_one) {
  std::vector<float> values;
  for (const Vec3f& v : vectors)
    for (int c = 0; c < 3; ++c) values.push_back(std::round(v[c] * steps_in_one) / steps_in_one);
  return values;
}

std::string geometry(const std::string& id, const Mesh& mesh) {
  std::vector<float> positions;
  for (const Vec3f& p : mesh.positions) positions.insert(positions.end(), {p.x(), p.y(), p.z()});
  std::vector<long> corners;
  for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());

  std::string text = "<geometry" + quoted("id", id) + quoted("name", mesh.parts[0].name) + "><mesh>\n";
  text += float_source(id + "-positions", positions, {"X", "Y", "Z"});
  text += float_source(id + "-normals", flat(mesh.normals, 1e4f), {"X", "Y", "Z"});
  text += "<vertices" + quoted("id", id + "-vertices") + "><input semantic=\"POSITION\"" +
          quoted("source", "#" + id + "-positions") + "/><input semantic=\"NORMAL\"" +
          quoted("source", "#" + id + "-normals") + "/></vertices>\n";
  text += "<triangles" + quoted("count", number_of(mesh.triangles.size())) + quoted("material", id + "-tone") +
          "><input semantic=\"VERTEX\"" + quoted("source", "#" + id + "-vertices") + " offset=\"0\"/><p>" +
          listed(corners) + "</p></triangles>\n";
  return text + "</mesh></geometry>\n";
}

std::string controller(const std::string& geometry_id, const Skeleton& skeleton, const Skin& skin) {
  const std::string id = geometry_id + "-skin";
  std::string joints;
  std::vector<float> binds;
  for (int s = 0; s < skin.slot_count(); ++s) {
    if (s > 0) joints += ' ';
    joints += skeleton.names[skin.slot_joint[s]];
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        binds.push_back(static_cast<float>(skin.inverse_bind[s].matrix()(row, column)));
  }
  // Every distinct weight once; the vertices point to them.
  const std::set<float> distinct(skin.weights.begin(), skin.weights.end());
  const std::vector<float> weights(distinct.begin(), distinct.end());
  std::vector<long> counts, pairs;
  for (std::size_t first = 0; first < skin.slots.size(); first += skin.influences) {
    long count = 0;
    for (std::size_t k = first; k < first + skin.influences; ++k) {
      if (skin.weights[k] <= 0.0f) continue;
      ++count;
      pairs.push_back(skin.slots[k]);
      pairs.push_back(std::lower_bound(weights.begin(), weights.end(), skin.weights[k]) - weights.begin());
    }
    counts.push_back(count);
  }

  std::string text = "<controller" + quoted("id", id) + "><skin" + quoted("source", "#" + geometry_id) + ">\n";
  text += "<bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>\n";
  text += "<source" + quoted("id", id + "-joints") + "><Name_array" + quoted("id", id + "-joints-array") +
          quoted("count", number_of(skin.slot_joint.size())) + ">" + joints +
          "</Name_array>\n<technique_common><accessor" + quoted("source", "#" + id + "-joints-array") +
          quoted("count", number_of(skin.slot_joint.size())) +
          " stride=\"1\"><param name=\"JOINT\" type=\"name\"/></accessor></technique_common></source>\n";
  text += float_source(id + "-binds", binds, {"TRANSFORM"});
  text += float_source(id + "-weights", weights, {"WEIGHT"});
  text += "<joints><input semantic=\"JOINT\"" + quoted("source", "#" + id + "-joints") +
          "/><input semantic=\"INV_BIND_MATRIX\"" + quoted("source", "#" + id + "-binds") + "/></joints>\n";
  text += "<vertex_weights" + quoted("count", number_of(counts.size())) + "><input semantic=\"JOINT\"" +
          quoted("source", "#" + id + "-joints") + " offset=\"0\"/><input semantic=\"WEIGHT\"" +
          quoted("source", "#" + id + "-weights") + " offset=\"1\"/>\n<vcount>" + listed(counts) + "</vcount>\n<v>" +
          listed(pairs) + "</v></vertex_weights>\n";
  return text + "</skin></controller>\n";
}

std::string effect(const std::string& id, const std::array<float, 3>& colour) {
  const std::string diffuse = listed(std::vector<float>{colour[0], colour[1], colour[2], 1.0f});
  return "<effect" + quoted("id", id + "-effect") +
         "><profile_COMMON><technique sid=\"common\"><lambert><diffuse><color sid=\"diffuse\">" + diffuse +
         "</color></diffuse></lambert></technique></profile_COMMON></effect>\n";
}

std::string material(const std::string& id) {
  return "<material" + quoted("id", id + "-material") + "><instance_effect" + quoted("url", "#" + id + "-effect") +
         "/></material>\n";
}

/// A joint with all below it. `prefix` tells the ids of one instance of the skeleton from those of the other; names are
/// alike.
std::string joint_node(const Skeleton& skeleton, int joint, const std::string& prefix) {
  const std::string& name = skeleton.names[joint];
  const Vec3& p = skeleton.rest_local[joint].translation;
  // To a micrometre: the joints are placed in tenths of a millimetre, their differences only nearly.
  const auto micro = [](double x) { return static_cast<float>(std::round(x * 1e6) / 1e6); };
  std::string text = "<node" + quoted("id", prefix + name) + quoted("sid", name) + quoted("name", name) +
                     " type=\"JOINT\"><matrix sid=\"transform\">";
  text += listed(std::vector<float>{1, 0, 0, micro(p.x()), 0, 1, 0, micro(p.y()), 0, 0, 1, micro(p.z()), 0, 0, 0, 1});
  text += "</matrix>\n";
  for (int child = 0; child < skeleton.joint_count(); ++child)
    if (skeleton.parents[child] == joint) text += joint_node(skeleton, child, prefix);
  return text + "</node>\n";
}

std::string skinned_node(const std::string& id, const std::string& transform, const std::string& skeleton_root) {
  return "<node" + quoted("id", id + "-node") + quoted("name", id) + " type=\"NODE\">" + transform +
         "<instance_controller" + quoted("url", "#" + id + "-skin") + "><skeleton>#" + skeleton_root +
         "</skeleton><bind_material><technique_common><instance_material" + quoted("symbol", id + "-tone") +
         quoted("target", "#" + id + "-material") +
         "/></technique_common></bind_material></instance_controller></node>\n";
}

} // namespace

std::string collada_of(const Mannequin& mannequin) {
  const Skeleton& skeleton = mannequin.skeleton;
  const std::string surface = "surface", spheres = "spheres", second = "spheres_";

  std::string text = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
                     "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"
                     "<asset><contributor><authoring_tool>tutu mannequin</authoring_tool></contributor>"
                     "<created>2021-01-01T00:00:00Z</created><modified>2021-01-01T00:00:00Z</modified>"
                     "<unit name=\"meter\" meter=\"1\"/><up_axis>Y_UP</up_axis></asset>\n";
  text += "<library_effects>\n" + effect(surface, mannequin.surface.parts[0].colour) +
          effect(spheres, mannequin.spheres.parts[0].colour) + "</library_effects>\n";
  text += "<library_materials>\n" + material(surface) + material(spheres) + "</library_materials>\n";
  text += "<library_geometries>\n" + geometry(surface, mannequin.surface) + geometry(spheres, mannequin.spheres) +
          "</library_geometries>\n";
  text += "<library_controllers>\n" + controller(surface, skeleton, mannequin.surface_skin) +
          controller(spheres, skeleton, mannequin.sphere_skin) + "</library_controllers>\n";
  text += "<library_visual_scenes><visual_scene id=\"scene\" name=\"dancer\">\n";
  text += joint_node(skeleton, 0, "") + joint_node(skeleton, 0, second);
  text += skinned_node(surface, "", skeleton.names[0]);
  // A skinned mesh hangs on its joints alone: where its own node stands must not matter.
  text += skinned_node(spheres, "<translate>0.3 0 -0.2</translate>", second + skeleton.names[0]);
  text +=
      "</visual_scene></library_visual_scenes>\n<scene><instance_visual_scene url=\"#scene\"/></scene>\n</COLLADA>\n";
  return text;
}

} // namespace tutu::rig
