#include "cloth/detail/woven_seams.h"

#include "cloth/detail/colouring.h"
#include "cloth/detail/solver_parts.h"

#include <algorithm>
#include <limits>

namespace tutu::cloth {

template <class T> WovenSeams<T>::WovenSeams(const Garment& garment) : garment_(&garment) {
  if (garment.seams.empty()) return;
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  const std::size_t count = garment.rest_positions.size();
  std::vector<int> sewn_to(count, -1);
  std::vector<int> reach(count, std::numeric_limits<int>::max()); // threads to the nearest seam
  for (const Seam& seam : garment.seams) {
    shares_.push_back(static_cast<T>(share_of_second(garment, pinned, seam)));
    sewn_to[seam.i] = seam.j;
    sewn_to[seam.j] = seam.i;
    reach[seam.i] = reach[seam.j] = 0;
  }
  const std::span<const Spring> threads = std::span(garment.springs).first(garment.structural_count);
  for (int k = 1; k <= k_seam_reach; ++k)
    for (const Spring& thread : threads)
      for (const auto& [from, to] : {std::pair(thread.i, thread.j), std::pair(thread.j, thread.i)})
        if (reach[from] == k - 1) reach[to] = std::min(reach[to], k);
  std::vector<int> nodes(count, -1);
  const auto node_of = [&](int particle) {
    if (nodes[particle] >= 0) return nodes[particle];
    Node node{particle, sewn_to[particle], 0.0, Vec3::Zero()};
    const bool is_held = pinned[particle] || (node.sewn >= 0 && pinned[node.sewn]);
    const double mass = garment.masses[particle] + (node.sewn >= 0 ? garment.masses[node.sewn] : 0.0);
    if (!is_held) node.inverse_mass = 1.0 / mass;
    nodes[particle] = static_cast<int>(nodes_.size());
    if (node.sewn >= 0) nodes[node.sewn] = nodes[particle];
    nodes_.push_back(node);
    return nodes[particle];
  };
  std::vector<Thread> around;
  std::vector<int> ends;
  for (const Spring& thread : threads) {
    if (std::min(reach[thread.i], reach[thread.j]) >= k_seam_reach) continue;
    const int a = node_of(thread.i), b = node_of(thread.j);
    if (!(nodes_[a].inverse_mass + nodes_[b].inverse_mass > 0.0)) continue;
    around.push_back({thread.i, thread.j, a, b, 0.0});
    ends.insert(ends.end(), {a, b});
  }
  // By colours, so that none waits for the root of the one before.
  for (const int k : colour(ends, 2, static_cast<int>(nodes_.size())).order) threads_.push_back(around[k]);
}

template <class T> void WovenSeams<T>::join(WovenSheet<T>& sheet) const {
  for (std::size_t k = 0; k < shares_.size(); ++k) sheet.join(garment_->seams[k].i, garment_->seams[k].j, shares_[k]);
}

template <class T> void WovenSeams<T>::close(WovenSheet<T>& sheet) {
  for (Thread& thread : threads_) thread.length = (sheet.position(thread.j) - sheet.position(thread.i)).norm();
  join(sheet);
  for (Node& node : nodes_) node.x = sheet.position(node.particle);
  for (int sweep = 0; sweep < k_sweeps; ++sweep)
    for (const Thread& thread : threads_) {
      Node &a = nodes_[thread.a], &b = nodes_[thread.b];
      const Vec3 along = b.x - a.x;
      const double length = along.norm();
      if (!(length > 0.0)) continue;
      const Vec3 pull = (length - thread.length) / (length * (a.inverse_mass + b.inverse_mass)) * along;
      a.x += a.inverse_mass * pull;
      b.x -= b.inverse_mass * pull;
    }
  for (const Node& node : nodes_) {
    if (!(node.inverse_mass > 0.0)) continue;
    sheet.move_to(node.particle, node.x);
    if (node.sewn >= 0) sheet.move_to(node.sewn, node.x);
  }
}

template class WovenSeams<float>;
template class WovenSeams<double>;

} // namespace tutu::cloth
