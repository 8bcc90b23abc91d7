// Rigged Collada files of a few vertices, written by hand for the importer's tests.
#pragma once

#include "rig/character.h"
#include "rig/import/import.h"
#include "tests/support/paths.h"

#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace tutu::test {

using Matrix4 = Eigen::Matrix4d;

inline Matrix4 moved(double x, double y, double z) {
  Matrix4 m = Matrix4::Identity();
  m.topRightCorner<3, 1>() << x, y, z;
  return m;
}
inline Matrix4 scaled(double s) {
  Matrix4 m = Matrix4::Identity();
  m.topLeftCorner<3, 3>() *= s;
  return m;
}
inline Matrix4 turned(double angle, const Vec3& axis) {
  Matrix4 m = Matrix4::Identity();
  m.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  return m;
}

struct TinyNode {
  std::string name; ///< also its sid
  Matrix4 matrix = Matrix4::Identity();
  std::vector<TinyNode> children = {};
  std::string mesh = {}; ///< id of a mesh to hold
};

struct TinyMesh {
  std::string id;
  std::vector<Vec3> positions;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::string> joints = {}; ///< none: no skin
  std::vector<Matrix4> inverse_binds = {};
  std::vector<std::vector<std::pair<int, double>>> weights = {}; ///< a vertex: joint, weight
  Matrix4 bind_shape = Matrix4::Identity();
};

struct TinyTrack {
  std::string node; ///< id
  std::vector<double> times;
  std::vector<Matrix4> matrices;
};

struct TinyFile {
  std::vector<TinyNode> nodes;
  std::vector<TinyMesh> meshes;
  std::vector<TinyTrack> tracks = {};
  std::string up = "Y_UP";
  double unit = 1.0;
};

/// A strip 1.7 high on Hips (at 1) and Head (at 1.5, turned), an end joint above, a container around.
inline TinyFile upright() {
  const Matrix4 hips = moved(0, 1, 0), head = moved(0, 0.5, 0) * turned(0.3, Vec3::UnitX());
  TinyFile file;
  file.nodes = {
      {"Armature", Matrix4::Identity(), {{"Hips", hips, {{"Head", head, {{"HeadTop_End", moved(0, 0.2, 0)}}}}}}},
      {"Body", Matrix4::Identity(), {}, "body"}};
  file.meshes = {{.id = "body",
                  .positions = {{-0.2, 0, 0}, {0.2, 0, 0}, {-0.2, 1.7, 0}, {0.2, 1.7, 0.1}},
                  .triangles = {{0, 1, 2}, {2, 1, 3}},
                  .joints = {"Hips", "Head"},
                  .inverse_binds = {hips.inverse(), (hips * head).inverse()},
                  .weights = {{{0, 1.0}}, {{0, 1.0}}, {{0, 0.25}, {1, 0.75}}, {{1, 1.0}}}}};
  return file;
}

inline std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}
inline std::string digits(const Matrix4& m) {
  std::string text;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) text += (text.empty() ? "" : " ") + digits(m(r, c));
  return text;
}

/// A <source> of floats or names.
inline std::string collada_source(const std::string& id, const std::string& values, std::size_t count, int stride,
                                  const char* type, const char* array = "float_array") {
  return "<source id=\"" + id + "\"><" + array + " id=\"" + id + "-array\" count=\"" +
         std::to_string(count * static_cast<std::size_t>(stride)) + "\">" + values + "</" + array +
         "><technique_common><accessor source=\"#" + id + "-array\" count=\"" + std::to_string(count) + "\" stride=\"" +
         std::to_string(stride) + "\"><param name=\"P\" type=\"" + type +
         "\"/></accessor></technique_common></source>\n";
}

inline std::string collada_geometry(const TinyMesh& mesh) {
  std::string positions, indices;
  for (const Vec3& p : mesh.positions)
    for (int i = 0; i < 3; ++i) positions += (positions.empty() ? "" : " ") + digits(p[i]);
  for (const auto& t : mesh.triangles)
    for (const int i : t) indices += (indices.empty() ? "" : " ") + std::to_string(i);
  std::string source =
      "<source id=\"" + mesh.id + "-p\"><float_array id=\"" + mesh.id + "-pa\" count=\"" +
      std::to_string(3 * mesh.positions.size()) + "\">" + positions +
      "</float_array><technique_common><accessor source=\"#" + mesh.id + "-pa\" count=\"" +
      std::to_string(mesh.positions.size()) +
      "\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
      "type=\"float\"/></accessor></technique_common></source>\n";
  return "<geometry id=\"" + mesh.id + "\" name=\"" + mesh.id + "\"><mesh>" + source + "<vertices id=\"" + mesh.id +
         "-v\"><input semantic=\"POSITION\" source=\"#" + mesh.id + "-p\"/></vertices><triangles count=\"" +
         std::to_string(mesh.triangles.size()) + "\"><input semantic=\"VERTEX\" source=\"#" + mesh.id +
         "-v\" offset=\"0\"/><p>" + indices + "</p></triangles></mesh></geometry>\n";
}

inline std::string collada_skin(const TinyMesh& mesh) {
  const std::string id = mesh.id + "-skin";
  std::string names, binds, values, counts, pairs;
  for (const std::string& joint : mesh.joints) names += (names.empty() ? "" : " ") + joint;
  for (const Matrix4& m : mesh.inverse_binds) binds += (binds.empty() ? "" : " ") + digits(m);
  std::size_t count = 0;
  for (const auto& vertex : mesh.weights) {
    counts += (counts.empty() ? "" : " ") + std::to_string(vertex.size());
    for (const auto& [joint, weight] : vertex) {
      values += (values.empty() ? "" : " ") + digits(weight);
      pairs += (pairs.empty() ? "" : " ") + std::to_string(joint) + " " + std::to_string(count++);
    }
  }
  return "<controller id=\"" + id + "\"><skin source=\"#" + mesh.id + "\"><bind_shape_matrix>" +
         digits(mesh.bind_shape) + "</bind_shape_matrix>\n" +
         collada_source(id + "-j", names, mesh.joints.size(), 1, "name", "Name_array") +
         collada_source(id + "-b", binds, mesh.inverse_binds.size(), 16, "float4x4") +
         collada_source(id + "-w", values, count, 1, "float") + "<joints><input semantic=\"JOINT\" source=\"#" + id +
         "-j\"/><input semantic=\"INV_BIND_MATRIX\" source=\"#" + id + "-b\"/></joints><vertex_weights count=\"" +
         std::to_string(mesh.weights.size()) + "\"><input semantic=\"JOINT\" source=\"#" + id +
         "-j\" offset=\"0\"/><input semantic=\"WEIGHT\" source=\"#" + id + "-w\" offset=\"1\"/><vcount>" + counts +
         "</vcount><v>" + pairs + "</v></vertex_weights></skin></controller>\n";
}

inline std::string collada_node(const TinyNode& node, const std::vector<TinyMesh>& meshes, int& counter) {
  const std::string id = node.name + (counter == 0 ? "" : "-" + std::to_string(counter));
  ++counter;
  std::string text = "<node id=\"" + id + "\" sid=\"" + node.name + "\" name=\"" + node.name + "\" type=\"" +
                     (node.mesh.empty() ? "JOINT" : "NODE") + "\"><matrix sid=\"transform\">" + digits(node.matrix) +
                     "</matrix>";
  for (const TinyMesh& mesh : meshes)
    if (mesh.id == node.mesh)
      text += mesh.joints.empty() ? "<instance_geometry url=\"#" + mesh.id + "\"/>"
                                  : "<instance_controller url=\"#" + mesh.id + "-skin\"/>";
  for (const TinyNode& child : node.children) text += collada_node(child, meshes, counter);
  return text + "</node>\n";
}

inline std::string collada_animation(const TinyTrack& track) {
  const std::string id = "anim-" + track.node;
  std::string times, matrices, modes;
  for (const double t : track.times) times += (times.empty() ? "" : " ") + digits(t);
  for (const Matrix4& m : track.matrices) matrices += (matrices.empty() ? "" : " ") + digits(m);
  for (std::size_t i = 0; i < track.times.size(); ++i) modes += i ? " LINEAR" : "LINEAR";
  return "<animation id=\"" + id + "\">" + collada_source(id + "-i", times, track.times.size(), 1, "float") +
         collada_source(id + "-o", matrices, track.matrices.size(), 16, "float4x4") +
         collada_source(id + "-m", modes, track.times.size(), 1, "name", "Name_array") + "<sampler id=\"" + id +
         "-s\"><input semantic=\"INPUT\" source=\"#" + id + "-i\"/><input semantic=\"OUTPUT\" source=\"#" + id +
         "-o\"/><input semantic=\"INTERPOLATION\" source=\"#" + id + "-m\"/></sampler><channel source=\"#" + id +
         "-s\" target=\"" + track.node + "/transform\"/></animation>\n";
}

/// The document. The first node of the file has its name as id, those after it the name, '-' and their number.
inline std::string collada_text(const TinyFile& file) {
  std::string geometries, controllers, nodes, animations;
  for (const TinyMesh& mesh : file.meshes) {
    geometries += collada_geometry(mesh);
    if (!mesh.joints.empty()) controllers += collada_skin(mesh);
  }
  int counter = 0;
  for (const TinyNode& node : file.nodes) nodes += collada_node(node, file.meshes, counter);
  for (const TinyTrack& track : file.tracks) animations += collada_animation(track);
  if (!animations.empty()) animations = "<library_animations>" + animations + "</library_animations>";
  if (!controllers.empty()) controllers = "<library_controllers>" + controllers + "</library_controllers>";
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset><unit name=\"u\" meter=\"" +
         digits(file.unit) + "\"/><up_axis>" + file.up + "</up_axis></asset>\n<library_geometries>" + geometries +
         "</library_geometries>" + controllers + animations +
         "<library_visual_scenes><visual_scene id=\"Scene\" name=\"Scene\">" + nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#Scene\"/></scene></COLLADA>\n";
}

inline std::filesystem::path write_text(const std::string& name, const std::string& text) {
  const auto file = scratch_folder() / name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

inline rig::Import import_tiny(const TinyFile& file, const rig::ImportOptions& options = {}) {
  return rig::import_character(write_text("tiny.dae", collada_text(file)), options);
}

/// Skinned vertices in m for given joints (model_from_joint), the plain sum over slots.
inline std::vector<Vec3> skinned(const rig::Character& character, const std::vector<Transform>& model) {
  std::vector<Vec3> result;
  for (int v = 0; v < character.mesh.vertex_count(); ++v) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < character.skin.influences; ++k) {
      const auto i = static_cast<std::size_t>(v * character.skin.influences + k);
      const int slot = character.skin.slots[i];
      const Vec3 in_joint = character.skin.inverse_bind[slot] * character.mesh.positions[v].cast<double>();
      sum += static_cast<double>(character.skin.weights[i]) * (model[character.skin.slot_joint[slot]] * in_joint);
    }
    result.push_back(sum);
  }
  return result;
}

} // namespace tutu::test
