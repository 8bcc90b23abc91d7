// What a session looks like: its state as things to draw.
#pragma once

#include "src/render/camera.h"
#include "src/render/smooth_grid.h"
#include "src/scene/session.h"
#include "src/viewer/player.h"

namespace tutu::app {

/// Owns what drawing needs beside the session. Reads the session, never changes it.
class SceneView {
public:
  explicit SceneView(const Scene& scene);

  /// The session's present frame. With layers.body the body must have been skinned. The spans are good until the next
  /// call, and as long as the session stays as it is.
  FrameView frame(const Session& session, const Layers& layers);

private:
  std::vector<SmoothGrid> cloth_; ///< what is drawn is finer than what is simulated, and goes through every particle
  std::vector<Vec3f> particles_;
};

/// Points (m) around all places the scene's joints go to over the whole clip, with room for flesh and cloth: what a
/// camera must show.
std::vector<Vec3f> motion_points(const Scene& scene);

} // namespace tutu::app
