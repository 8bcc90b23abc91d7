// Takes of an FBX file: which curves move which model, and which node that is.
#include "rig/error.h"
#include "rig/import/detail/parts.h"
#include "rig/import/fbx/curve_keys.h"
#include "rig/import/fbx/fbx.h"
#include "rig/import/fbx/model_motion.h"
#include "rig/text.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tutu::rig::import_detail {
namespace {

/// "3 models whose ...: a, b, c and 4 more".
std::string listed(const std::vector<std::string>& names, const std::string& what) {
  return count_of(names.size(), "model") + " " + what + ": " + list_of(names);
}

/// The nodes that a reader has made of models: it walks both trees side by side.
class NodesOfModels {
public:
  NodesOfModels(const FbxDocument& document, const std::vector<FileNode>& nodes) : taken_(nodes.size(), false) {
    for (std::size_t n = nodes.size(); n-- > 1;) { // the first comes to stand last, to be taken first
      const std::string_view name = nodes[n].name;
      children_[{nodes[n].parent, name}].push_back(static_cast<int>(n));
      if (has_digits(name))
        with_digits_[{nodes[n].parent, name.substr(0, name.size() - k_digits)}].push_back(static_cast<int>(n));
    }
    std::vector<std::pair<std::int64_t, int>> open = {{0, 0}}; // the scene has no object of its own
    while (!open.empty() && !nodes.empty()) {
      const auto [id, node] = open.back();
      open.pop_back();
      for (const FbxConnection& part : document.parts_of(id)) {
        const FbxObject* model = document.object(part.part);
        if (!model || model->kind != "Model" || !part.property.empty() || of_model_.contains(part.part)) continue;
        int child = take(children_, node, model->name);
        if (child < 0) child = take(with_digits_, node, model->name);
        if (child < 0) continue;
        of_model_.emplace(part.part, child);
        open.emplace_back(part.part, child);
      }
    }
  }

  int node_of(std::int64_t model) const { // -1 for none
    const auto found = of_model_.find(model);
    return found == of_model_.end() ? -1 : found->second;
  }

private:
  using Children = std::map<std::pair<int, std::string_view>, std::vector<int>>; ///< by parent and name

  static constexpr std::size_t k_digits = 3; ///< that a reader puts behind a name to tell it apart
  static bool has_digits(std::string_view name) {
    return name.size() > k_digits && name.find_last_not_of("0123456789") < name.size() - k_digits;
  }

  int take(Children& from, int parent, std::string_view name) {
    const auto found = from.find({parent, name});
    while (found != from.end() && !found->second.empty()) {
      const int child = found->second.back();
      found->second.pop_back();
      if (taken_[static_cast<std::size_t>(child)]) continue;
      taken_[static_cast<std::size_t>(child)] = true;
      return child;
    }
    return -1;
  }

  Children children_, with_digits_;
  std::vector<bool> taken_;
  std::map<std::int64_t, int> of_model_;
};

class TakeReader {
public:
  TakeReader(const FbxDocument& document, const NodesOfModels& nodes) : document_(document), nodes_(nodes) {}

  /// None where no model of a node moves.
  std::optional<FileAnimation> read(const FbxObject& stack) {
    const std::vector<const FbxObject*> layers = parts(stack.id, "AnimationLayer");
    if (layers.empty()) return std::nullopt;
    find_moved_models();
    for (const FbxObject* curve_node : parts(layers[0]->id, "AnimationCurveNode")) add(*curve_node);
    FileAnimation animation;
    animation.name = plain_text(stack.name);
    for (auto& [id, model] : models_) add_motion(id, model, animation);
    if (animation.nodes.empty() && lost_.empty()) return std::nullopt;
    std::ranges::sort(animation.nodes, {}, &NodeMotion::node);
    set_time_line(stack, animation);
    for (std::size_t l = 1; l < layers.size(); ++l)
      if (!parts(layers[l]->id, "AnimationCurveNode").empty())
        animation.notes.push_back("layer " + plain_text(layers[l]->name) + " left out: only the base layer is read");
    const auto note = [&](const std::vector<std::string>& names, const char* what) {
      if (!names.empty()) animation.notes.push_back(listed(names, what));
    };
    note(lost_, "without a node, whose motion is left out");
    note(extrapolated_, "whose curves go on beyond their keys, held there");
    note(slerped_, "with rotations to be blended as quaternions, blended axis by axis");
    note(detached_, "that do not inherit the scale of their parent, which they do here");
    return animation;
  }

private:
  std::vector<const FbxObject*> parts(std::int64_t id, std::string_view kind) const {
    std::vector<const FbxObject*> found;
    for (const FbxConnection& part : document_.parts_of(id))
      if (const FbxObject* object = document_.object(part.part); object && object->kind == kind)
        found.push_back(object);
    return found;
  }

  /// Which model and property each curve node drives.
  void find_moved_models() {
    for (const FbxObject& object : document_.objects())
      if (object.kind == "Model")
        for (const FbxConnection& part : document_.parts_of(object.id))
          if (!part.property.empty()) driven_.emplace(part.part, std::pair(&object, part.property));
  }

  void add(const FbxObject& curve_node) {
    const auto [first, last] = driven_.equal_range(curve_node.id);
    for (auto driven = first; driven != last; ++driven) {
      const auto [object, property] = driven->second;
      if (property != "Lcl Translation" && property != "Lcl Rotation" && property != "Lcl Scaling") continue;
      const auto model = models_.try_emplace(object->id, model_of(document_, *object)).first;
      FbxTrack& track = property == "Lcl Translation" ? model->second.translation
                        : property == "Lcl Rotation"  ? model->second.rotation
                                                      : model->second.scale;
      read_track(curve_node, *object, track);
    }
  }

  void read_track(const FbxObject& curve_node, const FbxObject& model, FbxTrack& track) {
    constexpr std::string_view k_axes[] = {"d|X", "d|Y", "d|Z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<double> value = document_.own_number(curve_node, k_axes[axis]);
      if (value && std::abs(*value) <= k_largest_number) track.constant[static_cast<Eigen::Index>(axis)] = *value;
      for (const FbxConnection& part : document_.parts_of(curve_node.id)) {
        const FbxObject* curve = document_.object(part.part);
        if (!curve || curve->kind != "AnimationCurve" || part.property != k_axes[axis]) continue;
        track.curves[axis] = curve_keys(*curve->element, document_.tree(), document_.ticks_per_second());
        if (!track.curves[axis].empty() && is_extrapolated(*curve->element))
          note_once(extrapolated_, plain_text(model.name));
      }
    }
  }

  static void note_once(std::vector<std::string>& names, const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }

  void add_motion(std::int64_t id, const FbxModel& model, FileAnimation& animation) {
    const FbxObject& object = *document_.object(id);
    const std::string name = plain_text(object.name);
    const int node = nodes_.node_of(id);
    if (node < 0) {
      if (model.moves()) note_once(lost_, name);
      return;
    }
    for (const FbxTrack* track : {&model.translation, &model.rotation, &model.scale})
      for (const ScalarCurve& curve : track->curves) {
        if (curve.empty()) continue;
        first_ = std::min(first_.value_or(curve.front().time), curve.front().time);
        last_ = std::max(last_.value_or(curve.back().time), curve.back().time);
      }
    if (model.rotation.moves() && document_.number(object, "QuaternionInterpolate", 0.0) != 0.0)
      note_once(slerped_, name);
    if (is_detached(object)) note_once(detached_, name);
    NodeMotion motion = motion_of(model, model_of(document_, object));
    motion.node = node;
    if (!motion.translation.empty() || !motion.rotation.empty() || !motion.scale.empty())
      animation.nodes.push_back(std::move(motion));
  }

  /// Under a parent whose scale it does not inherit, and which has one.
  bool is_detached(const FbxObject& object) const {
    constexpr double k_without_parent_scale = 2.0;
    if (document_.number(object, "InheritType", 0.0) != k_without_parent_scale) return false;
    const FbxObject* parent = document_.parent_of(object);
    if (!parent) return false;
    const auto moving = models_.find(parent->id);
    const FbxModel model = moving != models_.end() ? moving->second : model_of(document_, *parent);
    constexpr double k_same_scale = 1e-4;
    return model.scale.moves() || !(model.scale.constant - Vec3::Ones()).isZero(k_same_scale);
  }

  void set_time_line(const FbxObject& stack, FileAnimation& animation) const {
    const std::optional<std::int64_t> stop = document_.own_integer(stack, "LocalStop");
    const std::int64_t start = document_.own_integer(stack, "LocalStart").value_or(0); // what is 0 may be left out
    if (stop && *stop > start) {
      animation.start = static_cast<double>(start) / document_.ticks_per_second();
      animation.end = static_cast<double>(*stop) / document_.ticks_per_second();
      return;
    }
    animation.start = std::min(first_.value_or(0.0), 0.0);
    animation.end = std::max(last_.value_or(0.0), animation.start);
  }

  const FbxDocument& document_;
  const NodesOfModels& nodes_;
  std::multimap<std::int64_t, std::pair<const FbxObject*, std::string_view>> driven_; ///< by curve node
  std::map<std::int64_t, FbxModel> models_;
  std::optional<double> first_, last_; ///< key times, s
  std::vector<std::string> lost_, extrapolated_, slerped_, detached_;
};

void check_curves(const FileAnimation& animation) {
  try {
    for (const NodeMotion& motion : animation.nodes) {
      check(motion.translation, "", "");
      check(motion.rotation, "", "");
      check(motion.scale, "", "");
    }
    const double latest = std::max(std::abs(animation.start), std::abs(animation.end));
    if (!(latest <= k_largest_number)) throw FbxUnreadable("with a time line beyond all measure");
  } catch (const InputError& error) {
    throw FbxUnreadable("with " + error.found());
  }
}

} // namespace

FbxMotion fbx_motion(std::string_view bytes, const std::vector<FileNode>& nodes) {
  FbxMotion result;
  try {
    const FbxDocument document(bytes);
    const NodesOfModels nodes_of_models(document, nodes);
    for (const FbxObject& object : document.objects()) {
      const int node = object.kind == "Model" ? nodes_of_models.node_of(object.id) : -1;
      if (node < 0) continue;
      const Pose pose = model_of(document, object).at(0.0, Side::behind);
      result.locals.emplace(node, Eigen::Translation3d(pose.translation) * pose.rotation * Eigen::Scaling(pose.scale));
    }
    for (const FbxObject& object : document.objects()) {
      if (object.kind != "AnimationStack") continue;
      std::optional<FileAnimation> take = TakeReader(document, nodes_of_models).read(object);
      if (!take) continue;
      check_curves(*take);
      result.animations.push_back(std::move(*take));
    }
  } catch (const FbxUnreadable& error) {
    result = {{}, {}, error.what()};
  } catch (const std::length_error&) {
    result = {{}, {}, "with more turns than can be kept"};
  }
  return result;
}

} // namespace tutu::rig::import_detail
