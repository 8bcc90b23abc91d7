// A garment at rest: what it is made of, never where it is now.
//
// GarmentDescription is what a person edits (garment_file.h); build_garment() turns it into a Garment: flat, immutable
// arrays.
#pragma once

#include "rig/math.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tutu::cloth {

/// A rectangle of particles. Row 0 starts at `corner`; columns go along `across`, rows along `down` (both whole edges,
/// m).
struct GridShape {
  int rows = 0, columns = 0;
  Vec3 corner = Vec3::Zero(), across = Vec3::UnitX(), down = -Vec3::UnitY();
};

/// A rectangle rolled around the body. Ring k is an ellipse about (centre_x, height, centre_z); between rings the
/// profile is a straight line, and rows are spaced evenly along it.
struct TubeShape {
  struct Ring {
    double height = 0.0;                   ///< y, m
    double radius_x = 0.0, radius_z = 0.0; ///< half axes, m
    double centre_x = 0.0, centre_z = 0.0; ///< m
  };
  int rows = 0, columns = 0;
  std::vector<Ring> rings; ///< from the first row to the last; at least two
  /// Where the first column runs: the angle from +Z towards +X, rad.
  double start_angle = 0.0;
  /// Without a value the cloth is woven shut, column 0 next to the last. With one, the first and the last column lie on
  /// each other and are sewn together from row 0 down to this fraction of the rows; below is a slit.
  std::optional<double> seam;
};

/// A round sheet that lies level, its front up: rings of particles about the centre, of triangles nearly all of one
/// size.
struct DiscShape {
  Vec3 centre = Vec3::Zero();            ///< m
  double radius_x = 0.0, radius_z = 0.0; ///< half axes, m
  int rings = 0;                         ///< of triangles, from the hole or the centre outwards
  double hole = 0.0;                     ///< of the radius, in [0, 1): how far the hole in the middle reaches
};

/// Any triangles. Corners that share a place are one particle already.
struct MeshShape {
  std::vector<Vec3> positions; ///< model space at rest, m
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool pressed = false; ///< it keeps the angles of its rest shape; else it is sewn from flat cloth
};

/// What the air does to the sheet (cloth/air/air.h), as coefficients of the dynamic pressure on its area. The defaults
/// are those of a square plate.
struct Air {
  double pressure = 1.17; ///< face-on [Hoerner 1965, Fluid-Dynamic Drag, 3-16]
  double lift = 1.48;     ///< slope of the normal force near edge-on, 1/rad: 2 pi / (2 + sqrt(5)) [Helmbold 1942]
  /// Edge-on, of both faces: 2 * 1.328 / sqrt(Re) [Blasius 1908] at 2 m/s over 0.5 m, Re = 7e4.
  double friction = 0.01;
};

/// How the cloth answers to being pulled and bent. Stiffnesses are those of the sheet (force per metre of width and
/// unit strain; energy B kappa^2 / 2 per area and curvature kappa), so that a finer grid is the same cloth.
struct Fabric {
  double density = 0.15;     ///< kg/m2
  double stretch = 40.0;     ///< N/m, along warp and weft
  double shear = 10.0;       ///< N/m
  double bend = 1e-5;        ///< N m, the bending rigidity B (moment per metre of width and unit curvature)
  double bend_springs = 2.0; ///< N/m, of the springs between particles two apart: the report's stand-in for bend
  double damping = 0.002;    ///< s: stress is stiffness * (strain + damping * its rate)
  double drag = 0.5;         ///< 1/s: takes drag * m * v, a stand-in for the air; 0 beside it
  std::optional<Air> air = {};
  double thickness = 0.004; ///< full gap of the sheet, m: particles keep half of it from colliders,
  double clearance = 0.0; ///< and this much more, m: for skin that proxies leave bare, and for chords between particles

  double contact_offset() const { return 0.5 * thickness + clearance; } ///< what particles keep from colliders, m
};

/// Holds particles where they are in the rest pose: on a joint, or on the skin next to them. Which ones: those of some
/// rows and columns of a grid or tube; or of any shape those within a ball, above a height, or both.
struct Attachment {
  struct Ball {
    Vec3 centre = Vec3::Zero(); ///< m, model space at rest
    double radius = 0.0;        ///< m
  };
  std::string joint;               ///< empty when on the skin
  int first_row = 0, last_row = 0; ///< inclusive; negative counts from the end (-1 is the last row)
  int first_column = 0, last_column = -1;
  std::optional<Ball> within = {};  ///< with this or
  std::optional<double> above = {}; ///< with this (y, m), rows and columns do not count
  bool skin = false;

  bool by_place() const { return within || above; }
};

/// Which colliders a garment meets, by names of proxies or of the joints that carry them. The ground is always met.
struct MetColliders {
  enum class Which : std::uint8_t { all, all_but, only };
  Which which = Which::all;
  std::vector<std::string> names; ///< none for all
};

struct GarmentDescription {
  std::string file; ///< for messages
  std::string name;
  std::variant<GridShape, TubeShape, DiscShape, MeshShape> shape;
  Fabric fabric;
  std::vector<Attachment> attachments;
  MetColliders met;
  std::array<float, 3> colour = {0.7f, 0.2f, 0.25f}; ///< linear RGB, for drawing only
};

enum class SpringKind : std::uint8_t {
  structural, ///< neighbours along warp or weft
  shear,      ///< diagonals of a cell
  bend        ///< two apart along warp or weft
};

struct Spring {
  int i = 0, j = 0;
  double rest_length = 0.0; ///< m
  double stiffness = 0.0;   ///< N/m of this one spring
  SpringKind kind = SpringKind::structural;
};

/// A particle that follows a target instead of its forces. Targets arrive as spans in the order of Garment::pins.
struct Pin {
  int particle = 0;
  int attachment = 0; ///< index into Garment::attachments
};

/// Two particles sewn together: they share one place and one velocity.
struct Seam {
  int i = 0, j = 0;
};

/// Positions are in the character's model space at rest, m. Of a grid or tube, particle (row, column) has index
/// row * columns + column. A disc or mesh has rows = columns = 0: only its triangles tell what is next to what, and its
/// springs are their edges.
struct Garment {
  std::string name;
  int rows = 0, columns = 0;
  bool woven_shut = false; ///< column 0 is a neighbour of the last
  std::vector<Vec3> rest_positions;
  std::vector<double> masses;  ///< kg, all > 0
  std::vector<Spring> springs; ///< structural ones first
  int structural_count = 0;
  std::vector<Seam> seams;
  std::vector<Attachment> attachments; ///< rows and columns, where they count, resolved to non-negative numbers
  std::vector<Pin> pins;
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< normals point out of a tube, towards across x down of a grid
  Fabric fabric;
  MetColliders met;
  bool pressed = false; ///< keeps the angles of its rest shape; a mesh only: threads are always straight at rest
  std::array<float, 3> colour = {};

  int particle_count() const { return static_cast<int>(rest_positions.size()); }
};

/// Throws InputError when the description cannot be cloth: fewer than 2 x 2 particles, cells without area, an
/// attachment beyond the rows or without a particle, a particle pinned twice; and where it would take more memory than
/// is allowed (garment_memory.h).
Garment build_garment(const GarmentDescription& description);

/// One entry a particle: 1 where it is pinned.
std::vector<std::uint8_t> pinned_flags(const Garment& garment);

/// Scales (per axis, about the origin) and then moves the shape: how a garment is put on another body.
GarmentDescription fitted(GarmentDescription description, const Vec3& scale, const Vec3& offset);

/// The same shape of more or fewer particles: `factor` times the cells along each side of a grid or tube, the rings of
/// a disc. Attachments hold the same part of it. Throws InputError for a mesh, whose particles are its own, unless
/// factor is 1.
GarmentDescription resampled(GarmentDescription description, double factor);

} // namespace tutu::cloth
