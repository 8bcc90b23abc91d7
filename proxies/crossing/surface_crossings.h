// Counts where surfaces of triangles go through each other, or one through itself: by exact tests, for any topology.
#pragma once

#include "proxies/shapes.h"
#include "rig/mesh.h"

#include <span>
#include <utility>

namespace tutu::proxies {

/// Triangles of any topology: open, closed, branching, of either winding. Not owned. All surfaces of one question are
/// in one space; indices are below positions.size().
///
/// Triangles that name a corner twice, and those with a corner that is no number or beyond k_largest_exact, are not
/// there; coordinates below k_least_exact count as 0.
struct SurfaceView {
  std::span<const Vec3> positions;
  std::span<const rig::Triangle> triangles;
};

/// A pair is an edge of one surface that goes through a triangle of the other (passage_through(); the first surface
/// stands an infinitely small step beside its place, so that what touches is told apart). Where two triangles go
/// through each other their pairs, two as a rule, are linked. A crossing is what is linked so: one connected curve of
/// intersection. A finger through a sheet is one, however many triangles it tears; an arm through both walls of a tube
/// is two; a place where surfaces only touch may be one or none.
///
/// What does not meet now is not counted: a closed surface swallowed whole, or cloth that went through between frames.
struct SurfaceCrossings {
  int pairs = 0;
  int crossings = 0;
};

/// Between two surfaces; their edges and triangles are never neighbours of each other.
SurfaceCrossings crossings_between(const SurfaceView& one, const SurfaceView& other);

/// Of a surface with itself. An edge is not tested against triangles with a corner of its own. `sewn`: pairs of
/// vertices that are one and stand at one place; without it the two sides of a seam touch all along.
/// Here each edge in turn stands beside its place: where layers lie exactly on each other they do not cross; of two
/// edges that meet exactly in one point each is judged alone.
SurfaceCrossings crossings_within(const SurfaceView& surface, std::span<const std::pair<int, int>> sewn = {});

} // namespace tutu::proxies
