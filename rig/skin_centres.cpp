// Choosing a skinning method, and the centres of rotation of one of them.
#include "rig/skin.h"

#include "rig/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace tutu::rig {
namespace {

/// The weights of a vertex, or of a triangle (the mean of its corners'), by slot; sparse and in slot order.
using Weights = std::vector<std::pair<int, double>>;
using SlotPair = std::pair<int, int>;

/// Weights below this are rounding of the importer's; they would pair nearly every slot with every other.
constexpr double k_least_weight = 1e-3;

Weights weights_of(const Skin& skin, std::span<const std::uint32_t> vertices) {
  std::map<int, double> sum;
  for (const std::uint32_t vertex : vertices)
    for (int k = 0; k < skin.influences; ++k) {
      const std::size_t entry = static_cast<std::size_t>(vertex) * skin.influences + k;
      sum[skin.slots[entry]] += static_cast<double>(skin.weights[entry]) / static_cast<double>(vertices.size());
    }
  Weights weights;
  for (const auto& [slot, weight] : sum)
    if (weight >= k_least_weight) weights.push_back({slot, weight});
  return weights;
}

/// A triangle as a vertex with two slots in common with it sees it.
struct Patch {
  double weight_j, weight_k; ///< of the two slots, mean of the corners
  double area;               ///< m2
  Vec3 centre;               ///< m, bind pose
};

std::map<SlotPair, std::vector<Patch>> patches_by_pair(const Mesh& mesh, const Skin& skin) {
  std::map<SlotPair, std::vector<Patch>> patches;
  for (const Triangle& triangle : mesh.triangles) {
    const auto corner = [&](int i) { return Vec3(mesh.positions[triangle[i]].cast<double>()); };
    const Vec3 a = corner(0), b = corner(1), c = corner(2);
    const double area = triangle_area(a, b, c);
    const Weights weights = weights_of(skin, triangle);
    for (std::size_t j = 0; j < weights.size(); ++j)
      for (std::size_t k = j + 1; k < weights.size(); ++k)
        patches[{weights[j].first, weights[k].first}].push_back(
            {weights[j].second, weights[k].second, area, (a + b + c) / 3.0});
  }
  return patches;
}

std::vector<Vec3f> centres_of_rotation(const Mesh& mesh, const Skin& skin) {
  constexpr double k_sigma = 0.1; // [Le and Hodgins 2016]: a difference in weights that counts as another place
  const auto patches = patches_by_pair(mesh, skin);
  std::vector<Vec3f> centres = mesh.positions; // whatever moves with one slot turns about any point alike
  for (std::uint32_t vertex = 0; vertex < centres.size(); ++vertex) {
    const Weights weights = weights_of(skin, std::span(&vertex, 1));
    Vec3 sum = Vec3::Zero();
    double total = 0.0;
    for (std::size_t j = 0; j < weights.size(); ++j)
      for (std::size_t k = j + 1; k < weights.size(); ++k) {
        const auto found = patches.find({weights[j].first, weights[k].first});
        if (found == patches.end()) continue;
        const double wj = weights[j].second, wk = weights[k].second;
        for (const Patch& patch : found->second) {
          const double apart = wj * patch.weight_k - wk * patch.weight_j;
          const double exponent = apart * apart / (k_sigma * k_sigma);
          if (exponent > 40.0) continue; // e^-40 of the others
          const double similarity = wj * wk * patch.weight_j * patch.weight_k * std::exp(-exponent);
          sum += similarity * patch.area * patch.centre;
          total += similarity * patch.area;
        }
      }
    if (total > 0.0) centres[vertex] = (sum / total).cast<float>();
  }
  return centres;
}

} // namespace

Skinning skinning_named(std::string_view name) {
  const auto found = std::find(k_skinning_names.begin(), k_skinning_names.end(), name);
  assert(found != k_skinning_names.end());
  return static_cast<Skinning>(found - k_skinning_names.begin());
}

void set_skinning(Skin& skin, const Mesh& mesh, Skinning method, const std::string& file) {
  if (method != Skinning::linear) {
    constexpr double k_most_stretch = 1e-3; // what exporters round away
    for (const Eigen::Affine3d& bind : skin.inverse_bind) {
      const Eigen::Matrix3d linear = bind.linear();
      if ((linear.transpose() * linear - Eigen::Matrix3d::Identity()).norm() > k_most_stretch)
        throw InputError(file, "skin", "a joint bound with a scale", "rigid binds, or skinning linear");
    }
  }
  skin.method = method;
  skin.centres.clear();
  if (method == Skinning::centres_of_rotation) skin.centres = centres_of_rotation(mesh, skin);
}

} // namespace tutu::rig
