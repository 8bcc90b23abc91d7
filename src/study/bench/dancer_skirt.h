// The standard scene "dancer-skirt": a skirt of N x N particles on a dancer of 20 capsules and 8 spheres, all of it
// formulas, so that any two programs can be compared on it. Nothing is read from disk.
//
// World: y up, the dancer faces +Z, gravity (0, -9.81, 0), no wind, no ground; 60 frames a second. Frame f takes the
// state from t = f/60 to t = (f + 1)/60. m, kg, s.
#pragma once

#include "cloth/garment/uneven.h"
#include "cloth/solver.h"
#include "proxies/query/collision_query.h"
#include "src/run/settings.h"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tutu::app {

inline constexpr int k_dancer_frames_per_second = 60;
inline constexpr int k_dancer_frames = 360; ///< of a whole run
inline constexpr int k_dancer_proxies = 28;
inline constexpr double k_dancer_skirt_mass = 0.3; ///< kg, in equal parts on all particles

/// The dancer dances, or (`still`) stands as at t = 0 for ever.
enum class DancerMotion { dance, still };

/// w(t): 0 at t = 0, 1 from t = 1 s on, without a jerk between; 0 at all times for `still`. Scales every swing.
double motion_weight(double t, DancerMotion motion);

/// world_from_pelvis.
Transform dancer_pelvis(double t, DancerMotion motion);

/// All proxies in world space. Order: torso 6; left leg (thigh, shin, foot), right leg; left arm (upper, lower, hand),
/// right arm; neck, head; then the spheres: buttocks 2, belly, back, breasts 2, knees 2. `out` has k_dancer_proxies
/// entries.
void pose_dancer(double t, DancerMotion motion, std::span<proxies::Capsule> out);

/// The skirt in world space at t = 0: a cone woven shut, n rows from waist to hem, n columns, row 0 pinned. n >= 8.
cloth::Garment dancer_skirt(int n);

/// Where the pins are at t; `out` in the order of skirt.pins.
void dancer_pins(const cloth::Garment& skirt, double t, DancerMotion motion, std::span<Vec3> out);

inline constexpr double k_dancer_friction = 0.3; ///< cloth against every proxy; mass_spring knows none

/// Substeps a frame that suit a solver: what mass_spring needs to stand this skirt; for xpbd what holds its
/// threads within 10 %. They
/// grow with n, as the time a wave needs from one particle to the next shrinks.
int default_substeps(cloth::SolverKind solver, int n);

/// Of the settings those of the solver, the backend, the substeps and the uneven start count.
struct DancerSkirtSetup : RunSettings {
  DancerSkirtSetup() {
    substeps = default_substeps(solver, n);
    uneven_mm = 1e3 * cloth::k_unevenness;
  }

  int n = 30;
  DancerMotion motion = DancerMotion::dance;
};

/// The scene in motion.
class DancerSkirt {
public:
  explicit DancerSkirt(const DancerSkirtSetup& setup);

  /// One frame. After a divergence do not call it again.
  std::optional<cloth::Divergence> advance();

  const DancerSkirtSetup& setup() const { return setup_; }
  int frame() const { return frame_; } ///< frames done
  double time() const { return static_cast<double>(frame_) / k_dancer_frames_per_second; }
  /// CPU time that this thread spent on the last frame's posing and step, ms.
  double cpu_ms() const { return cpu_ms_; }
  const cloth::Garment& skirt() const { return *skirt_; }
  const cloth::Particles& particles() const { return solver_->particles(); }
  std::span<const proxies::Capsule> proxies() const { return proxies_end_; } ///< at time()

private:
  DancerSkirtSetup setup_;
  std::unique_ptr<const cloth::Garment> skirt_; // the solver keeps its address
  std::unique_ptr<cloth::Solver> solver_;
  std::unique_ptr<proxies::CollisionQuery> query_;
  std::array<proxies::Capsule, k_dancer_proxies> proxies_start_, proxies_end_;
  std::vector<Vec3> pins_start_, pins_end_;
  int frame_ = 0;
  double cpu_ms_ = 0.0;
};

} // namespace tutu::app
