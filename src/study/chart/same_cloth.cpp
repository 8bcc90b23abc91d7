#include "src/study/chart/same_cloth.h"

#include "proxies/body/point_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tutu::app {
namespace {

/// A place between two of a side's particles.
struct Between {
  int first = 0, second = 0;
  double share = 0.0; ///< of the second
};

/// Of particle `index` of `to` a side, among `from` of them; `shut`: the last is a neighbour of the first.
Between between(int index, int to, int from, bool shut) {
  const double cells_to = shut ? to : to - 1, cells_from = shut ? from : from - 1;
  const double place = index * cells_from / cells_to;
  const int first = std::min(static_cast<int>(place), static_cast<int>(cells_from) - 1);
  return {first, (first + 1) % from, place - first};
}

/// Triangles of a posed garment, each with a ball around it.
class Surface {
public:
  Surface(const cloth::Garment& garment, std::span<const Vec3> positions) {
    for (const auto& t : garment.triangles) {
      const Vec3 a = positions[t[0]], b = positions[t[1]], c = positions[t[2]];
      const Vec3 centre = (a + b + c) / 3.0;
      const double radius = std::max({(a - centre).norm(), (b - centre).norm(), (c - centre).norm()});
      triangles_.push_back({a, b, c, centre, radius});
    }
  }

  double distance(const Vec3& p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& t : triangles_) {
      const double reach = nearest + t.radius;
      if ((p - t.centre).squaredNorm() >= reach * reach) continue; // no point of it is nearer
      nearest = std::min(nearest, proxies::nearest_on_triangle(p, t.a, t.b, t.c).distance);
    }
    return nearest;
  }

private:
  struct Triangle {
    Vec3 a, b, c, centre;
    double radius;
  };
  std::vector<Triangle> triangles_;
};

} // namespace

std::vector<Vec3> positions_on(const cloth::Garment& from, std::span<const Vec3> positions, const cloth::Garment& to) {
  if (from.rows == to.rows && from.columns == to.columns && from.particle_count() == to.particle_count())
    return {positions.begin(), positions.end()};
  if (from.rows == 0 || to.rows == 0 || from.woven_shut != to.woven_shut)
    throw std::invalid_argument(to.name + " is another garment, or one without rows and columns");
  std::vector<Vec3> result;
  result.reserve(to.rest_positions.size());
  for (int row = 0; row < to.rows; ++row) {
    const Between r = between(row, to.rows, from.rows, false);
    for (int column = 0; column < to.columns; ++column) {
      const Between c = between(column, to.columns, from.columns, to.woven_shut);
      const auto at = [&](int i, int j) { return positions[static_cast<std::size_t>(i) * from.columns + j]; };
      const auto along = [&](int i) { return Vec3((1.0 - c.share) * at(i, c.first) + c.share * at(i, c.second)); };
      result.push_back((1.0 - r.share) * along(r.first) + r.share * along(r.second));
    }
  }
  return result;
}

double SurfaceDistance::rms() const {
  return samples > 0 ? std::sqrt(sum_of_squares / static_cast<double>(samples)) : 0.0;
}

void SurfaceDistance::add(const SurfaceDistance& other) {
  sum_of_squares += other.sum_of_squares;
  hausdorff = std::max(hausdorff, other.hausdorff);
  samples += other.samples;
}

SurfaceDistance surface_distance(const cloth::Garment& a, std::span<const Vec3> positions_a, const cloth::Garment& b,
                                 std::span<const Vec3> positions_b) {
  SurfaceDistance result;
  const auto measure = [&](std::span<const Vec3> points, const Surface& surface) {
    for (const Vec3& p : points) {
      const double distance = surface.distance(p);
      result.sum_of_squares += distance * distance;
      result.hausdorff = std::max(result.hausdorff, distance);
    }
    result.samples += static_cast<std::int64_t>(points.size());
  };
  measure(positions_a, Surface(b, positions_b));
  measure(positions_b, Surface(a, positions_a));
  return result;
}

} // namespace tutu::app
