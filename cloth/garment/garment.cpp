#include "cloth/garment/garment.h"

#include "cloth/garment/detail/garment_mesh.h"
#include "cloth/garment/garment_memory.h"
#include "rig/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tutu::cloth {
namespace {

constexpr double k_shortest_spring = 1e-6; // m; a cell is far larger, or it has no area and is refused

struct Layout {
  int rows = 0, columns = 0;
  bool woven_shut = false;
  std::vector<Vec3> positions;

  int at(int row, int column) const { return row * columns + column % columns; }
  /// Cells along the columns' direction: one more when the last column meets the first again.
  int cell_columns() const { return woven_shut ? columns : columns - 1; }
};

void check_size(const GarmentDescription& description, int rows, int columns, int fewest_columns) {
  constexpr int k_most = 4096; // a side; 16 million particles is beyond any use and below any overflow
  if (rows < 2 || columns < fewest_columns || rows > k_most || columns > k_most)
    throw InputError(description.file, "/shape", std::to_string(rows) + " x " + std::to_string(columns) + " particles",
                     "2.." + std::to_string(k_most) + " rows and " + std::to_string(fewest_columns) + ".." +
                         std::to_string(k_most) + " columns");
}

Layout lay_out(const GarmentDescription& description, const GridShape& grid) {
  check_size(description, grid.rows, grid.columns, 2);
  Layout layout{grid.rows, grid.columns, false, {}};
  layout.positions.reserve(static_cast<std::size_t>(grid.rows) * grid.columns);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      layout.positions.push_back(grid.corner + grid.across * (static_cast<double>(column) / (grid.columns - 1)) +
                                 grid.down * (static_cast<double>(row) / (grid.rows - 1)));
  return layout;
}

/// The ring at fraction `s` of the profile's length.
TubeShape::Ring ring_at(const std::vector<TubeShape::Ring>& rings, double s) {
  const auto gap = [&](std::size_t k) {
    const double radius_step =
        0.5 * (rings[k + 1].radius_x + rings[k + 1].radius_z - rings[k].radius_x - rings[k].radius_z);
    return std::hypot(rings[k + 1].height - rings[k].height, radius_step);
  };
  double total = 0.0;
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) total += gap(k);
  double along = s * total;
  std::size_t k = 0;
  while (k + 2 < rings.size() && along > gap(k)) along -= gap(k++);
  const double t = gap(k) > 0.0 ? std::clamp(along / gap(k), 0.0, 1.0) : 0.0;
  const auto mix = [&](double TubeShape::Ring::*member) {
    return (1.0 - t) * rings[k].*member + t * rings[k + 1].*member;
  };
  using Ring = TubeShape::Ring;
  return {mix(&Ring::height), mix(&Ring::radius_x), mix(&Ring::radius_z), mix(&Ring::centre_x), mix(&Ring::centre_z)};
}

Layout lay_out(const GarmentDescription& description, const TubeShape& tube) {
  check_size(description, tube.rows, tube.columns, 4);
  if (tube.rings.size() < 2)
    throw InputError(description.file, "/shape/tube/rings", std::to_string(tube.rings.size()), "at least two rings");
  const bool woven_shut = !tube.seam.has_value();
  Layout layout{tube.rows, tube.columns, woven_shut, {}};
  const int turns_over = woven_shut ? tube.columns : tube.columns - 1;
  for (int row = 0; row < tube.rows; ++row) {
    const TubeShape::Ring ring = ring_at(tube.rings, static_cast<double>(row) / (tube.rows - 1));
    for (int column = 0; column < tube.columns; ++column) {
      // The sewn columns must coincide to the bit, hence the remainder.
      const double angle = tube.start_angle + 2.0 * std::numbers::pi * (column % turns_over) / turns_over;
      layout.positions.emplace_back(ring.centre_x + ring.radius_x * std::sin(angle), ring.height,
                                    ring.centre_z + ring.radius_z * std::cos(angle));
    }
  }
  return layout;
}

/// Area of the cell whose first corner is (row, column); 0 outside the cloth, so that borders need no special case.
double cell_area(const Layout& layout, int row, int column) {
  if (row < 0 || row >= layout.rows - 1) return 0.0;
  if (layout.woven_shut) column = (column + layout.columns) % layout.columns;
  if (column < 0 || column >= layout.cell_columns()) return 0.0;
  const auto& p = layout.positions;
  const Vec3 &a = p[layout.at(row, column)], &b = p[layout.at(row, column + 1)];
  const Vec3 &c = p[layout.at(row + 1, column)], &d = p[layout.at(row + 1, column + 1)];
  return triangle_area(a, c, b) + triangle_area(b, c, d);
}

void add_springs(const Layout& layout, const Fabric& fabric, Garment& garment) {
  // A spring that stands for sheet area A of stiffness k (N/m) at rest length L stores k A strain^2 / 2, so it is k A /
  // L^2 stiff.
  const auto add = [&](SpringKind kind, int i, int j, double sheet_stiffness, double area) {
    const double length = (layout.positions[i] - layout.positions[j]).norm();
    if (!(sheet_stiffness > 0.0)) return;      // asked not to resist
    if (!(length > k_shortest_spring)) return; // a fold at rest: two apart are in one place, and nothing to hold
    garment.springs.push_back({i, j, length, sheet_stiffness * area / (length * length), kind});
  };
  const int rows = layout.rows, columns = layout.columns;
  const auto reaches = [&](int column) { return layout.woven_shut || column < columns; };

  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) { // an edge carries half of each cell beside it
      const double here = cell_area(layout, row, column);
      if (reaches(column + 1))
        add(SpringKind::structural, layout.at(row, column), layout.at(row, column + 1), fabric.stretch,
            0.5 * (here + cell_area(layout, row - 1, column)));
      if (row + 1 < rows)
        add(SpringKind::structural, layout.at(row, column), layout.at(row + 1, column), fabric.stretch,
            0.5 * (here + cell_area(layout, row, column - 1)));
    }
  garment.structural_count = static_cast<int>(garment.springs.size());

  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column < layout.cell_columns(); ++column) {
      // A shear angle g strains the two diagonals of a square by +-g/2: two springs of 2 G A / L^2 store G g^2 A / 2.
      const double area = 2.0 * cell_area(layout, row, column);
      add(SpringKind::shear, layout.at(row, column), layout.at(row + 1, column + 1), fabric.shear, area);
      add(SpringKind::shear, layout.at(row, column + 1), layout.at(row + 1, column), fabric.shear, area);
    }

  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      if (reaches(column + 2) && (!layout.woven_shut || columns > 4)) // of four around, two apart is two apart twice
        add(SpringKind::bend, layout.at(row, column), layout.at(row, column + 2), fabric.bend_springs,
            0.5 * (cell_area(layout, row, column) + cell_area(layout, row, column + 1) +
                   cell_area(layout, row - 1, column) + cell_area(layout, row - 1, column + 1)));
      if (row + 2 < rows)
        add(SpringKind::bend, layout.at(row, column), layout.at(row + 2, column), fabric.bend_springs,
            0.5 * (cell_area(layout, row, column) + cell_area(layout, row + 1, column) +
                   cell_area(layout, row, column - 1) + cell_area(layout, row + 1, column - 1)));
    }
}

int resolved(int index, int count) { return index < 0 ? count + index : index; }

/// Resolves the rows and columns of `attachment`; the particles in them.
std::vector<int> particles_in_rows(const Garment& garment, const std::string& file, const std::string& place,
                                   Attachment& attachment) {
  if (garment.rows == 0)
    throw InputError(file, place, "rows of a garment that has none", "within or above to tell what is held");
  const auto resolve = [&](int& first, int& last, int count, const char* what) {
    const std::string found = std::string(what) + " " + std::to_string(first) + " to " + std::to_string(last);
    first = resolved(first, count);
    last = resolved(last, count);
    if (first < 0 || last >= count || first > last)
      throw InputError(file, place, found,
                       "a range within 0.." + std::to_string(count - 1) + " (or counted from the end, -1 the last)");
  };
  resolve(attachment.first_row, attachment.last_row, garment.rows, "rows");
  resolve(attachment.first_column, attachment.last_column, garment.columns, "columns");
  std::vector<int> particles;
  for (int row = attachment.first_row; row <= attachment.last_row; ++row)
    for (int column = attachment.first_column; column <= attachment.last_column; ++column)
      particles.push_back(row * garment.columns + column);
  return particles;
}

std::vector<int> particles_in_place(const Garment& garment, const std::string& file, const std::string& place,
                                    const Attachment& attachment) {
  std::vector<int> particles;
  for (int i = 0; i < garment.particle_count(); ++i) {
    const Vec3& p = garment.rest_positions[i];
    if (attachment.within && (p - attachment.within->centre).norm() > attachment.within->radius) continue;
    if (attachment.above && p.y() < *attachment.above) continue;
    particles.push_back(i);
  }
  if (particles.empty()) throw InputError(file, place, "no particle in that place", "at least one");
  return particles;
}

void add_pins(const GarmentDescription& description, Garment& garment) {
  std::vector<int> owner(garment.rest_positions.size(), -1);
  for (std::size_t a = 0; a < description.attachments.size(); ++a) {
    Attachment attachment = description.attachments[a];
    const std::string place = "/attachments/" + std::to_string(a);
    const std::vector<int> held = attachment.by_place()
                                      ? particles_in_place(garment, description.file, place, attachment)
                                      : particles_in_rows(garment, description.file, place, attachment);
    for (const int particle : held) {
      if (owner[particle] >= 0) {
        const std::string which = garment.rows == 0 ? "particle " + std::to_string(particle)
                                                    : "row " + std::to_string(particle / garment.columns) +
                                                          ", column " + std::to_string(particle % garment.columns);
        throw InputError(description.file, place,
                         which + " held by attachment " + std::to_string(owner[particle]) + " too",
                         "each particle held once");
      }
      owner[particle] = static_cast<int>(a);
      garment.pins.push_back({particle, static_cast<int>(a)});
    }
    garment.attachments.push_back(attachment);
  }
}

/// Fills positions, masses, springs and triangles of what is woven in rows and columns.
void weave(const Layout& layout, const GarmentDescription& description, Garment& garment) {
  garment.rows = layout.rows;
  garment.columns = layout.columns;
  garment.woven_shut = layout.woven_shut;
  garment.rest_positions = layout.positions;
  garment.masses.assign(layout.positions.size(), 0.0);
  for (int row = 0; row + 1 < layout.rows; ++row)
    for (int column = 0; column < layout.cell_columns(); ++column) {
      const int a = layout.at(row, column), b = layout.at(row, column + 1);
      const int c = layout.at(row + 1, column), d = layout.at(row + 1, column + 1);
      for (const std::array<int, 3>& t : {std::array{a, c, b}, std::array{b, c, d}}) {
        const double area = triangle_area(layout.positions[t[0]], layout.positions[t[1]], layout.positions[t[2]]);
        if (!(area > 0.0))
          throw InputError(description.file, "/shape",
                           "a cell without area at row " + std::to_string(row) + ", column " + std::to_string(column),
                           "every cell to have an area");
        for (const int particle : t) garment.masses[particle] += description.fabric.density * area / 3.0;
        garment.triangles.push_back(
            {static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]), static_cast<std::uint32_t>(t[2])});
      }
    }
  add_springs(layout, description.fabric, garment);
}

void build_shape(const GridShape& grid, const GarmentDescription& description, Garment& garment) {
  weave(lay_out(description, grid), description, garment);
}
void build_shape(const TubeShape& tube, const GarmentDescription& description, Garment& garment) {
  const Layout layout = lay_out(description, tube);
  weave(layout, description, garment);
  const int sewn_rows = tube.seam ? static_cast<int>(std::lround(*tube.seam * layout.rows)) : 0;
  for (int row = 0; row < sewn_rows; ++row)
    garment.seams.push_back({layout.at(row, 0), layout.at(row, layout.columns - 1)});
}
void build_shape(const DiscShape& disc, const GarmentDescription& description, Garment& garment) {
  build_from_triangles(triangulated(disc, description), description, garment);
}
void build_shape(const MeshShape& mesh, const GarmentDescription& description, Garment& garment) {
  build_from_triangles(mesh, description, garment);
}

} // namespace

Garment build_garment(const GarmentDescription& description) {
  check_garment_memory(description);
  Garment garment;
  garment.name = description.name;
  garment.fabric = description.fabric;
  garment.met = description.met;
  garment.colour = description.colour;
  std::visit([&](const auto& shape) { build_shape(shape, description, garment); }, description.shape);
  add_pins(description, garment);
  return garment;
}

std::vector<std::uint8_t> pinned_flags(const Garment& garment) {
  std::vector<std::uint8_t> pinned(garment.rest_positions.size(), 0);
  for (const Pin& pin : garment.pins) pinned[pin.particle] = 1;
  return pinned;
}

namespace {

void fit(GridShape& grid, const Vec3& scale, const Vec3& offset) {
  grid.corner = scale.cwiseProduct(grid.corner) + offset;
  grid.across = scale.cwiseProduct(grid.across);
  grid.down = scale.cwiseProduct(grid.down);
}
void fit(TubeShape& tube, const Vec3& scale, const Vec3& offset) {
  for (TubeShape::Ring& ring : tube.rings) {
    ring.height = scale.y() * ring.height + offset.y();
    ring.radius_x *= scale.x();
    ring.radius_z *= scale.z();
    ring.centre_x = scale.x() * ring.centre_x + offset.x();
    ring.centre_z = scale.z() * ring.centre_z + offset.z();
  }
}
void fit(DiscShape& disc, const Vec3& scale, const Vec3& offset) {
  disc.centre = scale.cwiseProduct(disc.centre) + offset;
  disc.radius_x *= scale.x();
  disc.radius_z *= scale.z();
}
void fit(MeshShape& mesh, const Vec3& scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) p = scale.cwiseProduct(p) + offset;
}

} // namespace

GarmentDescription fitted(GarmentDescription description, const Vec3& scale, const Vec3& offset) {
  std::visit([&](auto& shape) { fit(shape, scale, offset); }, description.shape);
  for (Attachment& attachment : description.attachments) {
    if (attachment.above) *attachment.above = scale.y() * *attachment.above + offset.y();
    if (!attachment.within) continue;
    attachment.within->centre = scale.cwiseProduct(attachment.within->centre) + offset;
    attachment.within->radius *= std::cbrt(scale.prod()); // a ball it stays
  }
  return description;
}

} // namespace tutu::cloth
