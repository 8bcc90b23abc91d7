#include "cloth/solver.h"

#include "cloth/mass_spring.h"
#include "cloth/mesh_xpbd.h"
#include "cloth/tolerances.h"
#include "cloth/xpbd.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace tutu::cloth {

std::optional<int> add_spring_forces(const Garment& garment, std::span<const Vec3> positions, std::span<Vec3> forces) {
  std::optional<int> first_bad;
  const int count = static_cast<int>(garment.springs.size());
  for (int k = 0; k < count; ++k) {
    const Spring& spring = garment.springs[k];
    const Vec3 d = positions[spring.j] - positions[spring.i];
    const double length = d.norm();
    // Written so that a length that is not a number fails too.
    if (!(length <= (1.0 + k_diverged_stretch) * spring.rest_length) && k < garment.structural_count && !first_bad)
      first_bad = k;
    if (!(length > 0.0)) continue; // two particles in one place: no direction, no force
    const Vec3 force = (spring.stiffness * (length - spring.rest_length) / length) * d;
    forces[spring.i] += force;
    forces[spring.j] -= force;
  }
  return first_bad;
}

double elastic_energy(const Garment& garment, std::span<const Vec3> positions) {
  double energy = 0.0;
  for (const Spring& spring : garment.springs) {
    const double extension = (positions[spring.j] - positions[spring.i]).norm() - spring.rest_length;
    energy += 0.5 * spring.stiffness * extension * extension;
  }
  return energy;
}

std::string_view name_of(SolverKind kind) { return k_solver_names[static_cast<std::size_t>(kind)]; }

SolverKind solver_named(std::string_view name) {
  const auto found = std::find(k_solver_names.begin(), k_solver_names.end(), name);
  if (found == k_solver_names.end()) throw std::invalid_argument("no solver called " + std::string(name));
  return static_cast<SolverKind>(found - k_solver_names.begin());
}

ContactFeatures contact_features_named(std::string_view name) {
  const auto found = std::find(k_contact_features_names.begin(), k_contact_features_names.end(), name);
  if (found == k_contact_features_names.end())
    throw std::invalid_argument("no contact features called " + std::string(name));
  return static_cast<ContactFeatures>(found - k_contact_features_names.begin());
}

std::unique_ptr<Solver> make_solver(const Garment& garment, const SolverOptions& options) {
  if (options.kind == SolverKind::mass_spring) return std::make_unique<MassSpring>(garment);
  if (garment.rows == 0) { // not woven in rows and columns
    if (options.double_precision) return std::make_unique<MeshXpbd<double>>(garment);
    return std::make_unique<MeshXpbd<float>>(garment);
  }
  return make_xpbd(garment, options);
}

} // namespace tutu::cloth
