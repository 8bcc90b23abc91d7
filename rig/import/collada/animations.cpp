// Clips of a Collada file: which channels belong together, and what each moves.
#include "rig/error.h"
#include "rig/import/collada/node_transform.h"
#include "rig/import/collada/sampler.h"
#include "rig/import/collada/source.h"
#include "rig/import/detail/parts.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace tutu::rig::import_detail {
namespace {

using Channels = std::vector<pugi::xml_node>;

/// The channels of an <animation> and of those in it.
void collect_channels(const pugi::xml_node& animation, Channels& channels) {
  for (const pugi::xml_node child : animation.children()) {
    if (std::string_view(child.name()) == "channel") channels.push_back(child);
    if (std::string_view(child.name()) == "animation") collect_channels(child, channels);
  }
}

std::string name_of(const pugi::xml_node& element) {
  const std::string name = element.attribute("name").value();
  return name.empty() ? element.attribute("id").value() : name;
}

/// "3 channels on ...: a, b, c and 4 more".
std::string listed(const std::vector<std::string>& names, const std::string& what) {
  return count_of(names.size(), "channel") + " " + what + ": " + list_of(names);
}

/// Fills a FileAnimation from channels.
class ClipReader {
public:
  ClipReader(const ColladaDocument& document, const std::map<std::string, int>& node_of)
      : document_(document), node_of_(node_of) {}

  FileAnimation read(const Channels& channels) {
    for (const pugi::xml_node& channel : channels) add(channel);
    FileAnimation animation;
    for (const auto& [node, moving] : moving_) {
      if (!moving.transform.moves()) continue;
      NodeMotion motion = motion_of(moving.transform, moving.name);
      motion.node = node;
      if (!motion.translation.empty() || !motion.rotation.empty() || !motion.scale.empty())
        animation.nodes.push_back(std::move(motion));
    }
    animation.start = std::min(first_.value_or(0.0), 0.0);
    animation.end = std::max(last_.value_or(0.0), animation.start);
    if (!lost_.empty()) notes_.push_back(listed(lost_, "whose target is not in the file left out"));
    if (!foreign_.empty()) notes_.push_back(listed(foreign_, "on other things than a node's transform left out"));
    if (!sheared_.empty()) notes_.push_back(listed(sheared_, "with a shear, which is left out"));
    animation.notes = std::move(notes_);
    return animation;
  }

private:
  struct Moving {
    std::string name;
    MovingTransform transform;
  };

  void add(const pugi::xml_node& channel) {
    const std::string address = channel.attribute("target").value();
    const std::optional<Target> target = target_of(document_, address);
    const auto node = target ? node_of_.find(reference_name(target->node)) : node_of_.end();
    if (node == node_of_.end()) {
      const bool is_there = document_.element(address.substr(0, address.find_first_of("/.(")));
      (is_there ? foreign_ : lost_).push_back(shown(address));
      return;
    }
    const std::string place = "channel " + shown(address);
    Moving& moving = moving_
                         .try_emplace(node->second,
                                      Moving{node->first, MovingTransform(transform_elements(document_, target->node))})
                         .first->second;
    const TransformElement& element = moving.transform.elements()[target->element];
    const std::size_t numbers = target->number ? 1 : element.numbers.size();
    SamplerKeys keys = read_sampler(document_, document_.referred(channel.attribute("source").value()), numbers, place);
    if (!keys.doubt.empty()) notes_.push_back(place + ": " + keys.doubt);
    if (keys.curves[0].empty()) {
      notes_.push_back(place + ": no keys");
      return;
    }
    first_ = std::min(first_.value_or(keys.curves[0].front().time), keys.curves[0].front().time);
    last_ = std::max(last_.value_or(keys.curves[0].back().time), keys.curves[0].back().time);
    if (target->number) moving.transform.move(target->element, *target->number, std::move(keys.curves[0]));
    else if (element.kind == ElementKind::matrix && keys.is_straight)
      moving.transform.move(target->element, matrix_keys(keys, address));
    else
      for (std::size_t i = 0; i < numbers; ++i)
        moving.transform.move(target->element, static_cast<int>(i), std::move(keys.curves[i]));
  }

  MatrixKeys matrix_keys(const SamplerKeys& keys, const std::string& address) {
    MatrixKeys result;
    bool has_shear = false;
    for (std::size_t k = 0; k < keys.curves[0].size(); ++k) {
      Eigen::Affine3d map = Eigen::Affine3d::Identity();
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) map(r, c) = keys.curves[static_cast<std::size_t>(4 * r + c)][k].value;
      result.times.push_back(keys.curves[0][k].time);
      result.poses.push_back(pose_of(map, has_shear));
      result.held.push_back(keys.curves[0][k].law == ScalarKey::Law::step);
    }
    if (has_shear) sheared_.push_back(shown(address));
    return result;
  }

  NodeMotion motion_of(const MovingTransform& transform, const std::string& name) {
    const std::string place = "animation of node " + shown(name);
    bool has_shear = false;
    NodeMotion motion;
    try {
      motion = transform.motion(has_shear);
    } catch (const std::length_error&) {
      throw InputError(document_.file(), place, "more turns than can be kept", "a shorter animation");
    }
    if (has_shear) sheared_.push_back(shown(name));
    check(motion.translation, document_.file(), place);
    check(motion.rotation, document_.file(), place);
    check(motion.scale, document_.file(), place);
    return motion;
  }

  const ColladaDocument& document_;
  const std::map<std::string, int>& node_of_;
  std::map<int, Moving> moving_;
  std::optional<double> first_, last_; ///< key times, s
  std::vector<std::string> lost_, foreign_, sheared_, notes_;
};

std::optional<double> time_attribute(const pugi::xml_node& element, const char* name) {
  const pugi::xml_attribute attribute = element.attribute(name);
  const std::optional<double> time = attribute ? number_of(attribute.value()) : std::nullopt;
  return time && std::abs(*time) <= k_largest_number ? time : std::nullopt;
}

/// One <animation_clip>: the keys stay on the time line of the file, of which it is a part.
FileAnimation read_clip(const ColladaDocument& document, const std::map<std::string, int>& node_of,
                        const pugi::xml_node& clip, std::set<const void*>& used) {
  Channels channels;
  std::vector<std::string> missing;
  for (const pugi::xml_node instance : clip.children("instance_animation")) {
    const pugi::xml_node animation = document.referred(instance.attribute("url").value());
    if (std::string_view(animation.name()) == "animation") collect_channels(animation, channels);
    else missing.emplace_back(instance.attribute("url").value());
  }
  for (const pugi::xml_node& channel : channels) used.insert(channel.internal_object());
  FileAnimation result = ClipReader(document, node_of).read(channels);
  result.name = name_of(clip);
  const double last_key = result.end;
  result.start = time_attribute(clip, "start").value_or(0.0);
  result.end = time_attribute(clip, "end").value_or(last_key);
  if (result.end < result.start) {
    result.notes.push_back("the clip ends before it starts: read up to its last key");
    result.end = std::max(last_key, result.start);
  }
  for (const std::string& url : missing)
    result.notes.push_back("instance_animation " + shown(url) + " is not in the file");
  return result;
}

} // namespace

std::vector<FileAnimation> animations(const ColladaDocument& document, const std::map<std::string, int>& node_of) {
  std::vector<pugi::xml_node> tops;
  for (const pugi::xml_node library : document.root().children("library_animations"))
    for (const pugi::xml_node animation : library.children("animation")) tops.push_back(animation);
  Channels all;
  for (const pugi::xml_node& top : tops) collect_channels(top, all);
  if (all.empty()) return {};

  std::vector<FileAnimation> clips;
  std::set<const void*> used;
  for (const pugi::xml_node library : document.root().children("library_animation_clips"))
    for (const pugi::xml_node clip : library.children("animation_clip"))
      clips.push_back(read_clip(document, node_of, clip, used));
  if (clips.empty()) { // animations at the top are a node's each, or one exporter's folders: never takes of their own
    clips.push_back(ClipReader(document, node_of).read(all));
    const auto is_named_as_first = [&](const pugi::xml_node& top) { return name_of(top) == name_of(tops[0]); };
    if (std::ranges::all_of(tops, is_named_as_first)) clips.back().name = name_of(tops[0]);
    return clips;
  }
  std::vector<std::string> unused;
  for (const pugi::xml_node& channel : all)
    if (!used.contains(channel.internal_object())) unused.push_back(shown(channel.attribute("target").value()));
  if (!unused.empty()) clips.back().notes.push_back(listed(unused, "in no clip left out"));
  return clips;
}

} // namespace tutu::rig::import_detail
