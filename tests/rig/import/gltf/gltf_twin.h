// A second opinion on what a glTF 2.0 file shows: an evaluator written from the specification, one element and one
// vertex after the other. Nothing in it is shared with the reader.
#pragma once

#include "rig/math.h"

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tutu::test {

class GltfTwin {
public:
  explicit GltfTwin(const std::filesystem::path& file);

  std::size_t animations() const { return list("animations").size(); }
  double end_of(std::size_t animation); ///< s: the last key of a channel that moves a node
  /// Corners of all triangles that the default scene draws, three a triangle, node by node as the tree has them (parent
  /// first), primitive by primitive. `animation` -1: as the nodes stand.
  std::vector<Vec3> corners(int animation, double time);
  bool has_skin() const;

private:
  using json = nlohmann::json;
  using Matrix4 = Eigen::Matrix4d;
  struct Numbers {
    std::size_t width = 0;
    std::vector<double> all;
    double at(std::size_t element, std::size_t k) const { return all.at(element * width + k); }
    std::size_t count() const { return all.size() / width; }
  };
  struct Compressed { ///< a primitive of KHR_draco_mesh_compression
    std::vector<std::size_t> indices;
    std::map<std::string, Numbers> attributes;
  };

  const json& list(const char* name) const;
  std::string buffer(std::size_t index) const;
  const std::string& view(std::size_t index);
  const Numbers& accessor(std::size_t index);
  const Compressed& compressed(std::size_t mesh, std::size_t primitive);

  /// Of the sampler at a time, all components.
  std::vector<double> sampled(const json& sampler, double time, bool is_rotation);
  std::vector<Matrix4> globals(int animation, double time);
  void draw(std::size_t node, const std::vector<Matrix4>& globals, std::vector<Vec3>& to);
  std::vector<std::size_t> triangle_indices(const json& primitive, std::size_t vertices);
  std::vector<Vec3> posed(std::size_t node, std::size_t primitive, const std::vector<Matrix4>& globals);

  std::filesystem::path file_;
  json root_;
  std::string binary_;
  std::map<std::size_t, std::string> views_;
  std::map<std::size_t, Numbers> accessors_;
  std::map<std::pair<std::size_t, std::size_t>, Compressed> compressed_;
};

} // namespace tutu::test
