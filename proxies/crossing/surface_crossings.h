// Counts where surfaces of triangles go through each other, or one through itself: by exact tests, for any topology.
#pragma once

#include "proxies/shapes.h"
#include "rig/mesh.h"

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tutu::proxies {

/// Triangles of any topology: open, closed, branching, of either winding. Taken apart once (every edge once, a tree of
/// boxes over the triangles); then it may move. All surfaces of one question are in one space.
///
/// Triangles that name a corner twice, and those with a corner that is no number or beyond k_largest_exact, are not
/// there; coordinates below k_least_exact count as 0.
class CrossingSurface {
public:
  struct Parts;

  /// Indices of triangles are below positions.size(). `sewn`: pairs of vertices that are one and stand at one place;
  /// without it the two sides of a seam touch all along. `placed`: none, or a flag for each vertex that is put where it
  /// is and not simulated.
  CrossingSurface(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles,
                  std::span<const std::pair<int, int>> sewn = {}, std::span<const std::uint8_t> placed = {});
  ~CrossingSurface();
  CrossingSurface(CrossingSurface&&) noexcept;
  CrossingSurface& operator=(CrossingSurface&&) noexcept;

  /// The vertices are there now: as many as at the start.
  void move(std::span<const Vec3> positions);

  /// Appends the triangles whose boxes share a point with `box`, as indices into what was given.
  void touching(const Box& box, std::vector<int>& found) const;

  const Parts& parts() const { return *parts_; } ///< for the counts below

private:
  std::unique_ptr<Parts> parts_;
};

/// A pair is an edge of one surface that goes through a triangle of the other (passage_through(); the first surface
/// stands an infinitely small step beside its place, so that what touches is told apart). Where two triangles go
/// through each other their pairs, two as a rule, are linked. A crossing is what is linked so: one connected curve of
/// intersection. A finger through a sheet is one, however many triangles it tears; an arm through both walls of a tube
/// is two; a place where surfaces only touch may be one or none.
///
/// What was put where it is is nobody's fault: a curve on which the edge and the triangle of a pair have placed corners
/// alone is counted apart.
///
/// What does not meet now is not counted: a closed surface swallowed whole, or cloth that went through between frames.
struct SurfaceCrossings {
  int pairs = 0;     ///< of all curves
  int crossings = 0; ///< curves that are the work of what moves
  int placed = 0;    ///< the others

  void add(const SurfaceCrossings& other) {
    pairs += other.pairs;
    crossings += other.crossings;
    placed += other.placed;
  }
};

/// Between two surfaces; their edges and triangles are never neighbours of each other.
SurfaceCrossings crossings_between(const CrossingSurface& one, const CrossingSurface& other);

/// Of a surface with itself. An edge is not tested against triangles with a corner of its own.
/// Here each edge in turn stands beside its place: where layers lie exactly on each other they do not cross; of two
/// edges that meet exactly in one point each is judged alone.
SurfaceCrossings crossings_within(const CrossingSurface& surface);

} // namespace tutu::proxies
