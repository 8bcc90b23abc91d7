// A tree of boxes over things that do not move while it is asked; between questions they may.
#pragma once

#include "proxies/shapes.h"

#include <span>
#include <vector>

namespace tutu::proxies {

class BoxTree {
public:
  /// Boxes are finite; an empty one (Box()) is never found.
  explicit BoxTree(std::span<const Box> boxes);

  /// The same things are there now. The tree keeps its shape: good as long as what was near stays near.
  void refit(std::span<const Box> boxes);

  /// Appends the indices of the boxes that share a point with `box`, in no order to rely on.
  void touching(const Box& box, std::vector<int>& found) const;

private:
  struct Node {
    Box box;
    int first, count; ///< of items_ in a leaf
    int second_child; ///< -1 in a leaf; the first child is the next node
  };

  void build(std::span<const Box> boxes, int first, int count);

  std::vector<Node> nodes_;
  std::vector<int> items_;
  std::vector<Box> boxes_; ///< in the order of items_
};

} // namespace tutu::proxies
