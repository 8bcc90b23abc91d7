#include "src/study/stability/step_bound.h"

#include "cloth/garment/vibration.h"

#include <cmath>
#include <limits>

namespace tutu::app {

double largest_stable_step(double vibration, double drag) {
  const double w2 = vibration * vibration;
  return (std::sqrt(drag * drag + 4.0 * w2) - drag) / w2;
}

double largest_stable_step(const cloth::Garment& garment) {
  const double vibration = cloth::fastest_vibration(garment);
  if (!(vibration > 0.0)) return std::numeric_limits<double>::infinity();
  return largest_stable_step(vibration, garment.fabric.drag);
}

} // namespace tutu::app
