// Proxy editing in the window of `tutu play`.
#pragma once

#include "src/scene/load.h"
#include "src/view/play/scene_player.h"
#include "src/view/play/window_mode.h"
#include "src/view/proxy_edit/proxy_editor.h"
#include "src/view/show/proxy_error_colours.h"

namespace tutu::app {

/// Edits the proxies of the scene that is played, at the pose that is shown. When the mode is left, or when asked, the
/// scene gets them and is played from a start draped anew.
class ProxyEditMode : public WindowMode {
public:
  /// Garments settled on the scene as it is; none when they do not settle.
  using Start = GarmentPositions; ///< [garment] positions
  using Drape = std::function<std::optional<Start>(const LoadedScene&)>;

  /// `scene`: the player's, and `start` what it plays from. Both must outlive it.
  ProxyEditMode(LoadedScene& scene, ScenePlayer& player, Start start, Drape drape);

  void set_error_scale(const ErrorScale& scale) { scale_ = scale; }
  const ProxyEditor& editor() const { return editor_; }
  const Start& start() const { return start_; } ///< of the scene as it is played

  bool on() const override { return on_; }
  void toggle() override;
  Layers layers(Layers chosen) const override;
  void show(std::vector<FrameView>& views) override;
  void set_picture(const Camera& camera, int width, int height, float pixel_scale) override;
  void take(const InputEvent& event, bool panels_have, OrbitCamera& orbit) override;
  void draw_panels(float top, bool panels) override;
  bool may_close() override;
  bool asks() const override { return editor_.question() != ProxyQuestion::none; }
  bool is_closing() const override { return editor_.leaving(); }

private:
  void draw_panel(float top);
  void follow_pose();
  void restart();
  void turn_camera(const InputEvent& event, OrbitCamera& orbit);
  void take_key(const std::string& keys);

  LoadedScene* scene_;
  ScenePlayer* player_;
  Start start_;
  Drape drape_;
  ProxyEditor editor_;
  std::vector<proxies::Proxy> played_; ///< what the scene has
  ErrorScale scale_;
  bool on_ = false;
  bool cloth_ = false, heat_ = true;
  bool others_ = false; ///< all proxies are seen while one is selected
  int frame_ = -1;      ///< whose pose the editor has
  ProxyErrorColours colours_;
  float pixel_scale_ = 1.0f;
  // The pointer.
  bool holds_ = false; ///< a handle
  std::optional<PointerButton> camera_button_;
  double x_ = 0.0, y_ = 0.0, from_x_ = 0.0, from_y_ = 0.0;
  std::string note_;          ///< of a restart
  char name_[512] = {};       ///< in the box of "save as"
  bool name_offered_ = false; ///< the box holds the file's name
};

} // namespace tutu::app
