#include "proxies/crossing/segment_triangle.h"

#include "proxies/crossing/orientation.h"

namespace tutu::proxies {
namespace {

/// The sign of step . ((b - a) x (d - c)), step = (e, e^2, e^3): that of the first component that is not 0.
int step_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  for (int axis = 0; axis < 3; ++axis)
    if (const int sign = cross_sign(a, b, c, d, axis)) return sign;
  return 0;
}

/// On which side of the triangle an end of the segment is. The volume is linear in the step: by step . normal.
int side_of(const Vec3& end, const Vec3& t0, const Vec3& t1, const Vec3& t2, int step) {
  if (const int side = orientation(t0, t1, t2, end)) return side;
  return step * step_sign(t0, t1, t0, t2);
}

/// How the segment's line turns about the line of an edge. Linear in the step as well: by -step . ((j - i) x (q - p)).
int turn_about(const Vec3& p, const Vec3& q, const Vec3& i, const Vec3& j, int step) {
  if (const int turn = orientation(p, q, i, j)) return turn;
  return -step * step_sign(i, j, p, q);
}

} // namespace

int passage_through(const Vec3& p, const Vec3& q, const Vec3& t0, const Vec3& t1, const Vec3& t2, Beside beside) {
  const int step = static_cast<int>(beside);
  const int from = side_of(p, t0, t1, t2, step), way = side_of(q, t0, t1, t2, step);
  if (from != -way || way == 0) return 0;
  const bool within = turn_about(p, q, t0, t1, step) == way && turn_about(p, q, t1, t2, step) == way &&
                      turn_about(p, q, t2, t0, step) == way;
  return within ? way : 0;
}

} // namespace tutu::proxies
