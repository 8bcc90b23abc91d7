#include "proxies/crossing/detail/box_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace tutu::proxies {

BoxTree::BoxTree(std::span<const Box> boxes) : items_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0);
  if (!boxes.empty()) build(boxes, 0, static_cast<int>(boxes.size()));
  boxes_.resize(items_.size());
  refit(boxes);
}

void BoxTree::refit(std::span<const Box> boxes) {
  for (std::size_t k = 0; k < items_.size(); ++k) boxes_[k] = boxes[items_[k]];
  for (std::size_t k = nodes_.size(); k-- > 0;) { // children stand behind their parent
    Node& node = nodes_[k];
    node.box.setEmpty();
    if (node.second_child >= 0) {
      node.box.extend(nodes_[k + 1].box);
      node.box.extend(nodes_[node.second_child].box);
    } else
      for (int item = node.first; item < node.first + node.count; ++item) node.box.extend(boxes_[item]);
  }
}

void BoxTree::build(std::span<const Box> boxes, int first, int count) {
  constexpr int k_leaf = 4;
  const std::size_t node = nodes_.size();
  nodes_.push_back({Box(), first, count, -1});
  if (count <= k_leaf) return;
  Box middles;
  for (int k = first; k < first + count; ++k) middles.extend(boxes[items_[k]].center());
  Eigen::Index axis;
  middles.sizes().maxCoeff(&axis);
  const int half = count / 2;
  const auto begin = items_.begin() + first;
  std::nth_element(begin, begin + half, begin + count,
                   [&](int i, int j) { return boxes[i].center()[axis] < boxes[j].center()[axis]; });
  build(boxes, first, half);
  nodes_[node].second_child = static_cast<int>(nodes_.size());
  build(boxes, first + half, count - half);
}

void BoxTree::touching(const Box& box, std::vector<int>& found) const {
  if (nodes_.empty()) return;
  std::array<int, 64> open = {0}; // halves of halves: no deeper than an int has bits
  int count = 1;
  while (count > 0) {
    const int index = open[--count];
    const Node& node = nodes_[index];
    if (!node.box.intersects(box)) continue;
    if (node.second_child >= 0) {
      open[count++] = index + 1;
      open[count++] = node.second_child;
    } else
      for (int k = node.first; k < node.first + node.count; ++k)
        if (boxes_[k].intersects(box)) found.push_back(items_[k]);
  }
}

} // namespace tutu::proxies
