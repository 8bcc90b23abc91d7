// Collada files of nodes and animations alone, for tests of how motion is read.
#pragma once

#include "rig/import/collada/collada.h"

#include <cstdio>
#include <string>
#include <vector>

namespace tutu::test {

inline std::string listed(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.17g", number);
    text += (text.empty() ? "" : " ") + std::string(digits);
  }
  return text;
}

inline std::string array_source(const std::string& id, const std::string& kind, const std::string& content,
                                std::size_t count, std::size_t stride, std::size_t offset = 0) {
  return "<source id='" + id + "'><" + kind + " id='" + id + "-a' count='" + std::to_string(count * stride + offset) +
         "'>" + content + "</" + kind + "><technique_common><accessor source='#" + id + "-a' count='" +
         std::to_string(count) + "' stride='" + std::to_string(stride) + "' offset='" + std::to_string(offset) +
         "'/></technique_common></source>\n";
}

/// One sampler and its channel. `values` and tangents: stride numbers a key. One law: for all keys; none: left out.
struct TestChannel {
  std::string target;
  std::vector<double> times, values;
  std::vector<std::string> laws = {"LINEAR"};
  std::vector<double> leaving = {}, arriving = {};
};

inline std::string channel_text(const TestChannel& channel, const std::string& id) {
  const std::size_t keys = channel.times.size();
  const auto stride = [&](const std::vector<double>& numbers) { return numbers.size() / keys; };
  std::string text = array_source(id + "-t", "float_array", listed(channel.times), keys, 1) +
                     array_source(id + "-v", "float_array", listed(channel.values), keys, stride(channel.values));
  std::string inputs =
      "<input semantic='INPUT' source='#" + id + "-t'/><input semantic='OUTPUT' source='#" + id + "-v'/>";
  if (!channel.laws.empty()) {
    std::string laws;
    for (std::size_t k = 0; k < keys; ++k) laws += channel.laws[channel.laws.size() == 1 ? 0 : k] + " ";
    text += array_source(id + "-l", "Name_array", laws, keys, 1);
    inputs += "<input semantic='INTERPOLATION' source='#" + id + "-l'/>";
  }
  if (!channel.leaving.empty()) {
    text += array_source(id + "-o", "float_array", listed(channel.leaving), keys, stride(channel.leaving)) +
            array_source(id + "-i", "float_array", listed(channel.arriving), keys, stride(channel.arriving));
    inputs +=
        "<input semantic='OUT_TANGENT' source='#" + id + "-o'/><input semantic='IN_TANGENT' source='#" + id + "-i'/>";
  }
  return text + "<sampler id='" + id + "-s'>" + inputs + "</sampler><channel source='#" + id + "-s' target='" +
         channel.target + "'/>\n";
}

inline std::string animation_text(const TestChannel& channel, const std::string& id) {
  return "<animation id='" + id + "'>" + channel_text(channel, id) + "</animation>\n";
}

/// A document of these nodes and animations.
inline std::string motion_text(const std::string& nodes, const std::string& animations, const std::string& clips = {}) {
  return "<?xml version='1.0' encoding='utf-8'?>\n<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><library_visual_scenes><visual_scene id='Scene'>" +
         nodes + "</visual_scene></library_visual_scenes><library_animations>" + animations + "</library_animations>" +
         clips + "</COLLADA>\n";
}

/// The clips of a document with one node "a" (0) of this transform, moved by the channels, an animation each.
inline std::vector<rig::import_detail::FileAnimation> clips_of(const std::string& transform,
                                                               const std::vector<TestChannel>& channels) {
  std::string animations;
  for (std::size_t i = 0; i < channels.size(); ++i) animations += animation_text(channels[i], "m" + std::to_string(i));
  const std::string text = motion_text("<node id='a'>" + transform + "</node>", animations);
  return rig::import_detail::animations(rig::import_detail::ColladaDocument("test.dae", text), {{"a", 0}});
}

} // namespace tutu::test
