#include "src/view/pose/editor.h"

#include "src/view/pose/mirror.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>

namespace tutu::app {
namespace {

constexpr double k_joint_reach = 14.0, k_ring_reach = 7.0; // px of a common display, around the pointer
constexpr double k_sure_reach = 6.0;                       // px: a joint this near wins over a ring
constexpr double k_twist_step = 5.0;                       // degrees a key press
constexpr float k_below = 0.1f;                            // of the height, left free below
constexpr float k_start_yaw = 0.35f, k_start_pitch = 0.08f;
constexpr float k_flesh = 0.15f; // m around the joints: a head, a hand

/// m; the ground is at 0 for whoever stands there to a finger's breadth, else below the lowest point of the body at
/// rest.
float ground_of(const rig::Character& character) {
  constexpr float k_finger = 0.02f;
  std::vector<rig::SkinMatrix> palette(character.skin.slot_count());
  std::vector<Vec3f> positions(character.mesh.positions.size());
  rig::skinning_palette(character.skin, rig::rest_model(character.skeleton), palette);
  rig::skin_vertices(character.mesh, character.skin, palette, positions, {});
  float lowest = positions.empty() ? 0.0f : positions.front().y();
  for (const Vec3f& p : positions) lowest = std::min(lowest, p.y());
  return std::abs(lowest) < k_finger ? 0.0f : lowest;
}

} // namespace

Editor::Editor(const rig::Character& character, EditState start, const std::filesystem::path& clip_file,
               std::vector<rig::JointLimit> limits)
    : character_(character), limbs_(find_limbs(character.skeleton)), clip_file_(clip_file), autosave_(clip_file),
      document_(std::move(start)), ground_height_(ground_of(character)) {
  drag_settings_.limits = std::move(limits);
  left_behind_ = autosave_.found(character.skeleton, message_);
  if (left_behind_) question_ = EditorQuestion::take_up_autosave;
}

std::vector<Transform> Editor::model_from_joint() const {
  std::vector<Transform> model(state().pose.size());
  rig::model_from_local(skeleton(), state().pose, model);
  return model;
}

void Editor::resize(int width, int height, float pixel_scale) {
  picture_.width = width;
  picture_.height = height;
  pixel_scale_ = pixel_scale;
  if (!framed_) look(k_start_yaw);
  framed_ = true;
}

void Editor::look(float yaw) {
  Eigen::AlignedBox3f box;
  for (const Transform& joint : model_from_joint()) box.extend(joint.translation.cast<float>());
  // The ground is seen too, above the timeline.
  box.min().y() = std::min(box.min().y(), ground_height_) - k_below * box.sizes().y();
  orbit_ = frame_orbit(box.min().array() - k_flesh, box.max().array() + k_flesh, yaw, k_start_pitch,
                       static_cast<float>(picture_.width) / static_cast<float>(picture_.height));
  picture_.camera = orbit_.camera();
}

void Editor::point(double x, double y, bool shift) {
  const auto dx = static_cast<float>(x - x_), dy = static_cast<float>(y - y_);
  const bool moved = x != x_ || y != y_;
  x_ = x;
  y_ = y;
  shift_ = shift;
  if (question_ != EditorQuestion::none) return;
  if (drag_) {
    if (moved) document_.show(drag_->at(ray()));
  } else if (camera_button_) {
    if (*camera_button_ == PointerButton::left) rotate(orbit_, dx, dy, picture_.height);
    else pan(orbit_, dx, dy, picture_.height);
    picture_.camera = orbit_.camera();
  } else {
    hover();
  }
}

void Editor::hover() {
  hovered_.reset();
  ring_hovered_ = false;
  if (!shift_) return;
  const std::vector<Transform> model = model_from_joint();
  const auto within = [&](double reach) { return nearest_joint(picture_, model, x_, y_, reach * pixel_scale_); };
  hovered_ = within(k_sure_reach);
  if (!hovered_ && selected_)
    if (const auto ring = ring_of(skeleton(), state().pose, *selected_))
      ring_hovered_ = pixels_to_ring(picture_, *ring, x_, y_) <= k_ring_reach * pixel_scale_;
  if (!hovered_ && !ring_hovered_) hovered_ = within(k_joint_reach);
}

void Editor::press(PointerButton button) {
  if (question_ != EditorQuestion::none || drag_ || camera_button_) return;
  hover();
  if (button != PointerButton::left || !(hovered_ || ring_hovered_)) {
    camera_button_ = button;
    return;
  }
  if (hovered_) selected_ = hovered_;
  const Vec3 forward = (picture_.camera.target - picture_.camera.eye).cast<double>().normalized();
  drag_.emplace(skeleton(), limbs_, drag_settings_, state(), ring_hovered_ ? Grip::ring : Grip::joint, *selected_,
                ray(), forward);
}

void Editor::release() {
  camera_button_.reset();
  if (!drag_) return;
  drag_.reset();
  keep();
  hover();
}

void Editor::wheel(double notches) {
  zoom(orbit_, static_cast<float>(notches));
  picture_.camera = orbit_.camera();
}

void Editor::keep() {
  if (!document_.in_gesture()) return;
  document_.keep();
  after_change();
}

void Editor::change(EditState next) {
  document_.change(std::move(next));
  after_change();
}

void Editor::after_change() {
  try {
    autosave_.update(document_, skeleton());
  } catch (const std::exception& error) { // a full disk must not end the session
    message_ = std::string("no autosave: ") + error.what();
  }
}

void Editor::change_pose(Pose pose) {
  if (same_pose(pose, state().pose)) return;
  EditState next = state();
  next.pose = std::move(pose);
  next.loose = true;
  next.pins.clear();
  change(std::move(next));
}

void Editor::toggle_pin() {
  const auto limb = selected_ ? limb_ending_at(limbs_, *selected_) : std::nullopt;
  if (!limb || !limb->leg) {
    message_ = "select a foot to pin it";
    return;
  }
  EditState next = state();
  const auto is_this = [&](const rig::FootPin& pin) { return pin.limb.end == *selected_; };
  if (std::erase_if(next.pins, is_this) == 0) {
    const rig::FootPin pin = rig::pin_to_ground(skeleton(), next.pose, limb->limb, 0.0);
    rig::hold_foot(skeleton(), next.pose, pin, pole_of(skeleton(), next.pose, *limb), drag_settings_.limits);
    next.loose = next.loose || !same_pose(next.pose, state().pose);
    next.pins.push_back(pin);
  }
  change(std::move(next));
}

void Editor::twist(double degrees) {
  if (!selected_) return;
  const auto ring = ring_of(skeleton(), state().pose, *selected_);
  if (!ring) return;
  // As if the ring had been dragged by that angle: the same limits, the same pins.
  const double angle = degrees * std::numbers::pi / 180.0;
  const auto down_on = [&](double at) { return Ray{ring->at(at) + ring->axis, -ring->axis}; };
  DragAction action(skeleton(), limbs_, drag_settings_, state(), Grip::ring, *selected_, down_on(0.0), ring->axis);
  change(action.at(down_on(angle)));
}

void Editor::select_beside(bool parent) {
  if (!selected_) {
    selected_ = 0;
    return;
  }
  const auto& parents = skeleton().parents;
  if (parent && parents[*selected_] != rig::k_no_parent) selected_ = parents[*selected_];
  if (parent) return;
  const auto child = std::find(parents.begin(), parents.end(), *selected_);
  if (child != parents.end()) selected_ = static_cast<int>(child - parents.begin());
}

void Editor::step_key(int direction) {
  const std::vector<EditKey>& keys = state().keys;
  if (keys.empty()) return;
  const auto key = current_key();
  int to = 0;
  if (key) to = *key + direction;
  else
    to = static_cast<int>(
             std::count_if(keys.begin(), keys.end(), [&](const EditKey& k) { return k.time < state().time; })) -
         (direction < 0 ? 1 : 0);
  scrub(keys[std::clamp(to, 0, static_cast<int>(keys.size()) - 1)].time);
  keep();
}

void Editor::write() {
  if (state().keys.empty()) {
    message_ = "there is no key to write yet: S saves the pose as one";
    return;
  }
  EditState next = state();
  close_loop(next, interval_);
  if (!same_clip(next, state())) change(next);
  try {
    write_pose_files(state(), skeleton(), clip_file_);
  } catch (const std::exception& error) {
    message_ = std::string("not written: ") + error.what();
    return;
  }
  document_.mark_written();
  after_change();
  message_ = "wrote " + clip_file_.filename().string() + " and its three texts";
}

bool Editor::is_on(EditorCommand toggle) const {
  switch (toggle) {
  case EditorCommand::toggle_ik: return drag_settings_.ik;
  case EditorCommand::toggle_one_child: return drag_settings_.one_child;
  case EditorCommand::toggle_pin:
    return selected_ && std::any_of(state().pins.begin(), state().pins.end(),
                                    [&](const rig::FootPin& pin) { return pin.limb.end == *selected_; });
  case EditorCommand::toggle_airborne: return current_key() && state().keys[*current_key()].airborne;
  case EditorCommand::toggle_loop: return state().extrapolation == rig::Extrapolation::loop;
  case EditorCommand::toggle_onion_skin: return view_.onion_skin;
  case EditorCommand::toggle_body: return view_.body;
  case EditorCommand::toggle_joints: return view_.joints;
  case EditorCommand::help: return view_.help;
  default: return false;
  }
}

void Editor::run(EditorCommand command) {
  if (question_ != EditorQuestion::none || drag_) return;
  keep();
  message_.clear();
  const Pose& pose = state().pose;
  EditState next = state();
  const auto key = current_key();
  using enum EditorCommand;
  switch (command) {
  case save_key: add_next_key(next, interval_); return change(std::move(next));
  case EditorCommand::set_key_here: tutu::app::set_key_here(next); return change(std::move(next));
  case write_files: return write();
  case quit: return ask_to_leave();
  case undo:
  case redo:
    if (command == undo ? document_.undo() : document_.redo()) after_change();
    else message_ = command == undo ? "nothing to undo" : "nothing to redo";
    return;
  case copy: clipboard_ = pose; return;
  case paste:
    if (clipboard_) change_pose(*clipboard_);
    else message_ = "no pose was copied yet";
    return;
  case mirror: return change_pose(mirrored(skeleton(), pose));
  case left_to_right: return change_pose(copied_across(skeleton(), pose, rig::Side::left));
  case right_to_left: return change_pose(copied_across(skeleton(), pose, rig::Side::right));
  case rest_joint:
    if (!selected_) return;
    next.pose[*selected_] = skeleton().rest_local[*selected_];
    return change_pose(std::move(next.pose));
  case rest_pose: return change_pose(skeleton().rest_local);
  case toggle_ik: drag_settings_.ik = !drag_settings_.ik; return;
  case toggle_one_child: drag_settings_.one_child = !drag_settings_.one_child; return;
  case EditorCommand::toggle_pin: return Editor::toggle_pin();
  case twist_left: return twist(-k_twist_step);
  case twist_right: return twist(k_twist_step);
  case select_parent: return select_beside(true);
  case select_child: return select_beside(false);
  case previous_key: return step_key(-1);
  case EditorCommand::next_key: return step_key(1);
  case EditorCommand::duplicate_key:
  case EditorCommand::delete_key:
  case toggle_airborne:
    if (!key) {
      message_ = "the playhead is on no key";
      return;
    }
    if (command == EditorCommand::duplicate_key) {
      next.time = next.keys[tutu::app::duplicate_key(next, *key, interval_)].time;
      next.pose = *next.keys[*key_at(next, next.time)].pose;
    } else if (command == EditorCommand::delete_key) {
      tutu::app::delete_key(next, *key);
    } else {
      next.keys[*key].airborne = !next.keys[*key].airborne;
    }
    return change(std::move(next));
  case toggle_loop:
    next.extrapolation = is_on(toggle_loop) ? rig::Extrapolation::clamp : rig::Extrapolation::loop;
    return change(std::move(next));
  case toggle_onion_skin: view_.onion_skin = !view_.onion_skin; return;
  case toggle_body: view_.body = !view_.body; return;
  case toggle_joints: view_.joints = !view_.joints; return;
  case front_view: return look(0.0f);
  case side_view: return look(0.5f * std::numbers::pi_v<float>);
  case reset_camera: return look(k_start_yaw);
  case help: view_.help = !view_.help; return;
  }
}

void Editor::scrub(double time) {
  EditState next = state();
  if (next.loose && !next.keys.empty()) message_ = "the pose in hand was in no key; Ctrl+Z brings it back";
  seek(next, skeleton(), time);
  document_.show(std::move(next));
}

int Editor::show_key_moved(int key, double time, bool with_later) {
  EditState next = state();
  if (with_later) retime_from(next, key, time);
  else key = move_key(next, key, time);
  next.time = next.keys[key].time;
  document_.show(std::move(next));
  return key;
}

void Editor::rename_key(int key, const std::string& name) {
  EditState next = state();
  next.keys[key].name = name;
  change(std::move(next));
}

void Editor::set_interpolation(rig::Interpolation interpolation) {
  EditState next = state();
  next.interpolation = interpolation;
  change(std::move(next));
}

void Editor::ask_to_leave() {
  keep();
  if (question_ == EditorQuestion::take_up_autosave) done_ = true; // unanswered: it will be offered again
  else if (document_.dirty()) question_ = EditorQuestion::leave_unsaved;
  else done_ = true;
}

void Editor::answer(Answer answer) {
  const EditorQuestion asked = question_;
  question_ = EditorQuestion::none;
  if (asked == EditorQuestion::take_up_autosave) {
    if (answer == Answer::yes) {
      change(std::move(*left_behind_));
      message_ = "the unsaved work is back";
    } else {
      autosave_.remove();
    }
    left_behind_.reset();
  }
  if (asked != EditorQuestion::leave_unsaved || answer == Answer::cancel) return;
  if (answer == Answer::yes) {
    if (state().loose) run(EditorCommand::save_key);
    write();
    done_ = !document_.dirty(); // not when it could not be written
  } else {
    autosave_.remove();
    done_ = true;
  }
}

} // namespace tutu::app
