// Garments: read, put on a body, coarser and finer too, and handed to the solvers.
#include "cloth/garment/elements.h"
#include "cloth/garment/garment_file.h"
#include "cloth/garment/reach.h"
#include "cloth/solver.h"
#include "rig/error.h"
#include "src/run/worn_garment.h"
#include "tests/fuzz/target.h"

#include <cmath>

namespace tutu::fuzz {
namespace {

/// Few enough particles to build some thousand of them a second.
bool is_small(const cloth::GarmentDescription& description) {
  constexpr int k_most = 400;
  const auto& shape = description.shape;
  if (const auto* grid = std::get_if<cloth::GridShape>(&shape)) return grid->rows * grid->columns <= k_most;
  if (const auto* tube = std::get_if<cloth::TubeShape>(&shape)) return tube->rows * tube->columns <= k_most;
  if (const auto* disc = std::get_if<cloth::DiscShape>(&shape))
    return disc->rings <= 8 && 6.0 * disc->rings / (1.0 - disc->hole) <= k_most; // particles of the outermost ring
  return std::get<cloth::MeshShape>(shape).positions.size() <= k_most;
}

void check(const cloth::Garment& garment) {
  const int count = garment.particle_count();
  const auto is_particle = [&](int i) { return i >= 0 && i < count; };
  require(count > 0 && garment.masses.size() == garment.rest_positions.size(), "every particle has a mass");
  for (int i = 0; i < count; ++i)
    require(is_finite(garment.rest_positions[i]) && garment.masses[i] > 0.0 && std::isfinite(garment.masses[i]),
            "places are finite, masses above 0");
  for (const cloth::Spring& spring : garment.springs)
    require(is_particle(spring.i) && is_particle(spring.j) && spring.rest_length > 0.0 && spring.stiffness > 0.0 &&
                std::isfinite(spring.stiffness),
            "springs have length and stiffness");
  for (const cloth::Seam& seam : garment.seams) require(is_particle(seam.i) && is_particle(seam.j), "seams sew cloth");
  for (const cloth::Pin& pin : garment.pins)
    require(is_particle(pin.particle) && pin.attachment < static_cast<int>(garment.attachments.size()),
            "pins hold particles");
  for (const auto& triangle : garment.triangles)
    for (const std::uint32_t corner : triangle) require(corner < garment.masses.size(), "triangles are of particles");
}

void build(const cloth::GarmentDescription& description) {
  if (!is_small(description)) return;
  const app::WornGarment worn = app::wear(description, small_character());
  check(worn.garment);
  require(worn.joints.size() == worn.garment.attachments.size(), "every attachment has a joint");
  for (const cloth::Bend& bend : cloth::build_bends(worn.garment))
    require(std::isfinite(bend.stiffness), "hinges have a stiffness");
  for (const cloth::Tether& tether : cloth::build_tethers(worn.garment))
    require(std::isfinite(cloth::longest_of(tether, worn.garment.fabric)), "tethers have a length");
  (void)cloth::GarmentReach(worn.garment);
  for (const bool precise : {false, true}) {
    cloth::SolverOptions options;
    options.double_precision = precise;
    (void)cloth::make_solver(worn.garment, options);
  }
}

} // namespace

void fuzz_garment(std::string_view input) {
  for (static bool first = true; first; first = false) {
    write_input(R"({"density": 0.1, "stretch": 200, "thickness": 0.001})", "fabrics/silk.json");
    write_input("v 0 1 0\nv 0.1 1 0\nv 0 1 0.1\nv 0.1 1 0.1\nf 1 3 2\nf 2 3 4\n", "garments/sheet.obj");
  }
  const cloth::GarmentDescription description = cloth::read_garment(write_input(input, "garments/garment.json"));
  build(description);
  build(cloth::fitted(description, {1.1, 0.9, 1.2}, {0, 0.1, 0}));
  if (std::holds_alternative<cloth::MeshShape>(description.shape)) return; // whose particles are its own
  for (const double factor : {0.5, 2.0}) build(cloth::resampled(description, factor));
}

} // namespace tutu::fuzz
