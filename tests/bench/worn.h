// A garment whose upper edge is swung to and fro once a second, and a body that may swing in it.
#pragma once

#include "cloth/garment/garment.h"
#include "cloth/state/frame.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace tutu::bench {

/// Frames of 1/60 s. The garment must outlive it.
class Worn {
public:
  static constexpr int k_substeps = 10;

  Worn(const cloth::Garment& garment, bool has_body)
      : garment_(&garment), pins_start_(garment.pins.size()), pins_end_(pins_start_), start_(has_body ? 1 : 0),
        end_(start_), friction_(has_body ? 2 : 0, 0.3) {
    place(pins_end_, end_);
  }

  /// Good until the next one.
  cloth::FrameInput advance() {
    pins_start_ = pins_end_;
    start_ = end_;
    ++frame_;
    place(pins_end_, end_);
    cloth::FrameInput input;
    input.substeps = k_substeps;
    input.pins_start = pins_start_;
    input.pins_end = pins_end_;
    input.colliders = {start_, end_, std::nullopt};
    input.friction = friction_;
    return input;
  }

private:
  void place(std::vector<Vec3>& pins, std::vector<proxies::Capsule>& body) const {
    const double swing = std::sin(frame_ * 2.0 * std::numbers::pi / 60.0);
    for (std::size_t k = 0; k < pins.size(); ++k)
      pins[k] = garment_->rest_positions[garment_->pins[k].particle] + Vec3(0.03 * swing, 0, 0);
    for (proxies::Capsule& limb : body) limb = {{0.05 * swing, 1.0, 0}, {0.1 * swing, 0.7, 0}, 0.2};
  }

  const cloth::Garment* garment_;
  int frame_ = 0;
  std::vector<Vec3> pins_start_, pins_end_;
  std::vector<proxies::Capsule> start_, end_;
  std::vector<double> friction_;
};

} // namespace tutu::bench
