// What of a garment is more than springs: its edges, its hinges, its tethers. Built once from the rest shape.
#pragma once

#include "cloth/garment/garment.h"

#include <array>
#include <span>
#include <vector>

namespace tutu::cloth {

/// An edge of the triangles, a < b.
struct Edge {
  int a = 0, b = 0;
  int triangles = 0;                      ///< that share it: 1 on a border, 2 within; more where sheets meet
  std::array<int, 2> opposite = {-1, -1}; ///< corners of the first two of them
};

/// Sorted by a, then b.
std::vector<Edge> edges_of(std::span<const std::array<std::uint32_t, 3>> triangles);

/// Two triangles that share the edge from a to b and have c and d opposite of it. Energy k (angle - rest_angle)^2 / 2
/// [Grinspun et al. 2003, Discrete Shells], angle as in dihedral.h.
struct Bend {
  int a = 0, b = 0, c = 0, d = 0;
  double rest_angle = 0.0; ///< rad
  double stiffness = 0.0;  ///< N m
};

/// One for each edge between two triangles; none without Fabric::bend.
///
/// k = B |e|^2 / (A1 + A2), that is B |e| over the mean of the two heights: the factor with which a sheet of
/// equilateral triangles, or of cells cut along their diagonals, stores B kappa^2 / 2 per area when it is bent to a
/// cylinder along its edges. (Less regular triangles are stiffer: those of a disc by a tenth. Diagonals that all run
/// one way make a grid up to three times as stiff across them.)
///
/// Cloth is cut flat: rest_angle is 0, whatever the garment's rest shape, for a tube is sewn from a flat panel and
/// wants to open. Only what is `pressed` (Garment::pressed) keeps the angles of its rest shape.
std::vector<Bend> build_bends(const Garment& garment);

/// A free particle is never farther than `length` from its anchor, a pinned one, unless the cloth between them
/// stretches [Kim, Chentanez, Mueller 2012, Long Range Attachments].
struct Tether {
  int particle = 0, anchor = 0;
  double length = 0.0; ///< m
};

/// One for each free particle that hangs on a pinned one: the nearest by way of the cloth at rest (along the edges,
/// both diagonals of cells, and through seams), which is a few per cent longer than the shortest way over the sheet.
/// None without pins.
std::vector<Tether> build_tethers(const Garment& garment);

/// Beyond this length, m, it is the iteration that gives and not the cloth: 2 % more than the tether's, and what three
/// times the cloth's own weight would stretch it by.
double longest_of(const Tether& tether, const Fabric& fabric);

} // namespace tutu::cloth
