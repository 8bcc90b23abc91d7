// The standard scene "dancer-skirt" on Bullet's soft bodies, to be run beside tutu's in one process.
#pragma once

#include "src/study/bench/dancer_skirt.h"

#include <memory>
#include <span>
#include <vector>

namespace tutu::bench {

struct BulletSetup {
  int n = 30;
  int substeps = 5, iterations = 10; ///< substeps a frame, position iterations a substep
  double voxel = 0.02;               ///< m, of the distance field that soft bodies ask
};

/// Cloth is the scene's: same particles, same mass each, a link for each grid edge at its initial length. Proxies are
/// kinematic capsules and spheres of the scene's radii, posed at each substep's end; an arm's capsules keep their
/// length at t = 0, which the skirt never meets. Friction and contact offset are those of tutu's run.
class BulletSkirt {
public:
  explicit BulletSkirt(const BulletSetup& setup);
  ~BulletSkirt();

  void advance(); ///< one frame

  const cloth::Garment& skirt() const { return skirt_; }
  const cloth::Particles& particles() const { return particles_; } ///< positions only
  std::span<const proxies::Capsule> proxies() const { return proxies_; }
  double cpu_ms() const { return cpu_ms_; } ///< this thread's, posing and step of the last frame

private:
  struct World;

  void move_bodies();
  void move_pins(double h);

  BulletSetup setup_;
  cloth::Garment skirt_;
  cloth::Particles particles_;
  std::vector<proxies::Capsule> proxies_;
  std::vector<Vec3> pins_;
  std::unique_ptr<World> world_;
  int frame_ = 0;
  double cpu_ms_ = 0.0;
};

} // namespace tutu::bench
