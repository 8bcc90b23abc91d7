#include "proxies/crossing/detail/box_tree.h"

#include <algorithm>
#include <numeric>

namespace tutu::proxies {

BoxTree::BoxTree(std::span<const Box> boxes) : items_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0);
  if (!boxes.empty()) build(boxes, 0, static_cast<int>(boxes.size()));
  for (const int item : items_) boxes_.push_back(boxes[item]);
}

void BoxTree::build(std::span<const Box> boxes, int first, int count) {
  constexpr int k_leaf = 4;
  Box all, middles;
  for (int k = first; k < first + count; ++k) {
    all.extend(boxes[items_[k]]);
    middles.extend(boxes[items_[k]].center());
  }
  const std::size_t node = nodes_.size();
  nodes_.push_back({all, first, count, -1});
  if (count <= k_leaf) return;
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
  std::vector<int> open = {0};
  while (!open.empty()) {
    const int index = open.back();
    open.pop_back();
    const Node& node = nodes_[index];
    if (!node.box.intersects(box)) continue;
    if (node.second_child >= 0) {
      open.push_back(index + 1);
      open.push_back(node.second_child);
    } else
      for (int k = node.first; k < node.first + node.count; ++k)
        if (boxes_[k].intersects(box)) found.push_back(items_[k]);
  }
}

} // namespace tutu::proxies
