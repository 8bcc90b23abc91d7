// Cloth between pins that stand still: what the analytic scenes are made of.
#pragma once

#include "cloth/solver.h"
#include "src/run/settings.h"

#include <limits>
#include <memory>
#include <vector>

namespace tutu::app {

/// A figure of a run that broke.
inline constexpr double k_nothing = std::numeric_limits<double>::quiet_NaN();

/// No drag, and no springs of bend, which one solver would have and the other not.
cloth::Fabric airless(double stretch);

cloth::Garment sheet(const cloth::GridShape& shape, const cloth::Fabric& fabric,
                     std::vector<cloth::Attachment> attachments = {});

/// A garment between pins that stand still, with at most a ground. The garment must outlive it.
class Stand {
public:
  static constexpr double k_gravity = 9.81, k_frame = 1.0 / 60.0; ///< m/s2, s

  Stand(const cloth::Garment& garment, const RunSettings& setup);

  cloth::FrameInput& input() { return input_; }
  cloth::Solver& solver() { return *solver_; }
  std::vector<Vec3>& pins() { return pins_; }

  /// Whether the frame held.
  bool advance();
  /// Of motion, height and springs, J.
  double total_energy() const;

private:
  const cloth::Garment* garment_;
  std::unique_ptr<cloth::Solver> solver_;
  std::unique_ptr<proxies::CollisionQuery> query_;
  std::vector<Vec3> pins_;
  cloth::FrameInput input_;
};

/// Greatest rise of a series above any earlier value.
double greatest_rise(const std::vector<double>& values);

} // namespace tutu::app
