// What a frame looks like: its state as things to draw.
#pragma once

#include "proxies/body/body_mesh.h"
#include "src/run/frame_state.h"
#include "src/view/render/camera.h"
#include "src/view/render/smooth_grid.h"
#include "src/view/show/layers.h"
#include "src/view/show/overlay_contacts.h"
#include "src/view/show/proxy_error_colours.h"

#include <optional>

namespace tutu::app {

/// The skinned body, world: one normal a position.
struct SkinView {
  std::span<const Vec3f> positions, normals;
};

/// Owns what drawing needs beside the state. Reads the state, never changes it.
class SceneView {
public:
  explicit SceneView(const Scene& scene);

  /// What layers.proxy_error shows; at first 10 mm and more.
  void set_error_scale(const ErrorScale& scale) { error_scale_ = scale; }

  /// With `other` cloth is in the colours of how far each particle is from where the other state has it, where both
  /// have as many. `skin`: of that frame; asked for with the layers body, proxy_error and penetration only. The spans
  /// are good until the next call, and as long as `skin` is.
  FrameView frame(const FrameState& state, const SkinView& skin, const Layers& layers,
                  const FrameState* other = nullptr);

  /// The session's present frame; with those layers its body must have been skinned.
  FrameView frame(const Session& session, const Layers& layers, const FrameState* other = nullptr);

private:
  /// A garment as it is drawn. What is woven in rows and columns is drawn finer than it is simulated, through every
  /// particle; of any other the triangles themselves.
  struct Sheet {
    std::optional<SmoothGrid> grid, colour_grid;
    std::vector<Vec3f> particles, normals; ///< normals: without a grid only
    std::vector<Vec3f> values;             ///< colours of the particles, where they have their own
    std::vector<Colour> colours;           ///< of what is drawn
  };

  void add_sheet(std::size_t g, const FrameState& state, const Layers& layers, FrameView& view);
  void colour_by_distance(const FrameState& state, const FrameState& other);
  void colour_by_depth(const FrameState& state, const SkinView& skin);

  const Scene* scene_;
  std::vector<Sheet> cloth_;
  ProxyErrorColours error_colours_;
  ErrorScale error_scale_;
  std::optional<proxies::BodyMesh> body_; ///< once depths in it were asked for
  std::string sideless_;                  ///< why there are none, in words
  std::vector<Touch> touches_;
  FrameState captured_;
};

/// Depths in the true body: from light orange at the tolerance to dark red.
inline constexpr ErrorScale k_depth_scale = {0.0005, 0.01};

/// Distances between two states: the same colours, from here to here.
inline constexpr ErrorScale k_apart_scale = {0.001, 0.05};

/// What the colours of these layers mean.
std::vector<LegendEntry> legend_of(const Layers& layers);

/// Points (m) around all places the scene's joints go to over the whole clip, with room for flesh and cloth: what a
/// camera must show.
std::vector<Vec3f> motion_points(const Scene& scene);

} // namespace tutu::app
