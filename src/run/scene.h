// The one place that binds rig, proxies and cloth: everything of a scene that does not change while it plays, in
// memory.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/body/body_mesh.h"
#include "proxies/collider.h"
#include "rig/character.h"
#include "rig/text.h"
#include "src/run/settings.h"
#include "src/run/skin_pins.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// Positions of all particles, world, m, one vector a garment.
using GarmentPositions = std::vector<std::vector<Vec3>>;

struct Scene {
  std::string file; ///< what messages call it; its stem is its name
  RunSettings settings;
  std::optional<double> ground_height = 0.0; ///< m; none = no ground
  rig::Character character;
  rig::Clip clip;
  std::vector<proxies::Proxy> proxies;
  std::vector<cloth::Garment> garments;
  std::vector<std::vector<int>> attachment_joints; ///< [garment][attachment]: joint; of one on the skin, the main one
  std::vector<SkinPins> skin_pins;                 ///< [garment]: of attachments on the skin

  /// For people, titles and files that are named after it; without control characters, whatever the file is called.
  std::string name() const { return plain_text(std::filesystem::path(file).stem().string()); }
  bool collides_with_body() const { return settings.backend == proxies::Backend::mesh; }
};

/// The scene's character as a solid, in its bind pose. Throws InputError, naming the character, where its mesh has no
/// inside.
proxies::BodyMesh body_of(const rig::Character& character);

/// Frames of once through the motion: 0 to this, which is the first pose again where it loops. Throws InputError for
/// more than k_most_frames.
int frames_of(const Scene& scene);

inline constexpr int k_most_frames = 10'000'000; // 46 hours of dance

} // namespace tutu::app
