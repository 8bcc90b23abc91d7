// What the pose editor left at its last end: found, edited, saved and found again. No OpenGL.
#include "rig/error.h"
#include "src/view/pose/pose_files.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {

void fuzz_autosave(std::string_view input) {
  const rig::Skeleton& skeleton = small_character().skeleton;
  const app::Autosave autosave(scratch() / "clip.json");
  write_input(input, "clip.autosave.json");
  std::string trouble;
  std::optional<app::EditState> state = autosave.found(skeleton, trouble);
  require(state.has_value() == trouble.empty(), "a file that is there is found, or put aside with its reason");
  if (!state) {
    for (const auto& entry : std::filesystem::directory_iterator(scratch()))
      if (entry.path().filename().string().find(".damaged-") != std::string::npos)
        std::filesystem::remove(entry.path());
    throw tutu::InputError("", "", trouble, "an autosave"); // as the other readers do
  }
  require_poses(state->pose, "the pose in hand is finite");

  const auto save_and_find = [&] {
    app::EditDocument document(app::edit_state_at_rest(skeleton, ""));
    document.change(*state);
    autosave.update(document, skeleton);
    const std::optional<app::EditState> found = autosave.found(skeleton, trouble);
    // A key that somebody called as the pose in hand is called comes back as that.
    if (!state->loose && state->keys.back().name == "unsaved pose") return;
    require(found && app::same_clip(*found, *state), "the keys that were saved are found");
    require(!state->loose || app::same_pose(found->pose, state->pose), "the pose in hand that was saved is found");
  };
  if (state->keys.size() > 100) return;
  save_and_find();
  app::seek(*state, skeleton, state->time + 0.1);
  require_poses(state->pose, "a pose between keys is finite");
  app::add_next_key(*state, 0.5);
  app::close_loop(*state, 0.5);
  (void)app::duplicate_key(*state, 0, 0.5);
  app::retime_from(*state, 0, 0.25);
  save_and_find();
}

} // namespace tutu::fuzz
