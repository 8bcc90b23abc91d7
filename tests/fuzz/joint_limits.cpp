// Limits of joints: read, and applied to rotations and to a leg.
#include "src/view/pose/joint_limits_file.h"
#include "tests/fuzz/target.h"

#include <array>

namespace tutu::fuzz {

void fuzz_joint_limits(std::string_view input) {
  const rig::Skeleton& skeleton = small_character().skeleton;
  const std::vector<rig::JointLimit> limits = app::read_joint_limits(write_input(input, "limits.json"), skeleton);
  const std::array<Quat, 4> turns = {Quat::Identity(), Quat(0, 1, 0, 0), Quat(0.5, 0.5, -0.5, 0.5),
                                     Quat(0.6, 0, 0.8, 0)};
  for (const rig::JointLimit& limit : limits)
    for (const Quat& turn : turns) {
      const Transform turned{rig::limited(turn, skeleton.rest_local[limit.joint].rotation, limit), Vec3::Zero()};
      require_poses({&turned, 1}, "a limited rotation is unit");
    }
  std::vector<Transform> local = skeleton.rest_local;
  const std::array<int, 3> chain = {3, 4, 5};
  (void)rig::solve_limb(skeleton, local, {3, 4, 5}, {0.2, 0.5, 0.3}, {0, 0.6, 1}, limits);
  require_poses(local, "a leg within limits is finite");
  rig::ChainOptions few;
  few.most_iterations = 10;
  (void)rig::solve_chain(skeleton, local, chain, {0.1, 0.7, -0.2}, limits, few);
  require_poses(local, "a chain within limits is finite");
}

} // namespace tutu::fuzz
