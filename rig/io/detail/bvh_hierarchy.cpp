#include "rig/io/detail/bvh_hierarchy.h"

#include "rig/text.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

namespace tutu::rig::bvh_detail {
namespace {

constexpr int k_most_joints = 10000;

Channel read_channel(Words& words) {
  constexpr std::string_view k_names[] = {"xposition", "yposition", "zposition", "xrotation", "yrotation", "zrotation"};
  const std::string_view word = words.next("a channel");
  std::string name(word);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto found = std::ranges::find(k_names, name);
  if (found == std::end(k_names)) throw words.error(Words::quoted(word), "Xposition, ... or Zrotation");
  return static_cast<Channel>(found - std::begin(k_names));
}

/// What follows a brace: where it is from its parent, and what moves it. Either may come first; CHANNELS may be absent.
struct Block {
  Vec3 offset = Vec3::Zero();
  std::vector<Channel> channels;
};
Block read_block(Words& words) {
  Block block;
  words.expect("{");
  bool has_offset = false, has_channels = false;
  for (;;) {
    if (!has_offset && words.take("OFFSET")) {
      for (double& component : block.offset) component = words.number();
      has_offset = true;
    } else if (!has_channels && words.take("CHANNELS")) {
      for (int left = words.count(6); left > 0; --left) block.channels.push_back(read_channel(words));
      has_channels = true;
    } else {
      break;
    }
  }
  if (!has_offset) words.expect("OFFSET");
  return block;
}

/// The joints of one root; what they are called as the file has it.
void read_root(Words& words, Hierarchy& hierarchy, int joints_before) {
  Skeleton& skeleton = hierarchy.skeleton;
  const auto begin_joint = [&](int parent) {
    if (joints_before + skeleton.joint_count() == k_most_joints) throw words.error("more joints", "at most 10000");
    const std::string_view name = words.phrase();
    if (name.empty()) throw words.error("no name", "a joint's name");
    skeleton.names.emplace_back(name);
    skeleton.parents.push_back(parent);
    Block block = read_block(words);
    skeleton.rest_local.push_back({Quat::Identity(), block.offset});
    hierarchy.channels.push_back(std::move(block.channels));
    return skeleton.joint_count() - 1;
  };
  const auto end_site = [&](int parent) {
    words.phrase(); // a name, which nothing moves
    const Block block = read_block(words);
    if (!block.channels.empty()) throw words.error("an end site with channels", "a joint");
    words.expect("}");
    hierarchy.ends.push_back({parent, block.offset});
  };

  for (int open = begin_joint(k_no_parent); open != k_no_parent;) {
    if (words.take("JOINT")) {
      open = begin_joint(open);
    } else if (words.take("EndSite")) {
      end_site(open);
    } else if (words.take("End")) {
      words.expect("Site");
      end_site(open);
    } else if (words.take("}")) {
      open = skeleton.parents[open];
    } else {
      throw words.error(Words::quoted(words.next("JOINT, End Site or }")), "JOINT, End Site or }");
    }
  }
}

/// Names are for people: of two joints of one name the second gets a number, and control characters a '_'.
void make_names_unique(Hierarchy& hierarchy) {
  std::vector<std::string>& names = hierarchy.skeleton.names;
  for (std::string& name : names) name = plain_text(name);
  const std::set<std::string> as_given(names.begin(), names.end());
  std::set<std::string> taken;
  std::map<std::string, int> numbers; // the last that a name got
  int again = 0;
  std::string first;
  for (std::string& name : names) {
    if (taken.insert(name).second) continue;
    const std::string base = name;
    int& number = numbers.try_emplace(base, 1).first->second;
    do name = base + "_" + std::to_string(++number);
    while (as_given.contains(name) || !taken.insert(name).second);
    if (++again == 1) first = base;
  }
  if (again > 0)
    hierarchy.notes.push_back(std::to_string(again) + (again == 1 ? " joint has" : " joints have") +
                              " the name of another (" + first + "): numbered");
}

} // namespace

int Hierarchy::own_channels() const {
  std::size_t count = 0;
  for (const auto& joint : channels) count += joint.size();
  return static_cast<int>(count);
}

Hierarchy read_hierarchy(Words& words) {
  constexpr int k_most_named = 5;
  Hierarchy hierarchy;
  words.expect("HIERARCHY");
  words.expect("ROOT");
  read_root(words, hierarchy, 0);
  const int last_line = words.line();
  int others = 0, joints = hierarchy.skeleton.joint_count();
  std::string names;
  while (words.take("ROOT")) {
    Hierarchy other;
    read_root(words, other, joints);
    joints += other.skeleton.joint_count();
    hierarchy.channels_besides += other.own_channels();
    if (++others <= k_most_named) names += (names.empty() ? "" : ", ") + plain_text(other.skeleton.names[0]);
  }
  words.expect("MOTION");
  make_names_unique(hierarchy);
  if (others > 0)
    hierarchy.notes.push_back(std::to_string(others + 1) + " roots: " + hierarchy.skeleton.names[0] +
                              " is read; left out: " + names +
                              (others > k_most_named ? " and " + std::to_string(others - k_most_named) + " more" : ""));
  // Frames without numbers would be as many as the file says, whatever its size.
  if (hierarchy.own_channels() == 0) throw words.error_at(last_line, "a skeleton without channels", "one that moves");
  return hierarchy;
}

} // namespace tutu::rig::bvh_detail
