// tutu pose: the pose editor.
#include "rig/character.h"
#include "rig/error.h"
#include "rig/import/import.h"
#include "rig/io/clip_file.h"
#include "rig/io/file_io.h"
#include "src/commands/commands.h"
#include "src/options/scene_options.h"
#include "src/view/pose/joint_limits_file.h"
#include "src/view/pose/pose_window.h"
#include "src/view/render/png.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string character, motion, out, limits, json, screenshot, joint;
  double time = 0.0;
  int width = 1280, height = 800;
};

/// A place that cannot be written to is told before any work is done.
void check_writable(const fs::path& file) {
  (void)PendingFile(file);
  const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
  if (::access(folder.c_str(), W_OK) != 0)
    throw InputError(file.string(), "", "a folder that cannot be written to", "one that can");
}

/// Where the work goes: --out, else back to the motion, else a new file named after the character.
fs::path clip_file(const Options& options) {
  const fs::path file = !options.out.empty()      ? fs::path(options.out)
                        : !options.motion.empty() ? fs::path(options.motion)
                                                  : fs::path(options.character).stem().concat("-poses.json");
  if (file.extension() != ".json")
    throw InputError("", options.out.empty() ? "--motion" : "--out", file.string(), "a name that ends in .json");
  return file;
}

int run(const Options& options) {
  const fs::path file = clip_file(options);
  check_writable(file);
  if (!options.json.empty()) check_writable(options.json);
  if (!options.screenshot.empty()) check_writable(options.screenshot);
  const rig::Character character = rig::import_character(options.character).character;
  const rig::Skeleton& skeleton = character.skeleton;
  const fs::path begin = options.motion.empty() ? file : fs::path(options.motion); // work goes on where it was left
  EditState start = !options.motion.empty() || fs::exists(begin) ? edit_state(rig::read_clip(begin), skeleton)
                                                                 : edit_state_at_rest(skeleton, file.stem().string());
  seek(start, skeleton, options.time);
  std::vector<rig::JointLimit> limits;
  if (!options.limits.empty()) limits = read_joint_limits(options.limits, skeleton);
  std::optional<int> joint;
  if (!options.joint.empty()) {
    joint = skeleton.find(options.joint);
    if (!joint) throw InputError("", "--joint", options.joint, "a joint of the character");
  }

  Editor editor(character, std::move(start), file, std::move(limits));
  if (joint) editor.select(*joint);
  if (editor.question() == EditorQuestion::take_up_autosave)
    fmt::print("found unsaved work of an earlier session: {}\n", editor.autosave().file().string());
  if (!options.screenshot.empty()) {
    write_png(options.screenshot, draw_pose_window(editor, options.width, options.height));
    fmt::print("wrote {}\n", options.screenshot);
  } else {
    run_pose_window(editor, {options.width, options.height, options.json});
  }
  if (!options.json.empty()) write_file(options.json, editor.json().dump(2) + "\n");
  return k_ok;
}

} // namespace

void add_pose(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("pose", "Pose a character with mouse and keyboard, and save key poses");
  auto options = std::make_shared<Options>();
  command->add_option("CHARACTER", options->character, "Rigged character: .dae .gltf .glb .fbx .x")->required();
  command->add_option("--motion", options->motion,
                      "Clip (.json) to begin with; else what --out holds, else the rest pose");
  command->add_option("-o,--out", options->out,
                      "Clip (.json) to write, its three texts beside it; else the motion, else CHARACTER-poses.json");
  command->add_option("--limits", options->limits, "How far joints may turn (.json)");
  command->add_option("--json", options->json, "Keep the editor's state in this file, for machines");
  command->add_option("--time", options->time, "Begin at this time of the motion, s")
      ->check(finite_number())
      ->capture_default_str();
  command->add_option("--joint", options->joint, "Begin with this joint selected");
  command->add_option("--screenshot", options->screenshot,
                      "No window: what it would show at the start, as a picture (.png)");
  command->add_option("--width", options->width, "Of the window or picture, pixels")
      ->check(CLI::Range(320, 4096))
      ->capture_default_str();
  command->add_option("--height", options->height, "Of the window or picture, pixels")
      ->check(CLI::Range(240, 4096))
      ->capture_default_str();
  command->callback([options, &status] { status = run(*options); });
}

} // namespace tutu::app
