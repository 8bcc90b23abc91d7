// Scenes on disk: JSON, schema in assets/schema/scene.schema.json. Paths in a scene are relative to the scene's folder.
#pragma once

#include "cloth/solver.h"
#include "proxies/collision_query.h"
#include "rig/bvh.h"
#include "rig/clip_file.h"
#include "rig/skin.h"

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
using Motion = std::variant<ClipMotion, OwnMotion, rig::ThreeTexts, MocapMotion>;

inline constexpr int k_most_threads = 256;

struct GarmentEntry {
  std::filesystem::path file;
  Vec3 scale = Vec3::Ones();  ///< per axis, about the model's origin
  Vec3 offset = Vec3::Zero(); ///< m, after the scale
  double resolution = 1.0;    ///< times the garment's own cells a side
};

/// A scene as authored.
struct SceneDescription {
  std::filesystem::path file;
  std::filesystem::path character;
  int max_influences = 4;
  rig::Skinning skinning = rig::Skinning::linear;
  Motion motion;
  std::optional<rig::Interpolation> interpolation; ///< instead of the clip's own
  std::optional<std::filesystem::path> proxies;
  std::vector<GarmentEntry> garments;
  std::optional<double> ground_height = 0.0; ///< m; none = no ground
  int frames_per_second = 60;
  cloth::SolverKind solver = cloth::SolverKind::xpbd;
  int substeps = 10;             ///< a frame,
  bool adaptive_substeps = true; ///< and more where something moves too fast for them
  int threads = 1;               ///< that step garments side by side; never more than there are garments
  proxies::Backend backend = proxies::Backend::hybrid;
  bool self_collision = false; ///< of each garment with itself; solver xpbd only
  cloth::ContactFeatures features = cloth::ContactFeatures::automatic; ///< what of the cloth meets colliders
  bool swept = true;             ///< contacts by time of impact where something moves far
  int passes = 1;                ///< over the constraints, a substep; solver xpbd only
  bool double_precision = false; ///< of the solver's kernels
  std::filesystem::path drape;   ///< where the settled garments are kept
};

/// Throws InputError with file, JSON pointer, found and expected.
SceneDescription read_scene(const std::filesystem::path& file);

} // namespace tutu::app
