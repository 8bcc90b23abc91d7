// Private to the importer: a file as its reader understood it, whatever its format. A reader fills a FileScene; what
// becomes of it is the same for all (parts.h).
//
// `file` space: unit and axes of the file, unless the reader says that it has applied them. Every index is in range and
// every number finite: readers throw InputError instead.
#pragma once

#include "rig/curve.h"
#include "rig/mesh.h"

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tutu::rig::import_detail {

using Matrix3 = Eigen::Matrix3d;
using Affine = Eigen::Affine3d;

struct FileNode {
  std::string name;                  ///< for people: any text, perhaps another node's too
  int parent = -1;                   ///< smaller than the node's own index; -1 for node 0 alone
  Affine local = Affine::Identity(); ///< parent_from_node as the file has it: the "node pose"
  bool is_aid = false;               ///< a camera or a light
};

/// One way a mesh hangs on a node: file = sum_k w_k global_k inverse_bind_k vertex.
struct Binding {
  int node = -1;
  Affine inverse_bind; ///< node_from_vertex
};
struct Influence {
  int binding = -1; ///< of the skin the mesh is drawn with
  double weight = 0.0;
};

/// Vertices and triangles with one material. The influences of vertex v are influences[first[v]] up to
/// influences[first[v + 1]], weights above 0 in any sum; both empty in a mesh that carries none.
struct FileMesh {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals; ///< one a position, or none; any length
  std::vector<Triangle> triangles;
  std::size_t loose = 0; ///< points and lines, left out
  std::array<float, 3> colour = MeshPart{}.colour;
  std::vector<int> first;
  std::vector<Influence> influences;
};

/// A mesh where it is drawn: once a node that holds it, and of a mesh with skins once a skin.
struct FileInstance {
  int mesh = -1, node = -1;
  std::vector<Binding> skin = {}; ///< empty: it moves with its node
  /// The space the inverse binds were made in, as far as the file tells it: bound_from_vertex.
  Affine bind_shape = Affine::Identity();
};

/// One node of one animation: parent_from_node, file's unit, s. A curve without keys: as the node stands.
struct NodeMotion {
  int node = -1;
  VectorCurve translation;
  RotationCurve rotation;
  VectorCurve scale;
};
struct FileAnimation {
  std::string name;               ///< may be empty
  double start = 0.0, end = 0.0;  ///< s, as the file has its time line
  std::vector<NodeMotion> nodes;  ///< rising nodes
  std::vector<std::string> notes; ///< of what it could not say as it stands in the file; read behind its name
};

struct FileScene {
  std::string file;
  std::string format;
  std::optional<double> metres_per_unit; ///< as the file says, if it does
  std::optional<char> up_axis;           ///< 'X', 'Y' or 'Z', as the file says, if it does
  bool already_applied = false;          ///< both are in the root node's transform
  std::vector<FileNode> nodes;           ///< node 0 is the root of all others
  std::vector<FileMesh> meshes;
  std::vector<FileInstance> instances;
  std::vector<FileAnimation> animations;
  std::vector<std::string> notes;
};

} // namespace tutu::rig::import_detail
