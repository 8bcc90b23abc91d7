// A character and what it wears: everything of a scene but its motion, in memory.
#pragma once

#include "cloth/air/wind.h"
#include "cloth/garment/garment.h"
#include "proxies/body/body_mesh.h"
#include "proxies/collider.h"
#include "rig/character.h"
#include "src/run/settings.h"
#include "src/run/skin_pins.h"

#include <optional>
#include <vector>

namespace tutu::app {

/// Positions of all particles, world, m, one vector a garment.
using GarmentPositions = std::vector<std::vector<Vec3>>;

struct Wearer {
  RunSettings settings;
  std::optional<double> ground_height = 0.0; ///< m; none = no ground
  cloth::Wind wind; ///< what blows on garments with Fabric::air, unless Runtime::set_wind() says otherwise
  rig::Character character;
  std::vector<proxies::Proxy> proxies;
  std::vector<cloth::Garment> garments;
  std::vector<std::vector<int>> attachment_joints; ///< [garment][attachment]: joint; of one on the skin, the main one
  std::vector<SkinPins> skin_pins;                 ///< [garment]: of attachments on the skin

  /// Wears one garment more. Throws InputError as build_garment, and where an attachment names a joint that the
  /// character has not.
  void put_on(const cloth::GarmentDescription& garment);

  bool has_air() const; ///< any garment
  bool collides_with_body() const { return settings.backend == proxies::Backend::mesh; }
};

/// The character as a solid, in its bind pose. Throws InputError, naming the character, where its mesh has no inside.
proxies::BodyMesh body_of(const rig::Character& character);

} // namespace tutu::app
