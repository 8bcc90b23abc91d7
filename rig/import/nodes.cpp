// The nodes of a file, and small words for reports.
#include "rig/error.h"
#include "rig/import/detail/parts.h"

#include <Eigen/SVD>

namespace tutu::rig::import_detail {

Polar polar(const Matrix3& linear) {
  const Eigen::JacobiSVD<Matrix3> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 rotation = svd.matrixU() * svd.matrixV().transpose();
  if (rotation.determinant() < 0.0) rotation = -rotation;
  return {Quat(rotation).normalized(), rotation.transpose() * linear};
}

bool is_uniform(const Matrix3& stretch) {
  const double scale = stretch.trace() / 3.0;
  return (stretch - scale * Matrix3::Identity()).cwiseAbs().maxCoeff() <= 1e-3 * std::abs(scale);
}

std::vector<Node> walk(const FileScene& scene) {
  std::vector<Node> nodes;
  nodes.reserve(scene.nodes.size());
  for (const FileNode& from : scene.nodes) {
    Node node;
    node.name = from.name;
    node.parent = from.parent;
    node.local = from.local;
    node.global = from.parent < 0 ? from.local : nodes[from.parent].global * from.local;
    if (!node.global.matrix().allFinite())
      throw InputError(scene.file, "node " + node.name, "a non-finite transform", "finite numbers");
    node.split = polar(node.global.linear());
    node.is_aid = from.is_aid;
    nodes.push_back(std::move(node));
  }
  for (const FileInstance& instance : scene.instances) nodes[instance.node].holds_mesh = true;
  return nodes;
}

std::string count_of(std::size_t count, const std::string& noun) {
  if (count == 1) return "1 " + noun;
  return std::to_string(count) + " " + (noun == "vertex" ? "vertices" : noun == "mesh" ? "meshes" : noun + "s");
}

std::string list_of(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (i ? ", " : "") + names[i];
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

} // namespace tutu::rig::import_detail
