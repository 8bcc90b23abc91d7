#include "src/study/bench/stand.h"

#include "cloth/garment/springs.h"

#include <algorithm>

namespace tutu::app {

cloth::Fabric airless(double stretch) {
  cloth::Fabric fabric;
  fabric.stretch = stretch;
  fabric.bend_springs = 0.0;
  fabric.drag = 0.0;
  return fabric;
}

cloth::Garment sheet(const cloth::GridShape& shape, const cloth::Fabric& fabric,
                     std::vector<cloth::Attachment> attachments) {
  cloth::GarmentDescription description;
  description.name = "sheet";
  description.shape = shape;
  description.fabric = fabric;
  description.attachments = std::move(attachments);
  return cloth::build_garment(description);
}

Stand::Stand(const cloth::Garment& garment, const RunSettings& setup)
    : garment_(&garment), solver_(cloth::make_solver(garment, setup)), query_(proxies::make_query(setup.backend)) {
  for (const cloth::Pin& pin : garment.pins) pins_.push_back(garment.rest_positions[pin.particle]);
  input_.seconds = k_frame;
  input_.substeps = setup.substeps;
}

bool Stand::advance() {
  input_.pins_start = input_.pins_end = pins_;
  return !solver_->step(input_, *query_);
}

double Stand::total_energy() const {
  const cloth::Particles& particles = solver_->particles();
  double sum = cloth::elastic_energy(*garment_, particles.positions);
  for (int i = 0; i < particles.count(); ++i)
    sum += garment_->masses[i] *
           (0.5 * particles.velocities[i].squaredNorm() - input_.gravity.dot(particles.positions[i]));
  return sum;
}

double greatest_rise(const std::vector<double>& values) {
  double lowest = values.front(), rise = 0.0;
  for (const double v : values) {
    rise = std::max(rise, v - lowest);
    lowest = std::min(lowest, v);
  }
  return rise;
}

} // namespace tutu::app
