// The pose editor without its window: what pointer, keys and menus do to the work. Nothing here draws.
#pragma once

#include "rig/character.h"
#include "src/view/pose/drag_action.h"
#include "src/view/pose/edit_document.h"
#include "src/view/pose/editor_commands.h"
#include "src/view/pose/pose_files.h"
#include "src/view/window/input_queue.h"
#include "src/view/window/orbit.h"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// A question that waits for its answer; until then pointer and keys are not the pose's.
enum class EditorQuestion { none, take_up_autosave, leave_unsaved };
enum class Answer { yes, no, cancel };

struct EditorView {
  bool onion_skin = true, body = true, joints = true, help = false;
};

class Editor {
public:
  /// `start`: what is in `clip_file`, or a rest pose. The character must outlive it.
  Editor(const rig::Character& character, EditState start, const std::filesystem::path& clip_file,
         std::vector<rig::JointLimit> limits);

  /// The picture's size, px, and how many px one of a common display is. The first call frames the body.
  void resize(int width, int height, float pixel_scale);

  // The pointer, in px of the picture. Shift is the hand that poses; without it the camera moves.
  void point(double x, double y, bool shift);
  void press(PointerButton button);
  void release();
  void wheel(double notches);

  void run(EditorCommand command);
  bool is_on(EditorCommand toggle) const; ///< of one that switches something
  void select(int joint) { selected_ = joint; }

  // The timeline. A scrub or a move is a gesture: keep() ends it.
  void scrub(double time);
  int show_key_moved(int key, double time, bool with_later); ///< the key's index then
  void keep();
  void rename_key(int key, const std::string& name);
  void set_interpolation(rig::Interpolation interpolation);
  void set_interval(double seconds) { interval_ = seconds; }

  void answer(Answer answer);
  void ask_to_leave(); ///< leaves at once when nothing is unsaved

  const rig::Character& character() const { return character_; }
  const rig::Skeleton& skeleton() const { return character_.skeleton; }
  const EditDocument& document() const { return document_; }
  const EditState& state() const { return document_.state(); }
  const Picture& picture() const { return picture_; }
  const EditorView& view() const { return view_; }
  const std::filesystem::path& clip_file() const { return clip_file_; }
  const Autosave& autosave() const { return autosave_; }
  const std::string& message() const { return message_; } ///< "" or one sentence about what was done last
  std::optional<int> hovered() const { return hovered_; }
  std::optional<int> selected() const { return selected_; }
  bool ring_hovered() const { return ring_hovered_; }
  std::optional<int> current_key() const { return key_at(state(), state().time); }
  double interval() const { return interval_; }
  float pixel_scale() const { return pixel_scale_; }
  float ground_height() const { return ground_height_; } ///< m, where she stands at rest
  EditorQuestion question() const { return question_; }
  bool done() const { return done_; }
  std::vector<Transform> model_from_joint() const;

  /// Everything a machine may ask about (--json).
  nlohmann::ordered_json json() const;

private:
  Ray ray() const { return ray_through(picture_, x_, y_); }
  void hover();
  void change(EditState next);
  void after_change();
  void change_pose(Pose pose);
  void toggle_pin();
  void twist(double degrees);
  void select_beside(bool parent);
  void step_key(int direction);
  void write();
  void look(float yaw);

  const rig::Character& character_;
  std::vector<BodyLimb> limbs_;
  DragSettings drag_settings_;
  std::filesystem::path clip_file_;
  Autosave autosave_;
  EditDocument document_;
  std::optional<EditState> left_behind_; ///< an earlier session's autosave
  std::optional<Pose> clipboard_;
  std::optional<DragAction> drag_;
  std::optional<PointerButton> camera_button_;
  std::optional<int> hovered_, selected_;
  bool ring_hovered_ = false, shift_ = false, framed_ = false, done_ = false;
  double x_ = 0.0, y_ = 0.0;
  OrbitCamera orbit_;
  Picture picture_;
  float pixel_scale_ = 1.0f, ground_height_ = 0.0f;
  EditorView view_;
  EditorQuestion question_ = EditorQuestion::none;
  double interval_ = 0.5; ///< s between a key and the next one saved
  std::string message_;
};

} // namespace tutu::app
