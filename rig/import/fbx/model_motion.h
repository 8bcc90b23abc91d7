// Private to the importer: the local transform of an FBX model over time.
#pragma once

#include "rig/import/curves/sampling.h"
#include "rig/import/detail/file_scene.h"
#include "rig/import/fbx/document.h"

#include <array>
#include <cstdint>

namespace tutu::rig::import_detail {

/// Three numbers of a model, each constant or a curve.
struct FbxTrack {
  Vec3 constant = Vec3::Zero();
  std::array<ScalarCurve, 3> curves; ///< without keys: constant

  bool moves() const { return !curves[0].empty() || !curves[1].empty() || !curves[2].empty(); }
  Vec3 at(double time, Side side) const;
};

/// parent_from_model = T Roff Rp Rpre R Rpost^-1 Rp^-1 Soff Sp S Sp^-1 [FBX SDK, Computing transformation matrices].
struct FbxModel {
  FbxTrack translation, rotation, scale;                     ///< rotation: degrees about X, Y and Z, in the order below
  std::array<int, 3> order = {0, 1, 2};                      ///< the axes, first turned about first
  Quat before = Quat::Identity(), behind = Quat::Identity(); ///< Rpre and Rpost^-1
  Vec3 rotation_offset = Vec3::Zero(), rotation_pivot = Vec3::Zero();
  Vec3 scaling_offset = Vec3::Zero(), scaling_pivot = Vec3::Zero();

  bool moves() const { return translation.moves() || rotation.moves() || scale.moves(); }
  Pose at(double time, Side side) const;
  Quat rotation_at(double time, Side side) const; ///< of it
};

/// As the model stands. Throws FbxUnreadable on numbers that are none.
FbxModel model_of(const FbxDocument& document, const FbxObject& model);

/// Of a model in a take, whose numbers may be others than those it stands with in the file; what stays as it stands is
/// left without keys. `node` is left to the caller. Throws std::length_error as sampled() does.
NodeMotion motion_of(const FbxModel& model, const FbxModel& standing);

} // namespace tutu::rig::import_detail
