#include "rig/import/gltf/animations.h"

#include <algorithm>
#include <array>
#include <map>

namespace tutu::rig::import_detail {
namespace {

using Vec4 = Eigen::Vector4d;

constexpr std::array<std::string_view, 3> k_paths = {"translation", "rotation", "scale"};
constexpr std::array<std::string_view, 3> k_laws = {"STEP", "LINEAR", "CUBICSPLINE"}; // as Law has them

/// Reads one animation.
class AnimationReader {
public:
  AnimationReader(const GltfValue& from, GltfAccessors& accessors, const GltfNodes& nodes, GltfRotations& rotations,
                  const std::string& file)
      : from_(from), accessors_(accessors), nodes_(nodes), rotations_(rotations), file_(file) {}

  FileAnimation read() {
    animation_.name = from_.text_or("name", "");
    for (const GltfValue& channel : from_.at("channels").items()) add(channel);
    for (auto& [node, motion] : motions_) {
      motion.node = node;
      animation_.nodes.push_back(std::move(motion));
    }
    note_what_is_left();
    return std::move(animation_);
  }

private:
  void add(const GltfValue& channel) {
    const GltfValue target = channel.at("target");
    const std::string& path = target.at("path").text();
    if (path == "pointer" || target.extension("KHR_animation_pointer")) {
      ++pointers_;
      return;
    }
    const std::optional<GltfValue> reference = target.find("node");
    if (!reference) return; // to be ignored [glTF 2.0, 3.11]
    const std::size_t node = accessors_.document().target_index(*reference, "nodes");
    if (path == "weights") {
      ++morphs_;
      return;
    }
    if (std::find(k_paths.begin(), k_paths.end(), path) == k_paths.end())
      throw target.at("path").error("translation, rotation, scale or weights");
    const auto [other, is_new] = channels_.try_emplace({node, path}, channel.pointer());
    if (!is_new)
      throw channel.error("a second channel for the " + path + " of node " + std::to_string(node) + ", besides " +
                              other->second,
                          "one channel a node and path");
    const GltfValue sampler = sampler_of(channel);
    NodeMotion& motion = motions_[nodes_.node_of[node]];
    if (path == "rotation") motion.rotation = rotations_of(sampler);
    else (path == "scale" ? motion.scale : motion.translation) = vectors_of(sampler);
  }

  GltfValue sampler_of(const GltfValue& channel) const {
    const GltfValue reference = channel.at("sampler"), samplers = from_.at("samplers");
    if (reference.whole() >= samplers.size())
      throw reference.error(std::to_string(reference.whole()),
                            "an index below " + std::to_string(samplers.size()) + ": one of samplers");
    return samplers.item(reference.whole());
  }

  VectorCurve vectors_of(const GltfValue& sampler) {
    VectorCurve curve;
    read_curve(sampler, "VEC3", curve);
    check(curve, file_, sampler.pointer());
    return curve;
  }
  RotationCurve rotations_of(const GltfValue& sampler) {
    RotationCurve curve;
    const bool is_coarse = read_curve(sampler, "VEC4", curve);
    for (std::size_t k = 0; k < curve.values.size(); ++k) {
      const double length = curve.values[k].norm();
      curve.values[k] =
          rotations_.unit(curve.values[k], is_coarse ? GltfRotations::k_rounding_of_bytes : GltfRotations::k_rounding,
                          sampler.pointer(), static_cast<int>(k));
      if (curve.leaving.empty()) continue;
      curve.leaving[k] /= length; // the same way, in the same time
      curve.arriving[k] /= length;
    }
    check(curve, file_, sampler.pointer());
    return curve;
  }

  /// Are the values integers of 8 bits?
  template <typename Value> bool read_curve(const GltfValue& sampler, std::string_view type, Curve<Value>& curve) {
    const GltfElements input = accessors_.elements(sampler.at("input"), "SCALAR");
    const GltfElements output = accessors_.elements(sampler.at("output"), type);
    const std::string law = sampler.text_or("interpolation", "LINEAR");
    const auto known = std::find(k_laws.begin(), k_laws.end(), law);
    if (known == k_laws.end()) throw sampler.at("interpolation").error("STEP, LINEAR or CUBICSPLINE");
    const bool is_cubic = law == "CUBICSPLINE";
    const std::size_t keys = input.count, values = (is_cubic ? 3 : 1) * keys;
    if (keys == 0) throw sampler.at("input").error("no key", "at least one");
    if (output.count != values)
      throw sampler.at("output").error(std::to_string(output.count) + " values for " + std::to_string(keys) + " keys",
                                       std::to_string(values));
    accessors_.memory().take((2 * keys + 2 * output.numbers()) * sizeof(double), sampler.pointer());

    curve.times.resize(keys);
    read_numbers(input, curve.times.data());
    check_times(sampler.at("input"), curve.times);
    std::vector<Value> all(values);
    read_numbers(output, all.front().data()); // doubles, packed
    curve.laws.assign(keys, static_cast<Law>(known - k_laws.begin()));
    if (!is_cubic) {
      curve.values = std::move(all);
    } else {
      for (std::size_t k = 0; k < keys; ++k) { // in-tangent, value, out-tangent [glTF 2.0, C.5]
        curve.arriving.push_back(all[3 * k]);
        curve.values.push_back(all[3 * k + 1]);
        curve.leaving.push_back(all[3 * k + 2]);
      }
    }
    animation_.end = std::max(animation_.end, curve.times.back());
    return output.component == GltfComponent::int8 || output.component == GltfComponent::uint8;
  }

  void check_times(const GltfValue& input, const std::vector<double>& times) {
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (!(std::abs(times[k]) <= k_largest_number))
        throw input.error("key " + std::to_string(k) + " at a time that is no number", "times within +-1e9 s");
      if (k == 0) continue;
      if (times[k] < times[k - 1])
        throw input.error("key " + std::to_string(k) + " at " + std::to_string(times[k]) + " s after one at " +
                              std::to_string(times[k - 1]) + " s",
                          "times that rise");
      jumps_ += times[k] == times[k - 1] ? 1 : 0;
    }
    early_ |= times.front() < 0.0;
  }

  void note_what_is_left() {
    std::vector<std::string>& notes = animation_.notes;
    if (morphs_ > 0) notes.push_back("it animates the weights of morph targets, which stand still here");
    if (pointers_ > 0) notes.push_back("it has channels of KHR_animation_pointer, which are not read");
    if (jumps_ > 0)
      notes.push_back("it has keys at the time of the one before (" + std::to_string(jumps_) + "): jumps");
    if (early_) notes.push_back("it has keys before 0 s, which are not played");
  }

  const GltfValue& from_;
  GltfAccessors& accessors_;
  const GltfNodes& nodes_;
  GltfRotations& rotations_;
  const std::string& file_;
  FileAnimation animation_;
  std::map<int, NodeMotion> motions_;                                   ///< by FileScene's node
  std::map<std::pair<std::size_t, std::string>, std::string> channels_; ///< by node and path: where
  std::size_t morphs_ = 0, pointers_ = 0, jumps_ = 0;
  bool early_ = false;
};

} // namespace

void read_animations(GltfAccessors& accessors, const GltfNodes& nodes, GltfRotations& rotations, FileScene& scene) {
  for (const GltfValue& animation : accessors.document().root().items("animations"))
    scene.animations.push_back(AnimationReader(animation, accessors, nodes, rotations, scene.file).read());
}

} // namespace tutu::rig::import_detail
