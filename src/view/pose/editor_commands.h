// Everything the pose editor does on a key or from a menu, in one table: menus, keys and the help sheet are made of it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tutu::app {

enum class EditorCommand {
  save_key,
  set_key_here,
  write_files,
  quit,
  undo,
  redo,
  copy,
  paste,
  mirror,
  left_to_right,
  right_to_left,
  rest_joint,
  rest_pose,
  toggle_ik,
  toggle_one_child,
  toggle_pin,
  twist_left,
  twist_right,
  select_parent,
  select_child,
  previous_key,
  next_key,
  duplicate_key,
  delete_key,
  toggle_airborne,
  toggle_loop,
  toggle_onion_skin,
  toggle_body,
  toggle_joints,
  front_view,
  side_view,
  reset_camera,
  help
};

struct CommandEntry {
  EditorCommand command;
  const char* menu;  ///< under which it stands
  const char* label; ///< what it does
  const char* keys;  ///< as shown: "Ctrl+Z", "M", "Delete"
};

std::span<const CommandEntry> command_table();
const CommandEntry& entry_of(EditorCommand command);

/// What a key that writes nothing, or one together with Ctrl, is called in the table: "Delete", "Ctrl+Z".
std::optional<EditorCommand> command_of_key(std::string_view keys);
/// Of a character as typed; upper and lower case alike.
std::optional<EditorCommand> command_of_character(char32_t character);

} // namespace tutu::app
