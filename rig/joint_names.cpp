#include "rig/strong_poses.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace tutu::rig {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

/// Where in a name the side stands, and what stands there.
struct SidePlace {
  std::size_t at = 0, length = 0;
  Side side = Side::middle;
};

SidePlace find_side(const std::string& name) {
  for (const auto& [word, side] : {std::pair{"left", Side::left}, std::pair{"right", Side::right}})
    if (const std::size_t at = name.find(word); at != std::string::npos) return {at, std::string(word).size(), side};
  // A letter that stands alone: "thigh_l", "l_thigh", "thigh.L", "L thigh".
  const auto is_gap = [](char c) { return c == '_' || c == '.' || c == ' ' || c == '-' || c == ':'; };
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] != 'l' && name[i] != 'r') continue;
    const bool starts = i == 0 || is_gap(name[i - 1]), ends = i + 1 == name.size() || is_gap(name[i + 1]);
    if (starts && ends && name.size() > 2) return {i, 1, name[i] == 'l' ? Side::left : Side::right};
  }
  return {};
}

bool has_any(const std::string& name, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

BodyPart part_named(const std::string& name) {
  if (has_any(name, {"hand", "finger", "thumb", "index", "pinky", "wrist"})) return BodyPart::hand;
  if (has_any(name, {"toe", "ball"})) return BodyPart::toes;
  if (has_any(name, {"head", "jaw", "eye", "lip", "mouth", "cheek", "tongue", "teeth", "hair", "ear_", "tail"}))
    return BodyPart::head;
  return BodyPart::garment;
}

} // namespace

Side side_of(std::string_view joint_name) { return find_side(lower(bare_joint_name(joint_name))).side; }

std::string name_on_other_side(std::string_view joint_name) {
  const std::string_view bare = bare_joint_name(joint_name);
  const SidePlace place = find_side(lower(bare));
  if (place.side == Side::middle) return "";
  const std::string_view was = bare.substr(place.at, place.length);
  std::string other =
      place.length == 1 ? (place.side == Side::left ? "r" : "l") : (place.side == Side::left ? "right" : "left");
  const bool upper = std::isupper(static_cast<unsigned char>(was[0]));
  const bool all_upper = upper && std::isupper(static_cast<unsigned char>(was.back()));
  for (std::size_t i = 0; i < other.size(); ++i)
    if (all_upper || (upper && i == 0)) other[i] = static_cast<char>(std::toupper(other[i]));
  std::string result(joint_name.substr(0, joint_name.size() - bare.size()));
  result += bare.substr(0, place.at);
  result += other;
  result += bare.substr(place.at + place.length);
  return result;
}

std::vector<BodyPart> body_parts(const Skeleton& skeleton) {
  std::vector<BodyPart> parts(skeleton.names.size(), BodyPart::garment);
  // A neck that nothing called head hangs on carries the face: the head is that neck.
  const bool has_head = std::any_of(skeleton.names.begin(), skeleton.names.end(), [](const std::string& name) {
    return lower(bare_joint_name(name)).find("head") != std::string::npos;
  });
  std::vector<bool> carries_face(parts.size(), false);
  for (std::size_t j = 0; j < parts.size(); ++j) {
    const std::string name = lower(bare_joint_name(skeleton.names[j]));
    if (has_any(name, {"jaw", "eye"}) && skeleton.parents[j] != k_no_parent) carries_face[skeleton.parents[j]] = true;
  }
  for (std::size_t j = 0; j < parts.size(); ++j) {
    parts[j] = part_named(lower(bare_joint_name(skeleton.names[j])));
    if (!has_head && carries_face[j]) parts[j] = BodyPart::head;
    const int parent = skeleton.parents[j];
    if (parent != k_no_parent && parts[parent] != BodyPart::garment) parts[j] = parts[parent];
  }
  return parts;
}

} // namespace tutu::rig
