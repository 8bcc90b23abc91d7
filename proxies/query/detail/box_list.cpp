#include "proxies/query/detail/box_list.h"

#include "proxies/motion/collider_motion.h"

namespace tutu::proxies {

void BoxList::update(std::span<const Capsule> start, std::span<const Capsule> end) {
  for (int axis = 0; axis < 3; ++axis) {
    low_[axis].resize(start.size());
    high_[axis].resize(start.size());
  }
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Box box = swept_box(start[i], end[i]);
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis][i] = box.min()[axis];
      high_[axis][i] = box.max()[axis];
    }
  }
}

void BoxList::overlaps(const Box& box, std::vector<int>& out) const {
  const std::size_t count = low_[0].size(), row = out.size();
  out.resize(row + count);
  const Vec3 low = box.min(), high = box.max();
  const double *x_low = low_[0].data(), *y_low = low_[1].data(), *z_low = low_[2].data();
  const double *x_high = high_[0].data(), *y_high = high_[1].data(), *z_high = high_[2].data();
  int* next = out.data() + row; // written always, advanced on a hit: no branch to guess wrong
  for (std::size_t i = 0; i < count; ++i) {
    *next = static_cast<int>(i);
    next += (x_low[i] <= high.x()) & (x_high[i] >= low.x()) & (y_low[i] <= high.y()) & (y_high[i] >= low.y()) &
            (z_low[i] <= high.z()) & (z_high[i] >= low.z());
  }
  out.resize(static_cast<std::size_t>(next - out.data()));
}

} // namespace tutu::proxies
