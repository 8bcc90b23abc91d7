// A body of five limbs that swing through a garment, over a ground that its hem touches: one dance for several tests.
#pragma once

#include "cloth/solver.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace tutu::test {

/// The same motion every `period` frames of 1/60 s. Pins sway. The garment must outlive it.
class SwingingLimbs {
public:
  SwingingLimbs(const cloth::Garment& garment, int period)
      : garment_(&garment), period_(period), start_(k_limbs), end_(k_limbs),
        spin_(k_limbs, Vec3(0.02, 0.05, -0.01)), friction_{0.3, 0.0, 0.8, 0.3, 0.5, 0.5},
        pins_end_(garment.pins.size()) {
    place();
  }

  /// What a solver wants for the next frame; good until the one after.
  cloth::FrameInput advance(int substeps) {
    start_ = end_;
    pins_start_ = pins_end_;
    ++frame_;
    place();
    cloth::FrameInput input;
    input.colliders = {start_, end_, proxies::Plane{Vec3::UnitY(), 0.82}, spin_};
    input.friction = friction_;
    input.pins_start = pins_start_;
    input.pins_end = pins_end_;
    input.substeps = substeps;
    return input;
  }

private:
  static constexpr std::size_t k_limbs = 5;

  void place() {
    const double phase = 2.0 * std::numbers::pi * (frame_ % period_) / period_;
    const double swing = std::sin(phase), lift = 1.0 - std::cos(phase);
    end_[0] = {{0.02, 1.35, 0}, {0.02, 1.12, 0}, 0.11};
    end_[1] = {{0.08, 1.1, 0.05}, {0.1 + 0.2 * swing, 0.75 + 0.05 * lift, 0.1}, 0.07};
    end_[2] = {{-0.08, 1.1, 0.05}, {-0.1, 0.75 + 0.1 * lift, 0.3 * swing}, 0.06};
    end_[3] = {{0.3 * swing, 0.95, 0.2}, {0.3 * swing, 0.95, 0.2}, 0.05}; // a sphere
    end_[4] = {{-0.3, 0.9, 0.35 - 0.1 * lift}, {0.3, 0.95, 0.3 - 0.1 * lift}, 0.03};
    for (std::size_t k = 0; k < pins_end_.size(); ++k)
      pins_end_[k] = garment_->rest_positions[garment_->pins[k].particle] + 0.03 * swing * Vec3(1, 0.2, 0.5);
  }

  const cloth::Garment* garment_;
  int period_, frame_ = 0;
  std::vector<proxies::Capsule> start_, end_;
  std::vector<Vec3> spin_;
  std::vector<double> friction_;
  std::vector<Vec3> pins_start_, pins_end_;
};

} // namespace tutu::test
