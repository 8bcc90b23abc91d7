#include "rig/body_regions.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

namespace tutu::rig {
namespace {

struct Word {
  std::string_view text;
  BodyRegion region;
};

// The first that a name holds decides: "LeftHandRing1" is a hand before "arm" is looked for; "forearm" holds "ear", so
// ears go unnamed.
constexpr Word k_words[] = {
    {"finger", BodyRegion::hands}, {"thumb", BodyRegion::hands},    {"hand", BodyRegion::hands},
    {"wrist", BodyRegion::hands},  {"palm", BodyRegion::hands},     {"pinky", BodyRegion::hands},
    {"toe", BodyRegion::feet},     {"foot", BodyRegion::feet},      {"feet", BodyRegion::feet},
    {"ankle", BodyRegion::feet},   {"heel", BodyRegion::feet},      {"thigh", BodyRegion::legs},
    {"calf", BodyRegion::legs},    {"shin", BodyRegion::legs},      {"knee", BodyRegion::legs},
    {"leg", BodyRegion::legs},     {"shoulder", BodyRegion::torso}, {"clavicle", BodyRegion::torso},
    {"collar", BodyRegion::torso}, {"arm", BodyRegion::arms},       {"elbow", BodyRegion::arms},
    {"head", BodyRegion::head},    {"neck", BodyRegion::head},      {"jaw", BodyRegion::head},
    {"eye", BodyRegion::head},     {"face", BodyRegion::head},      {"hair", BodyRegion::head},
    {"hip", BodyRegion::torso},    {"pelvis", BodyRegion::torso},   {"spine", BodyRegion::torso},
    {"chest", BodyRegion::torso},  {"breast", BodyRegion::torso},   {"torso", BodyRegion::torso},
    {"waist", BodyRegion::torso},  {"belly", BodyRegion::torso},    {"abdomen", BodyRegion::torso},
    {"back", BodyRegion::torso},   {"body", BodyRegion::torso},
};

std::optional<BodyRegion> region_of(std::string_view joint) {
  std::string name(bare_joint_name(joint));
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const Word& word : k_words)
    if (name.find(word.text) != name.npos) return word.region;
  return std::nullopt;
}

} // namespace

std::vector<BodyRegion> body_regions(const Skeleton& skeleton) {
  std::vector<BodyRegion> regions;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const int parent = skeleton.parents[j];
    const BodyRegion above = parent == k_no_parent ? BodyRegion::other : regions[parent];
    regions.push_back(region_of(skeleton.names[j]).value_or(above));
  }
  return regions;
}

int main_joint(const Skin& skin, const Triangle& triangle, const Vec3& weights) {
  std::vector<double> of_joint(
      1 + static_cast<std::size_t>(*std::max_element(skin.slot_joint.begin(), skin.slot_joint.end())));
  for (int corner = 0; corner < 3; ++corner)
    for (int k = 0; k < skin.influences; ++k) {
      const std::size_t influence = static_cast<std::size_t>(triangle[corner]) * skin.influences + k;
      of_joint[skin.slot_joint[skin.slots[influence]]] +=
          weights[corner] * static_cast<double>(skin.weights[influence]);
    }
  return static_cast<int>(std::max_element(of_joint.begin(), of_joint.end()) - of_joint.begin());
}

} // namespace tutu::rig
