// tutu pose: the pose editor.
#include "rig/character.h"
#include "rig/error.h"
#include "rig/import/import.h"
#include "rig/io/clip_file.h"
#include "rig/io/file_io.h"
#include "src/base/json_text.h"
#include "src/base/outputs.h"
#include "src/commands/commands.h"
#include "src/options/import_options.h"
#include "src/options/scene_options.h"
#include "src/view/pose/joint_limits_file.h"
#include "src/view/pose/pose_files.h"
#include "src/view/pose/pose_window.h"
#include "src/view/render/png.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  rig::ImportOptions import;
  std::string character, motion, out, limits, json, screenshot, joint;
  double time = 0.0;
  int width = 1280, height = 800;
};

/// All that the editor writes. The motion may be the clip itself: then it is edited in place.
void check_files(const Options& options, const fs::path& clip) {
  std::vector<Output> outputs = {{"--out", clip}, {"--json", options.json}, {"--screenshot", options.screenshot}};
  for (const fs::path& text : three_text_paths(clip)) outputs.push_back({"the clip's three texts", text});
  std::vector<fs::path> inputs = {options.character};
  std::error_code none;
  if (!options.motion.empty() && !fs::equivalent(options.motion, clip, none)) inputs.emplace_back(options.motion);
  if (!options.limits.empty()) inputs.emplace_back(options.limits);
  check_outputs(outputs, inputs);
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
  check_files(options, file);
  const rig::Character character = rig::import_character(options.character, options.import).character;
  const rig::Skeleton& skeleton = character.skeleton;
  const fs::path begin = options.motion.empty() ? file : fs::path(options.motion); // work goes on where it was left
  std::vector<std::string> notes;
  EditState start = !options.motion.empty() || fs::exists(begin) ? edit_state(rig::read_clip(begin, &notes), skeleton)
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
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
  if (!editor.message().empty()) fmt::print(stderr, "note: {}\n", editor.message());
  if (editor.question() == EditorQuestion::take_up_autosave)
    fmt::print("found unsaved work of an earlier session: {}\n", editor.autosave().file().string());
  if (!options.screenshot.empty()) {
    write_png(options.screenshot, draw_pose_window(editor, options.width, options.height));
    fmt::print("wrote {}\n", options.screenshot);
  } else {
    run_pose_window(editor, {options.width, options.height, options.json});
  }
  if (!options.json.empty()) write_file(options.json, json_text(editor.json()));
  return k_ok;
}

} // namespace

void add_pose(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("pose", "Pose a character with mouse and keyboard, and save key poses");
  auto options = std::make_shared<Options>();
  command->add_option("CHARACTER", options->character, "Rigged character: .dae .gltf .glb .vrm .fbx .x")->required();
  add_import_options(*command, options->import, "--body-height");
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
