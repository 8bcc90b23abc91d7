// One mesh and one skin from all surfaces: vertices in metres, slots shared, weights cut to the limit, vertices welded.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/import.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>

namespace tutu::rig::import_detail {
namespace {

constexpr double k_same_bind = 1e-6; ///< entries of inverse binds (m) nearer than this are one slot
/// Entries of a bind pose (m) nearer than this to the rest pose are the rest pose: ten times what float matrices of a
/// file in centimetres resolve, a hundredth of what one can see. Larger than k_same_bind.
constexpr double k_bound_at_rest = 1e-5;
constexpr int k_most_slots = 65'535; // Skin::slots is 16 bits wide
constexpr int k_most_influences = 8;

/// A vertex as it is compared: two are one when all of it is equal, bit by bit.
struct Vertex {
  Vec3f position;
  std::array<std::uint16_t, k_most_influences> slots{};
  std::array<float, k_most_influences> weights{};

  auto key() const { return std::tie(position.x(), position.y(), position.z(), slots, weights); }
};

/// Adds surfaces to the character one after the other.
class MeshBuilder {
public:
  MeshBuilder(const std::vector<Node>& nodes, const Conversion& conversion, const ImportOptions& options,
              Character& character, ImportReport& report)
      : file_(character.file), nodes_(nodes), conversion_(conversion), rest_(rest_model(character.skeleton)),
        mesh_(character.mesh), skin_(character.skin), report_(report) {
    skin_.influences = options.max_influences;
  }

  void add(const Surface& surface) {
    const Affine model_from_vertex = placement(surface);
    const std::vector<int> slots = slots_of(surface, model_from_vertex);
    const std::vector<Vertex> vertices = vertices_of(surface, model_from_vertex, slots);
    append(surface, model_from_vertex, vertices);
    report_.file_vertices += static_cast<int>(surface.mesh->positions.size());
  }

  void finish() {
    if (mesh_.triangles.empty()) throw InputError(file_, "", "no triangle", "a mesh with triangles");
    note(unused_, "vertex", "not used by any triangle left out");
    note(degenerate_, "triangle", "without area (a corner twice) dropped");
    note(loose_, "point or line", "dropped");
    if (report_.cut_vertices > 0)
      report_.notes.push_back(count_of(static_cast<std::size_t>(report_.cut_vertices), "vertex") + " cut to " +
                              std::to_string(skin_.influences) + " influences");
    if (inside_out_ > 0) note(inside_out_, "mesh", "mirrored by its bind pose, triangles turned round");
  }

private:
  void note(std::size_t count, const char* noun, const char* what) {
    if (count > 0) report_.notes.push_back(count_of(count, noun) + " " + what);
  }

  /// metres_from_file * node global * inverse bind at rest, seen from the joint: model_from_vertex for one binding.
  Affine joint_from_vertex(const Binding& binding) const {
    const Node& node = nodes_[binding.node];
    Affine stretch = Affine::Identity();
    stretch.linear() = conversion_.scale * node.split.stretch;
    return stretch * binding.inverse_bind;
  }
  Affine model_from_joint(const Binding& binding) const {
    const Transform& rest = rest_[nodes_[binding.node].joint];
    Affine result = Affine::Identity();
    result.linear() = rest.rotation.toRotationMatrix();
    result.translation() = rest.translation;
    return result;
  }

  /// Where the mesh stands in model space when bound: as its dominant joint carries it at rest.
  Affine placement(const Surface& surface) {
    const Binding& binding = surface.bindings[surface.dominant];
    const Affine result = model_from_joint(binding) * joint_from_vertex(binding);
    const double determinant = result.linear().determinant();
    const double size = result.linear().norm();
    if (!result.matrix().allFinite() || !(std::abs(determinant) > 1e-12 * size * size * size))
      throw InputError(file_, "mesh " + surface.mesh->name, "a bind pose that flattens it",
                       "matrices that can be inverted");
    if (determinant < 0.0) ++inside_out_;
    return result;
  }

  /// The palette slot of each binding that has a weight.
  std::vector<int> slots_of(const Surface& surface, const Affine& model_from_vertex) {
    std::vector<bool> used(surface.bindings.size(), false);
    for (const Influence& influence : surface.influences) used[influence.binding] = true;
    const Affine vertex_from_model = model_from_vertex.inverse();
    std::vector<int> slots(surface.bindings.size(), -1);
    for (std::size_t b = 0; b < slots.size(); ++b) {
      if (!used[b]) continue;
      const Binding& binding = surface.bindings[b];
      Affine inverse_bind = joint_from_vertex(binding) * vertex_from_model;
      const Affine at_rest = model_from_joint(binding).inverse(Eigen::Isometry);
      if ((inverse_bind.matrix() - at_rest.matrix()).cwiseAbs().maxCoeff() <= k_bound_at_rest) inverse_bind = at_rest;
      if (!inverse_bind.matrix().allFinite())
        throw InputError(file_, "mesh " + surface.mesh->name + ", joint " + nodes_[binding.node].name,
                         "an inverse bind matrix out of all measure", "finite numbers");
      slots[b] = slot(nodes_[binding.node].joint, inverse_bind);
    }
    return slots;
  }

  int slot(int joint, const Affine& inverse_bind) {
    for (int s = 0; s < skin_.slot_count(); ++s)
      if (skin_.slot_joint[s] == joint &&
          (skin_.inverse_bind[s].matrix() - inverse_bind.matrix()).cwiseAbs().maxCoeff() <= k_same_bind)
        return s;
    if (skin_.slot_count() >= k_most_slots)
      throw InputError(file_, "", "more than " + std::to_string(k_most_slots) + " bindings", "fewer");
    skin_.slot_joint.push_back(joint);
    skin_.inverse_bind.push_back(inverse_bind);
    return skin_.slot_count() - 1;
  }

  std::vector<Vertex> vertices_of(const Surface& surface, const Affine& model_from_vertex,
                                  const std::vector<int>& slots) {
    std::vector<Vertex> vertices(surface.mesh->positions.size());
    std::vector<std::pair<int, double>> shares; // slot, weight
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Vec3 position = model_from_vertex * surface.mesh->positions[v].cast<double>();
      vertices[v].position = position.cast<float>() + Vec3f::Zero(); // -0 becomes 0
      if (!is_in_bounds(position))
        throw InputError(file_, "mesh " + surface.mesh->name,
                         "a position out of all measure of vertex " + std::to_string(v),
                         "finite numbers within +-1e9 m");
      shares.clear();
      for (int i = surface.first[v]; i < surface.first[v + 1]; ++i) {
        const int s = slots[surface.influences[i].binding];
        const auto same =
            std::find_if(shares.begin(), shares.end(), [&](const auto& share) { return share.first == s; });
        if (same == shares.end()) shares.emplace_back(s, surface.influences[i].weight);
        else same->second += surface.influences[i].weight;
      }
      set_weights(shares, vertices[v]);
    }
    return vertices;
  }

  /// The largest shares, falling, summing to 1 again; what is lost is reported.
  void set_weights(std::vector<std::pair<int, double>>& shares, Vertex& vertex) {
    std::sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) {
      return a.second != b.second ? a.second > b.second : a.first < b.first;
    });
    report_.largest_influences = std::max(report_.largest_influences, static_cast<int>(shares.size()));
    const std::size_t kept = std::min(shares.size(), static_cast<std::size_t>(skin_.influences));
    double sum = 0.0;
    for (std::size_t k = 0; k < kept; ++k) sum += shares[k].second;
    if (kept < shares.size()) {
      ++report_.cut_vertices;
      report_.largest_cut = std::max(report_.largest_cut, 1.0 - sum);
    }
    for (std::size_t k = 0; k < kept; ++k) {
      vertex.slots[k] = static_cast<std::uint16_t>(shares[k].first);
      vertex.weights[k] = static_cast<float>(shares[k].second / sum);
    }
  }

  /// For each vertex the first one equal to it.
  static std::vector<unsigned> weld(const std::vector<Vertex>& vertices) {
    std::vector<unsigned> order(vertices.size()), first(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](unsigned a, unsigned b) {
      const auto key_a = vertices[a].key(), key_b = vertices[b].key();
      return key_a != key_b ? key_a < key_b : a < b;
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool same = i > 0 && vertices[order[i]].key() == vertices[order[i - 1]].key();
      first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
  }

  void append(const Surface& surface, const Affine& model_from_vertex, const std::vector<Vertex>& vertices) {
    const FileMesh& mesh = *surface.mesh;
    const std::vector<unsigned> welded = weld(vertices);
    const bool turn = model_from_vertex.linear().determinant() < 0.0;
    std::vector<Triangle> triangles, corners; // welded, and as in the file
    loose_ += mesh.loose;
    for (Triangle corner : mesh.triangles) {
      if (turn) std::swap(corner[1], corner[2]);
      const Triangle triangle = {welded[corner[0]], welded[corner[1]], welded[corner[2]]};
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        ++degenerate_;
        continue;
      }
      triangles.push_back(triangle);
      corners.push_back(corner);
    }
    std::vector<Vec3f> normals = smooth_normals(mesh, model_from_vertex, vertices, triangles, corners);

    constexpr std::uint32_t k_unused = ~0u;
    std::vector<std::uint32_t> place(vertices.size(), k_unused);
    for (const Triangle& triangle : triangles)
      for (const std::uint32_t v : triangle) place[v] = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (place[v] == k_unused) {
        if (welded[v] == v) ++unused_;
        continue;
      }
      place[v] = static_cast<std::uint32_t>(mesh_.positions.size());
      mesh_.positions.push_back(vertices[v].position);
      mesh_.normals.push_back(normals[v]);
      for (int k = 0; k < skin_.influences; ++k) {
        skin_.slots.push_back(vertices[v].slots[k]);
        skin_.weights.push_back(vertices[v].weights[k]);
      }
    }
    MeshPart part{mesh.name, static_cast<std::uint32_t>(mesh_.triangles.size()),
                  static_cast<std::uint32_t>(triangles.size()), mesh.colour};
    for (const Triangle& t : triangles) mesh_.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    if (!triangles.empty()) mesh_.parts.push_back(std::move(part));
  }

  /// Normals of the file, put together over each welded vertex by corner angle; those of the triangles where the file
  /// has none.
  static std::vector<Vec3f> smooth_normals(const FileMesh& mesh, const Affine& model_from_vertex,
                                           const std::vector<Vertex>& vertices, const std::vector<Triangle>& triangles,
                                           const std::vector<Triangle>& corners) {
    std::vector<Vec3f> positions(vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) positions[v] = vertices[v].position;
    if (mesh.normals.empty()) return angle_weighted_normals(positions, triangles);
    const Matrix3 cofactor = model_from_vertex.linear().inverse().transpose();
    std::vector<Vec3> sum(vertices.size(), Vec3::Zero());
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 here = positions[triangles[t][c]].cast<double>();
        const Vec3 a = positions[triangles[t][(c + 1) % 3]].cast<double>() - here;
        const Vec3 b = positions[triangles[t][(c + 2) % 3]].cast<double>() - here;
        const Vec3 normal = cofactor * mesh.normals[corners[t][c]].cast<double>();
        const double length = normal.norm();
        if (std::isfinite(length) && length > 0.0)
          sum[triangles[t][c]] += std::atan2(a.cross(b).norm(), a.dot(b)) / length * normal;
      }
    std::vector<Vec3f> normals(vertices.size());
    for (std::size_t v = 0; v < sum.size(); ++v)
      normals[v] = sum[v].norm() > 1e-12 ? Vec3f(sum[v].normalized().cast<float>()) : Vec3f::UnitY();
    return normals;
  }

  const std::string& file_;
  const std::vector<Node>& nodes_;
  const Conversion& conversion_;
  const std::vector<Transform> rest_;
  Mesh& mesh_;
  Skin& skin_;
  ImportReport& report_;
  std::size_t unused_ = 0, degenerate_ = 0, loose_ = 0, inside_out_ = 0;
};

} // namespace

void build_mesh(const std::vector<Node>& nodes, const std::vector<Surface>& surfaces, const Conversion& conversion,
                const ImportOptions& options, Character& character, ImportReport& report) {
  MeshBuilder builder(nodes, conversion, options, character, report);
  for (const Surface& surface : surfaces) builder.add(surface);
  builder.finish();
}

} // namespace tutu::rig::import_detail
