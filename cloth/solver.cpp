#include "cloth/solver.h"

#include "cloth/mass_spring.h"
#include "cloth/mesh_xpbd.h"
#include "cloth/xpbd.h"

namespace tutu::cloth {

std::unique_ptr<Solver> make_solver(const Garment& garment, const SolverOptions& options) {
  if (options.solver == SolverKind::mass_spring) return std::make_unique<MassSpring>(garment, options);
  if (garment.rows == 0) { // not woven in rows and columns
    if (options.double_precision) return std::make_unique<MeshXpbd<double>>(garment, options);
    return std::make_unique<MeshXpbd<float>>(garment, options);
  }
  return make_xpbd(garment, options);
}

SolverOptions honoured(SolverOptions options, const Garment& garment, proxies::Backend backend) {
  const bool plain = options.solver == SolverKind::mass_spring;
  if (plain) options.double_precision = true;
  if (plain || garment.rows == 0) {
    options.passes = 1;
    options.self_collision = false;
  }
  if (backend == proxies::Backend::mesh) {
    if (options.features == ContactFeatures::automatic) options.features = ContactFeatures::particles;
    options.swept = false;
  }
  return options;
}

} // namespace tutu::cloth
