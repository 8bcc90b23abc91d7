#include "proxies/body/detail/mesh_mend.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace tutu::proxies {
namespace {

using Box = Eigen::AlignedBox3d;

/// So large a share of an open shell's triangles may be turned back: which side is outside only their number tells.
constexpr double k_most_of_open = 0.1;

class Shells {
public:
  Shells(std::span<const Vec3> positions, std::vector<rig::Triangle>& triangles, MeshTopology& topology)
      : positions_(positions), triangles_(triangles), topology_(topology), boxes_(topology.shells()) {
    for (int s = 0; s < topology.shells(); ++s)
      for (const int t : topology.shell(s))
        for (const std::uint32_t v : triangles[t]) boxes_[s].extend(positions[v]);
  }

  int mend(int shell) {
    const std::span<const int> own = topology_.shell(shell);
    const int size = static_cast<int>(own.size());
    const int turned = static_cast<int>(std::ranges::count_if(own, [&](int t) { return topology_.turned[t]; }));
    const bool in_doubt = !topology_.closed[shell] && turned > k_most_of_open * size;
    if (turned == 0 || topology_.one_sided[shell] || in_doubt) return 0;
    for (const int t : own)
      if (topology_.turned[t]) turn(t);
    if (!topology_.closed[shell] || volume(shell) >= 0.0 || may_be_inside_another(shell)) return turned;
    for (const int t : own) turn(t); // the few were right
    return size - turned;
  }

private:
  void turn(int t) {
    std::swap(triangles_[t][1], triangles_[t][2]);
    std::swap(topology_.corners[t][1], topology_.corners[t][2]);
    topology_.turned[t] = false;
  }

  /// By the divergence theorem; about the middle of its box, where digits are not lost.
  double volume(int shell) const {
    const Vec3 middle = boxes_[shell].center();
    double sum = 0.0;
    for (const int t : topology_.shell(shell)) {
      const auto& [a, b, c] = triangles_[t];
      sum += (positions_[a] - middle).dot((positions_[b] - middle).cross(positions_[c] - middle)) / 6.0;
    }
    return sum;
  }

  /// Where it may bound a cavity, whose volume is negative.
  bool may_be_inside_another(int shell) const {
    for (std::size_t other = 0; other < boxes_.size(); ++other)
      if (static_cast<int>(other) != shell && boxes_[other].contains(boxes_[shell])) return true;
    return false;
  }

  std::span<const Vec3> positions_;
  std::vector<rig::Triangle>& triangles_;
  MeshTopology& topology_;
  std::vector<Box> boxes_;
};

} // namespace

int mend_turned_triangles(std::span<const Vec3> positions, std::vector<rig::Triangle>& triangles,
                          MeshTopology& topology) {
  if (std::ranges::find(topology.turned, true) == topology.turned.end()) return 0;
  Shells shells(positions, triangles, topology);
  int mended = 0;
  for (int s = 0; s < topology.shells(); ++s) mended += shells.mend(s);
  return mended;
}

} // namespace tutu::proxies
