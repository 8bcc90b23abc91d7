// Motion capture: read in both ways of rest, and put on a character.
#include "rig/io/bvh.h"
#include "rig/error.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {
namespace {

void put_on(const std::filesystem::path& file, const rig::BvhOptions& options) {
  const rig::Mocap take = rig::read_bvh(file, options);
  require(take.clip.joint_count == take.skeleton.joint_count() &&
              take.clip.local.size() == take.clip.times.size() * take.skeleton.names.size(),
          "a take has every joint in every frame");
  require_poses(take.skeleton.rest_local, "a take's rest pose is finite");
  require_poses(take.clip.local, "a take's poses are finite");
  const rig::Skeleton& skeleton = small_character().skeleton;
  const rig::Clip clip = rig::retarget(take.clip, take.skeleton, skeleton, nullptr);
  require_poses(clip.local, "a take's poses are finite on a character");
  std::vector<Transform> local(skeleton.names.size());
  rig::sample(clip, 0.5 * clip.duration(), local);
  require_poses(local, "poses between frames are finite");
}

} // namespace

void fuzz_bvh(std::string_view input) {
  const std::filesystem::path file = write_input(input, "take.bvh");
  put_on(file, {});
  put_on(file, {.rest_frame = 0, .from = 0.04, .to = 1.0});
}

} // namespace tutu::fuzz
