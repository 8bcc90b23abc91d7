#include "rig/io/bvh.h"

#include "rig/error.h"
#include "rig/io/file_io.h"
#include "rig/io/json_file.h"
#include "rig/io/memory_limit.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

namespace tutu::rig {
namespace {

/// The words of a file one after the other, each with its line.
class Words {
public:
  explicit Words(const std::filesystem::path& file)
      : file_(file.string()), content_(read_file(file)), rest_(content_) {}
  Words(const Words&) = delete; // views its own content
  Words& operator=(const Words&) = delete;

  std::string_view next(const char* expected) {
    const std::string_view word = take();
    if (word.empty()) throw error("the end of the file", expected);
    return word;
  }
  void expect(const char* word) {
    if (const std::string_view found = next(word); found != word) throw error(quoted(found), word);
  }
  double number() {
    std::string_view word = next("a number");
    const std::string_view shown = word;
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure != std::errc() || end != word.data() + word.size() || !(std::abs(value) <= k_largest_number))
      throw error(quoted(shown), "a finite number");
    return value;
  }
  int count(int most) {
    const double value = number();
    if (!(value >= 0.0 && value <= most) || value != std::floor(value))
      throw error(std::to_string(value), "a whole number up to " + std::to_string(most));
    return static_cast<int>(value);
  }
  bool at_end() const { return std::all_of(rest_.begin(), rest_.end(), is_blank); }
  InputError error(std::string found, std::string expected) const {
    return {file_, "line " + std::to_string(line_), std::move(found), std::move(expected)};
  }
  static std::string quoted(std::string_view word) { return '"' + std::string(word.substr(0, 40)) + '"'; }

private:
  std::string_view take() {
    std::size_t start = 0;
    for (; start < rest_.size() && is_blank(rest_[start]); ++start) line_ += rest_[start] == '\n';
    rest_.remove_prefix(start);
    std::size_t size = 0;
    while (size < rest_.size() && !is_blank(rest_[size])) ++size;
    const std::string_view word = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return word;
  }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string file_, content_;
  std::string_view rest_;
  int line_ = 1;
};

enum class Channel { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

struct Hierarchy {
  Skeleton skeleton;                          ///< rest_local: the offsets, in the file's unit
  std::vector<std::vector<Channel>> channels; ///< a joint
  struct EndSite {
    int parent;
    Vec3 offset;
  };
  std::vector<EndSite> ends;

  std::size_t channel_count() const {
    std::size_t count = 0;
    for (const auto& joint : channels) count += joint.size();
    return count;
  }
};

Channel channel_named(const Words& words, std::string_view name) {
  constexpr std::string_view k_names[] = {"Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"};
  const auto found = std::find(std::begin(k_names), std::end(k_names), name);
  if (found == std::end(k_names)) throw words.error(Words::quoted(name), "Xposition, ... or Zrotation");
  return static_cast<Channel>(found - std::begin(k_names));
}

Vec3 read_offset(Words& words) {
  words.expect("OFFSET");
  Vec3 offset;
  for (double& component : offset) component = words.number();
  return offset;
}

void begin_joint(Words& words, Hierarchy& hierarchy, int parent) {
  constexpr int k_most_joints = 10000;
  Skeleton& skeleton = hierarchy.skeleton;
  if (skeleton.joint_count() == k_most_joints) throw words.error("more joints", "at most 10000");
  skeleton.names.emplace_back(words.next("a joint's name"));
  skeleton.parents.push_back(parent);
  words.expect("{");
  skeleton.rest_local.push_back({Quat::Identity(), read_offset(words)});
  words.expect("CHANNELS");
  std::vector<Channel>& channels = hierarchy.channels.emplace_back();
  for (int left = words.count(6); left > 0; --left) channels.push_back(channel_named(words, words.next("a channel")));
}

Hierarchy read_hierarchy(Words& words) {
  Hierarchy hierarchy;
  words.expect("HIERARCHY");
  words.expect("ROOT");
  begin_joint(words, hierarchy, k_no_parent);
  for (int open = 0; open != k_no_parent;) {
    const std::string_view word = words.next("JOINT, End Site or }");
    if (word == "JOINT") {
      begin_joint(words, hierarchy, open);
      open = hierarchy.skeleton.joint_count() - 1;
    } else if (word == "End") {
      words.expect("Site");
      words.expect("{");
      hierarchy.ends.push_back({open, read_offset(words)});
      words.expect("}");
    } else if (word == "}") {
      open = hierarchy.skeleton.parents[open];
    } else {
      throw words.error(Words::quoted(word), "JOINT, End Site or }");
    }
  }
  // Frames without numbers would be as many as the file says, whatever its size.
  if (hierarchy.channel_count() == 0) throw words.error("a skeleton without channels", "one that moves");
  return hierarchy;
}

/// One joint of one frame, parent_from_joint, in the file's unit. Positions take the place of the offset.
Transform read_joint(Words& words, const Hierarchy& hierarchy, int joint) {
  Transform local = hierarchy.skeleton.rest_local[joint];
  for (const Channel channel : hierarchy.channels[joint]) {
    const double value = words.number();
    const int axis = static_cast<int>(channel) % 3;
    if (channel <= Channel::z_position) local.translation[axis] = value;
    else local.rotation = local.rotation * Quat(Eigen::AngleAxisd(value * std::numbers::pi / 180.0, Vec3::Unit(axis)));
  }
  local.rotation.normalize();
  return local;
}

/// Lowest and highest point of the skeleton at rest.
std::pair<double, double> heights(const Hierarchy& hierarchy) {
  const std::vector<Transform> model = rest_model(hierarchy.skeleton);
  double lowest = model.front().translation.y(), highest = lowest;
  const auto add = [&](double y) {
    lowest = std::min(lowest, y);
    highest = std::max(highest, y);
  };
  for (const Transform& joint : model) add(joint.translation.y());
  for (const auto& end : hierarchy.ends) add((model[end.parent] * end.offset).y());
  return {lowest, highest};
}

} // namespace

Mocap read_bvh(const std::filesystem::path& file, const BvhOptions& options) {
  Words words(file);
  Hierarchy hierarchy = read_hierarchy(words);
  Skeleton& skeleton = hierarchy.skeleton;
  const int joints = skeleton.joint_count();
  words.expect("MOTION");
  words.expect("Frames:");
  const int frames = words.count(10'000'000);
  if (frames == 0) throw words.error("no frames", "at least one");
  words.expect("Frame");
  words.expect("Time:");
  const double step = words.number();
  if (!(step > 0.0)) throw words.error(std::to_string(step) + " s a frame", "a time above 0");
  if (options.rest_frame && !(*options.rest_frame >= 0 && *options.rest_frame < frames))
    throw words.error(std::to_string(frames) + " frames", "the rest frame " + std::to_string(*options.rest_frame));

  // Counted as the file says: joints without channels need no numbers.
  const double last = std::min((frames - 1) * step, options.to.value_or(k_largest_number));
  const double kept = std::clamp((last - options.from) / step + 2.0, 1.0, 1.0 * frames);
  check_memory(kept * joints * sizeof(Transform), file.string(), "Frames",
               with_commas(static_cast<std::uint64_t>(kept)) + " frames of " + with_commas(joints) + " joints");

  Mocap mocap;
  Clip& clip = mocap.clip;
  clip.name = file.stem().string();
  clip.extrapolation = Extrapolation::clamp;
  clip.joint_count = joints;
  clip.roots = {0};
  std::vector<Transform> pose(joints);
  std::optional<std::vector<Transform>> rest;
  const double slack = 1e-6 * step; // a time that was written as a multiple of the step means that frame
  for (int frame = 0; frame < frames; ++frame) {
    for (int j = 0; j < joints; ++j) pose[j] = read_joint(words, hierarchy, j);
    if (options.rest_frame == frame) rest = pose;
    const double time = frame * step;
    if (time < options.from - slack || (options.to && time > *options.to + slack)) continue;
    clip.times.push_back(static_cast<double>(clip.times.size()) * step);
    clip.local.insert(clip.local.end(), pose.begin(), pose.end());
  }
  if (!words.at_end())
    throw words.error("more numbers", "the end of the file after " + std::to_string(frames) + " frames");
  if (clip.times.empty())
    throw words.error(std::to_string(frames * step) + " s of motion", "a frame in the time asked for");
  clip.airborne.assign(clip.times.size(), false);

  if (rest) skeleton.rest_local = *rest;
  const auto [lowest, highest] = heights(hierarchy);
  if (!(highest > lowest)) throw InputError(file.string(), "", "a skeleton without height", "one that stands along +Y");
  // Where zero is says nothing when nobody stands there; the rest frame stands where it was taken.
  if (!rest) skeleton.rest_local[0].translation.y() -= lowest;
  const double metres = k_bvh_stature / (highest - lowest);
  for (std::vector<Transform>* poses : {&skeleton.rest_local, &clip.local})
    for (Transform& local : *poses) {
      local.translation *= metres;
      if (!(local.translation.array().abs() <= k_largest_number).all())
        throw InputError(file.string(), "", "a skeleton that is flat beside its offsets and travel",
                         "one that stands along +Y");
    }
  mocap.skeleton = std::move(skeleton);
  mocap.skeleton.check(file.string());
  return mocap;
}

void rename_joints(Skeleton& skeleton, const std::map<std::string, std::optional<std::string>>& names,
                   const std::string& file) {
  std::vector<std::string> renamed = skeleton.names;
  for (const auto& [from, to] : names) {
    const std::optional<int> joint = skeleton.find(from);
    if (!joint)
      throw InputError(file, "joint " + from, "a joint the skeleton lacks, or has more than once", "one of its joints");
    renamed[*joint] = to ? *to : "(" + skeleton.names[*joint] + ")";
  }
  skeleton.names = std::move(renamed);
  skeleton.check(file);
}

} // namespace tutu::rig
