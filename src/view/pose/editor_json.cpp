// The editor's state for machines.
#include "src/view/pose/editor.h"

#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

using nlohmann::ordered_json;

ordered_json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
ordered_json json_of(const Vec3f& v) { return json_of(Vec3(v.cast<double>())); }

const char* name_of(EditorQuestion question) {
  switch (question) {
  case EditorQuestion::none: return "";
  case EditorQuestion::take_up_autosave: return "take up autosave";
  case EditorQuestion::leave_unsaved: return "leave unsaved";
  }
  return "";
}

} // namespace

ordered_json Editor::json() const {
  const EditState& now = state();
  const auto joint_name = [&](std::optional<int> joint) {
    return joint ? ordered_json(skeleton().names[*joint]) : ordered_json();
  };
  ordered_json json = {{"character", character_.file},
                       {"clip", clip_file_.string()},
                       {"autosave", autosave_.file().string()},
                       {"question", name_of(question_)},
                       {"message", message_},
                       {"dirty", document_.dirty()},
                       {"undo_depth", document_.undo_depth()},
                       {"redo_depth", document_.redo_depth()},
                       {"selected", joint_name(selected_)},
                       {"hovered", joint_name(hovered_)},
                       {"ring_hovered", ring_hovered_},
                       {"dragging", drag_.has_value()},
                       {"ik", drag_settings_.ik},
                       {"one_child", drag_settings_.one_child},
                       {"time", now.time},
                       {"loose", now.loose},
                       {"closed", is_closed(now)}};
  json["pointer"] = {x_, y_};
  json["camera"] = {{"eye", json_of(picture_.camera.eye)},
                    {"target", json_of(picture_.camera.target)},
                    {"vertical_fov", picture_.camera.vertical_fov},
                    {"width", picture_.width},
                    {"height", picture_.height}};
  json["keys"] = ordered_json::array();
  for (const EditKey& key : now.keys)
    json["keys"].push_back({{"time", key.time}, {"name", key.name}, {"airborne", key.airborne}});
  json["pins"] = ordered_json::array();
  for (const rig::FootPin& pin : now.pins) json["pins"].push_back(skeleton().names[pin.limb.end]);
  json["pose"] = ordered_json::array();
  for (std::size_t j = 0; j < now.pose.size(); ++j) {
    const Quat& q = now.pose[j].rotation;
    json["pose"].push_back({{"joint", skeleton().names[j]},
                            {"translation", json_of(now.pose[j].translation)},
                            {"rotation", {q.x(), q.y(), q.z(), q.w()}}});
  }
  return json;
}

} // namespace tutu::app
