// Clips: read, played on a skeleton and on another one, written, and read again.
#include "rig/error.h"
#include "rig/io/clip_file.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {

void fuzz_clip(std::string_view input) {
  const rig::Skeleton& skeleton = small_character().skeleton;
  const rig::RawClip raw = rig::read_clip(write_input(input, "clip.json"));
  rig::write_clip(raw, scratch() / "first.json");
  rig::write_clip(rig::read_clip(scratch() / "first.json"), scratch() / "second.json");
  require(text_of(scratch() / "first.json") == text_of(scratch() / "second.json"), "a clip reads back as written");

  rig::Skeleton other = skeleton;
  for (Transform& joint : other.rest_local) joint.translation *= 0.5;
  rig::Clip clip = rig::build_clip(raw, skeleton);
  const rig::Clip elsewhere = rig::retarget(clip, skeleton, other, nullptr);
  std::vector<Transform> local(skeleton.names.size()), model(local.size());
  for (const rig::Interpolation between : {clip.interpolation, rig::Interpolation::slerp, rig::Interpolation::cubic}) {
    rig::set_interpolation(clip, between);
    for (const double share : {-0.3, 0.0, 0.01, 0.5, 0.99, 1.0, 7.3}) {
      rig::pose_at(clip, skeleton, share * clip.duration(), local, model);
      require_poses(local, "a clip's poses are finite");
      rig::pose_at(elsewhere, other, share * elsewhere.duration(), local, model);
      require_poses(local, "a clip's poses are finite on another skeleton");
    }
  }
}

} // namespace tutu::fuzz
