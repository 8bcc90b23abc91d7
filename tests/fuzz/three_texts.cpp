// The three texts, and the fourth with the joints: parts of the input, parted by lines "===".
#include "rig/io/clip_file.h"
#include "tests/fuzz/target.h"

#include <vector>

namespace tutu::fuzz {

void fuzz_three_texts(std::string_view input) {
  constexpr std::string_view k_between = "===\n";
  std::vector<std::string_view> parts;
  for (; parts.size() < 3; input.remove_prefix(std::min(input.size(), parts.back().size() + k_between.size())))
    parts.push_back(input.substr(0, input.find(k_between)));
  rig::ThreeTexts files = {write_input(parts[0], "translations.txt"),
                           write_input(parts[1], "rotations.txt"),
                           write_input(parts[2], "times.txt"),
                           {}};
  if (!input.empty()) files.joints = write_input(input, "joints.txt");

  const rig::Skeleton& skeleton = small_character().skeleton;
  std::vector<std::string> notes;
  const rig::RawClip raw = rig::read_three_texts(files, skeleton, &notes);
  const rig::Clip clip = rig::build_clip(raw, skeleton);
  require_poses(clip.local, "poses of three texts are finite");
  const rig::ThreeTexts written = {scratch() / "t.txt", scratch() / "q.txt", scratch() / "k.txt", scratch() / "j.txt"};
  rig::write_three_texts(raw, skeleton, written);
  const rig::Clip again = rig::build_clip(rig::read_three_texts(written, skeleton, nullptr), skeleton);
  require(again.times == clip.times, "times of three texts read back as written");
}

} // namespace tutu::fuzz
