#include "proxies/crossing/segment_passages.h"

#include "proxies/crossing/orientation.h"

#include <array>

namespace tutu::proxies {
namespace {

/// A corner of the image: head - tail, never rounded.
struct Corner {
  const Vec3 *tail, *head;

  bool rises() const { return head->z() > tail->z(); }
};

/// What the side u v adds to how often a triangle, seen against x, goes round 0: one where it passes the half line
/// towards +y upwards, -1 downwards. 0 is beside its place by the step, so that nothing goes through it.
int turn(const Corner& u, const Corner& v) {
  if (u.rises() == v.rises()) return 0;
  const int way = v.rises() ? 1 : -1;
  return cross_sign(*u.tail, *u.head, *v.tail, *v.head, 0) == way ? way : 0;
}

/// Whether a ray from 0 along x leaves through the triangle's front (1) or back (-1), or does not meet it.
int hit(const Corner& u, const Corner& v, const Corner& w) {
  const int way = turn(u, v) + turn(v, w) + turn(w, u);
  if (way == 0) return 0;
  return volume_sign(*u.tail, *u.head, *v.tail, *v.head, *w.tail, *w.head) == way ? way : 0;
}

/// Whether the boxes around both motions are apart.
bool apart(const MovingPoint& p, const MovingPoint& q, const MovingPoint& a, const MovingPoint& b) {
  const Vec3 low = p.from.cwiseMin(p.to).cwiseMin(q.from).cwiseMin(q.to);
  const Vec3 high = p.from.cwiseMax(p.to).cwiseMax(q.from).cwiseMax(q.to);
  const Vec3 other_low = a.from.cwiseMin(a.to).cwiseMin(b.from).cwiseMin(b.to);
  const Vec3 other_high = a.from.cwiseMax(a.to).cwiseMax(b.from).cwiseMax(b.to);
  return (low.array() > other_high.array()).any() || (high.array() < other_low.array()).any();
}

} // namespace

int net_passages(const MovingPoint& p, const MovingPoint& q, const MovingPoint& a, const MovingPoint& b) {
  if (apart(p, q, a, b)) return 0;
  const auto corner = [&](const std::array<int, 3>& at) { // s, r, t
    const MovingPoint &head = at[0] ? q : p, &tail = at[1] ? b : a;
    return at[2] ? Corner{&tail.to, &head.to} : Corner{&tail.from, &head.from};
  };
  int degree = 0;
  for (int k = 0; k < 3; ++k)
    for (int side = 0; side < 2; ++side) {
      std::array<Corner, 4> quad; // its front away from side 0
      for (int c = 0; c < 4; ++c) {
        std::array<int, 3> at;
        at[k] = side;
        at[(k + 1) % 3] = c == 1 || c == 2;
        at[(k + 2) % 3] = c >= 2;
        quad[c] = corner(at);
      }
      const int hits = hit(quad[0], quad[1], quad[2]) + hit(quad[0], quad[2], quad[3]);
      degree += side ? hits : -hits;
    }
  return -degree; // along t the volume rises where F turns a frame round
}

} // namespace tutu::proxies
