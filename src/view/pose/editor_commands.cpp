#include "src/view/pose/editor_commands.h"

#include <algorithm>
#include <array>

namespace tutu::app {
namespace {

using enum EditorCommand;

constexpr std::array<CommandEntry, 33> k_table = {{
    {save_key, "File", "Save the pose as the next key", "S"},
    {set_key_here, "File", "Save the pose as the key at the playhead", "K"},
    {write_files, "File", "Write the files, loop closed", "F"},
    {quit, "File", "Quit", "Ctrl+Q"},
    {undo, "Edit", "Undo", "Ctrl+Z"},
    {redo, "Edit", "Redo", "Ctrl+Y"},
    {copy, "Edit", "Copy the pose", "Ctrl+C"},
    {paste, "Edit", "Paste the pose", "Ctrl+V"},
    {mirror, "Edit", "Mirror left and right", "M"},
    {left_to_right, "Edit", "Copy her left side to her right", "<"},
    {right_to_left, "Edit", "Copy her right side to her left", ">"},
    {rest_joint, "Edit", "Joint as at rest", "Z"},
    {rest_pose, "Edit", "All joints as at rest", "0"},
    {toggle_ik, "Pose", "Inverse kinematics", "I"},
    {toggle_one_child, "Pose", "Turn one bone alone", "O"},
    {toggle_pin, "Pose", "Pin the foot to the ground", "G"},
    {twist_left, "Pose", "Twist by -5 degrees", "["},
    {twist_right, "Pose", "Twist by +5 degrees", "]"},
    {select_parent, "Pose", "Select the joint above", "Up"},
    {select_child, "Pose", "Select the joint below", "Down"},
    {previous_key, "Keys", "To the key before", "Left"},
    {next_key, "Keys", "To the key after", "Right"},
    {duplicate_key, "Keys", "Duplicate the key", "D"},
    {delete_key, "Keys", "Delete the key", "Delete"},
    {toggle_airborne, "Keys", "The key is in the air", "A"},
    {toggle_loop, "Keys", "The clip is a loop", "L"},
    {toggle_onion_skin, "View", "Onion skin: key before blue, after orange", "N"},
    {toggle_body, "View", "Body", "B"},
    {toggle_joints, "View", "Joints", "J"},
    {front_view, "View", "From the front", "1"},
    {side_view, "View", "From her left", "3"},
    {reset_camera, "View", "Camera as at the start", "R"},
    {help, "Help", "Keys and mouse", "?"},
}};

} // namespace

std::span<const CommandEntry> command_table() { return k_table; }

const CommandEntry& entry_of(EditorCommand command) {
  return *std::find_if(k_table.begin(), k_table.end(), [&](const CommandEntry& e) { return e.command == command; });
}

std::optional<EditorCommand> command_of_key(std::string_view keys) {
  for (const CommandEntry& entry : k_table)
    if (entry.keys == keys && keys.size() > 1) return entry.command;
  return std::nullopt;
}

std::optional<EditorCommand> command_of_character(char32_t character) {
  const char32_t upper = character >= 'a' && character <= 'z' ? character - 'a' + 'A' : character;
  for (const CommandEntry& entry : k_table)
    if (std::string_view(entry.keys).size() == 1 && static_cast<char32_t>(entry.keys[0]) == upper) return entry.command;
  return std::nullopt;
}

} // namespace tutu::app
