#include "rig/io/bvh.h"

#include "rig/error.h"
#include "rig/io/detail/bvh_hierarchy.h"
#include "rig/io/detail/bvh_stance.h"
#include "rig/io/json_file.h"
#include "rig/io/memory_limit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace tutu::rig {
namespace {

using namespace bvh_detail;

/// Reads the frames one after the other; each is as many numbers as there are channels, on a line of its own.
class Frames {
public:
  Frames(Words& words, const Hierarchy& hierarchy) : words_(words), hierarchy_(hierarchy) {
    words_.label("Frames:");
    count_ = words_.count(10'000'000);
    if (count_ == 0) throw words_.error("no frames", "at least one");
    words_.label("Frame Time:");
    step_ = words_.number();
    if (!(step_ > 0.0)) throw words_.error(std::to_string(step_) + " s a frame", "a time above 0");
  }

  int count() const { return count_; }
  double step() const { return step_; } ///< s

  /// The next frame, of which as many have been read before. As the file has it.
  void read(int frame, Pose& pose) {
    const int line = words_.next_line();
    for (std::size_t j = 0; j < pose.size(); ++j) {
      pose[j] = hierarchy_.skeleton.rest_local[j];
      for (const Channel channel : hierarchy_.channels[j]) apply(channel, number(frame), pose[j]);
      pose[j].rotation.normalize();
    }
    for (int left = hierarchy_.channels_besides; left > 0; --left) number(frame);
    if (!odd_ && (words_.line() != line || !words_.ends_line())) odd_ = {frame, line};
  }

  void expect_end() {
    if (words_.at_end()) return;
    check_lines();
    throw words_.error(std::to_string(words_.words_left()) + " more numbers",
                       "the end of the file after " + std::to_string(count_) + " frames of " + a_frame());
  }

private:
  /// Positions take the place of the offset.
  static void apply(Channel channel, double value, Transform& local) {
    const int axis = static_cast<int>(channel) % 3;
    if (channel <= Channel::z_position) local.translation[axis] = value;
    else local.rotation = local.rotation * Quat(Eigen::AngleAxisd(value * std::numbers::pi / 180.0, Vec3::Unit(axis)));
  }

  double number(int frame) {
    if (!words_.at_end()) return words_.number();
    check_lines();
    throw words_.error("the end of the file in frame " + std::to_string(frame),
                       std::to_string(count_) + " frames of " + a_frame());
  }

  /// Where numbers are too few or too many, the first line with another number of them than a frame has tells which.
  void check_lines() {
    if (!odd_ || odd_->frame == 0) return;
    if (const int found = words_.numbers_on(odd_->line); found != hierarchy_.all_channels())
      throw words_.error_at(odd_->line,
                            std::to_string(found) + (found == 1 ? " number" : " numbers") + " for frame " +
                                std::to_string(odd_->frame),
                            a_frame());
  }
  std::string a_frame() const {
    const int count = hierarchy_.all_channels();
    return std::to_string(count) + (count == 1 ? " number" : " numbers");
  }

  struct Place {
    int frame, line;
  };
  Words& words_;
  const Hierarchy& hierarchy_;
  int count_ = 0;
  double step_ = 0.0;
  std::optional<Place> odd_; ///< the first frame that is not a line
};

void turn_to_y_up(Hierarchy& hierarchy, std::span<Transform> poses) {
  for (Transform& local : hierarchy.skeleton.rest_local) local = turned_to_y_up(local);
  for (auto& end : hierarchy.ends) end.offset = turned_to_y_up(end.offset);
  for (Transform& local : poses) local = turned_to_y_up(local);
}

/// Turns all of it to +Y up and finds the rest pose. `rest`: the frame that was chosen for it. `frames`: of the
/// samples.
void stand_up(Hierarchy& hierarchy, std::vector<Pose>& samples, std::span<const int> frames,
              const std::optional<Pose>& rest, Mocap& mocap) {
  const Landmarks marks = find_landmarks(hierarchy.skeleton);
  Pose& rest_local = hierarchy.skeleton.rest_local;
  const bool z_up = is_z_up(hierarchy, marks, samples, rest ? &*rest : nullptr);
  if (z_up) {
    turn_to_y_up(hierarchy, mocap.clip.local);
    for (Pose& sample : samples)
      for (Transform& local : sample) local = turned_to_y_up(local);
    mocap.notes.emplace_back("Z up: turned so that +Y is up");
  }
  if (rest) {
    rest_local = *rest;
    if (z_up)
      for (Transform& local : rest_local) local = turned_to_y_up(local);
    return;
  }
  Standing standing = find_standing(hierarchy, marks, samples);
  rest_local = std::move(standing.rest);
  for (std::size_t root = 0; root < mocap.clip.local.size(); root += rest_local.size())
    mocap.clip.local[root].translation.y() += standing.raise;
  if (standing.sample)
    mocap.notes.push_back("the pose with all rotations zero does not stand: frame " +
                          std::to_string(frames[*standing.sample]) +
                          " is the rest pose (\"rest_frame\" chooses another)");
  mocap.notes.insert(mocap.notes.end(), standing.notes.begin(), standing.notes.end());
}

/// To metres; refuses what has no height to tell them by.
void scale(const Hierarchy& hierarchy, const std::string& file, Mocap& mocap) {
  const Extent extent = extent_of(hierarchy, mocap.skeleton.rest_local);
  if (!(extent.highest > extent.lowest))
    throw InputError(file, "", "a skeleton without height", "one that stands along +Y");
  const double metres = k_bvh_stature / (extent.highest - extent.lowest);
  for (std::vector<Transform>* poses : {&mocap.skeleton.rest_local, &mocap.clip.local})
    for (Transform& local : *poses) {
      local.translation *= metres;
      if (!is_in_bounds(local.translation))
        throw InputError(file, "", "a skeleton that is flat beside its offsets and travel", "one that stands along +Y");
    }
}

} // namespace

Mocap read_bvh(const std::filesystem::path& file, const BvhOptions& options) {
  Words words(file);
  Hierarchy hierarchy = read_hierarchy(words);
  const int joints = hierarchy.skeleton.joint_count();
  Frames frames(words, hierarchy);
  const double step = frames.step();
  if (options.rest_frame && !(*options.rest_frame >= 0 && *options.rest_frame < frames.count()))
    throw words.error(std::to_string(frames.count()) + " frames",
                      "the rest frame " + std::to_string(*options.rest_frame));

  // Counted as the file says: joints without channels need no numbers. Of the samples, that tell how the actor stands
  // whatever part of the take is asked for, some are enough.
  constexpr int k_samples = 256, k_sampled_joints = 1'000'000;
  const int samples_wanted = std::clamp(k_sampled_joints / joints, 1, std::min(k_samples, frames.count()));
  const double last = std::min((frames.count() - 1) * step, options.to.value_or(k_largest_number));
  const double kept = std::clamp((last - options.from) / step + 2.0, 1.0, 1.0 * frames.count());
  check_memory((kept + samples_wanted) * joints * sizeof(Transform), file.string(), "Frames",
               with_commas(static_cast<std::uint64_t>(kept)) + " frames of " + with_commas(joints) + " joints");

  Mocap mocap;
  Clip& clip = mocap.clip;
  clip.name = file.stem().string();
  clip.extrapolation = Extrapolation::clamp;
  clip.joint_count = joints;
  clip.roots = {0};
  Pose pose(joints);
  std::optional<Pose> rest;
  std::vector<Pose> samples;
  std::vector<int> sampled;
  const double slack = 1e-6 * step; // a time that was written as a multiple of the step means that frame
  for (int frame = 0; frame < frames.count(); ++frame) {
    frames.read(frame, pose);
    if (options.rest_frame == frame) rest = pose;
    if (frame >= static_cast<double>(samples.size()) * frames.count() / samples_wanted) {
      samples.push_back(pose);
      sampled.push_back(frame);
    }
    const double time = frame * step;
    if (time < options.from - slack || (options.to && time > *options.to + slack)) continue;
    clip.times.push_back(static_cast<double>(clip.times.size()) * step);
    clip.local.insert(clip.local.end(), pose.begin(), pose.end());
  }
  frames.expect_end();
  if (clip.times.empty())
    throw words.error(std::to_string(frames.count() * step) + " s of motion", "a frame in the time asked for");
  clip.airborne.assign(clip.times.size(), false);

  stand_up(hierarchy, samples, sampled, rest, mocap);
  mocap.notes.insert(mocap.notes.begin(), hierarchy.notes.begin(), hierarchy.notes.end());
  mocap.skeleton = hierarchy.skeleton;
  scale(hierarchy, file.string(), mocap);
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
