// Scenes on disk: JSON, schema in assets/schema/scene.schema.json. Paths in a scene are relative to the scene's folder.
#pragma once

#include "cloth/air/wind.h"
#include "rig/import/import.h"
#include "rig/io/bvh.h"
#include "rig/io/clip_file.h"
#include "rig/skin.h"
#include "src/run/settings_table.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tutu::app {

/// A JSON clip; with `retarget_from`, one that was made for another character.
struct ClipMotion {
  std::filesystem::path clip;
  std::optional<std::filesystem::path> retarget_from;
};
/// An animation of the character's own file, by name or by number.
struct OwnMotion {
  std::variant<int, std::string> animation;
};
/// A take of motion capture, put on the character by joint names.
struct MocapMotion {
  std::filesystem::path bvh;
  rig::BvhOptions options;
  std::map<std::string, std::optional<std::string>> joints; ///< the take's name -> the character's; none: left out
};
using MotionSource = std::variant<ClipMotion, OwnMotion, rig::ThreeTexts, MocapMotion>;

struct GarmentEntry {
  std::filesystem::path file;
  Vec3 scale = Vec3::Ones();  ///< per axis, about the model's origin
  Vec3 offset = Vec3::Zero(); ///< m, after the scale
  double resolution = 1.0;    ///< times the garment's own cells a side
};

/// The files of a scene, and what is to be read of them.
struct SceneFiles {
  std::filesystem::path file; ///< the scene's own
  std::filesystem::path character;
  rig::ImportOptions import; ///< how to read it
  rig::Skinning skinning = rig::Skinning::linear;
  MotionSource motion;
  std::optional<rig::Interpolation> interpolation; ///< instead of the clip's own
  std::optional<std::filesystem::path> proxies;
  std::vector<GarmentEntry> garments;
  std::filesystem::path drape; ///< where the settled garments are kept
};

/// A scene as authored.
struct SceneDescription : SceneFiles {
  std::optional<double> ground_height = 0.0; ///< m; none = no ground
  cloth::Wind wind;
  RunSettings settings;
  std::vector<const SettingRow*> stated; ///< what the file says of them
  std::vector<SettingChange> changes;    ///< in place of that

  RunSettings changed_settings() const;
};

/// All files that a scene is read from: its own, and those that these name (of a character's file not its buffers).
/// Throws InputError as read_garment.
std::vector<std::filesystem::path> inputs_of(const SceneFiles& files);

/// Throws InputError with file, JSON pointer, found and expected.
SceneDescription read_scene(const std::filesystem::path& file);

} // namespace tutu::app
