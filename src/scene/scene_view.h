// What a session looks like: its state as things to draw.
#pragma once

#include "src/render/camera.h"
#include "src/render/smooth_grid.h"
#include "src/scene/proxy_error.h"
#include "src/scene/session.h"
#include "src/viewer/player.h"

#include <optional>

namespace tutu::app {

/// Owns what drawing needs beside the session. Reads the session, never changes it.
class SceneView {
public:
  explicit SceneView(const Scene& scene);

  /// What layers.proxy_error shows; at first 10 mm and more.
  void set_error_scale(const ErrorScale& scale) { error_scale_ = scale; }

  /// The session's present frame. With layers.body the body must have been skinned. The spans are good until the next
  /// call, and as long as the session stays as it is.
  FrameView frame(const Session& session, const Layers& layers);

private:
  /// A garment as it is drawn. What is woven in rows and columns is drawn finer than it is simulated, through every
  /// particle; of any other the triangles themselves.
  struct Sheet {
    std::optional<SmoothGrid> grid;
    std::vector<Vec3f> particles, normals; ///< normals: without a grid only
  };

  std::vector<Sheet> cloth_;
  ProxyErrorColours error_colours_;
  ErrorScale error_scale_;
};

/// Points (m) around all places the scene's joints go to over the whole clip, with room for flesh and cloth: what a
/// camera must show.
std::vector<Vec3f> motion_points(const Scene& scene);

} // namespace tutu::app
