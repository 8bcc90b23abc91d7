// What a session looks like: its state as things to draw.
#pragma once

#include "src/render/camera.h"
#include "src/scene/cloth_surface.h"
#include "src/scene/session.h"
#include "src/viewer/player.h"

namespace tutu::app {

/// Owns what drawing needs beside the session. Reads the session, never changes it.
class SceneView {
public:
  explicit SceneView(const Scene& scene);

  /// The session's present frame. With layers.body the body must have been skinned. The spans are good until the next call, and
  /// as long as the session stays as it is.
  FrameView frame(const Session& session, const Layers& layers);

private:
  std::vector<ClothSurface> cloth_;
};

/// The box (lo, hi; m) that the scene's joints sweep over the whole clip, with room for limbs and skirts around them.
std::pair<Vec3f, Vec3f> motion_bounds(const Scene& scene);

} // namespace tutu::app
