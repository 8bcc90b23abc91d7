#include "src/report/heat_maps.h"

#include "src/export/png.h"
#include "src/render/camera.h"
#include "src/render/offscreen.h"
#include "src/scene/posed_body.h"
#include "src/scene/proxy_error.h"

#include <numbers>
#include <optional>

namespace tutu::app {

std::vector<HeatMap> heat_maps(const Scene& scene, const std::vector<int>& frames, const ErrorScale& scale,
                               const std::function<bool()>& go_on, std::string& why) {
  constexpr int k_width = 480, k_height = 640, k_supersample = 2;
  std::optional<Offscreen> offscreen;
  try {
    offscreen.emplace(OffscreenOptions{k_width, k_height, k_supersample});
  } catch (const std::runtime_error& error) { // a report without pictures is still a report
    why = error.what();
    return {};
  }
  std::vector<HeatMap> maps;
  PosedBody body(scene);
  ProxyErrorColours colours;
  for (const int frame : frames) {
    body.pose_at(frame / static_cast<double>(scene.description.frames_per_second));
    FrameView view;
    SurfaceView skin;
    skin.positions = body.positions();
    skin.normals = body.normals();
    skin.triangles = scene.character.mesh.triangles;
    skin.colours = colours.update(body.positions(), body.colliders(), scale);
    view.surfaces.push_back(skin);
    view.ground = scene.description.ground_height.has_value();
    view.ground_height = static_cast<float>(scene.description.ground_height.value_or(0.0));
    view.error_scale = scale;
    const auto from = [&](double yaw) {
      constexpr float k_pitch = 0.08f; // rad: a little of the floor
      return png_bytes(
          offscreen->draw(view, frame_camera(body.positions(), static_cast<float>(yaw), k_pitch, offscreen->aspect())));
    };
    maps.push_back({frame, from(0.0), from(std::numbers::pi)});
    if (!go_on()) break;
  }
  return maps;
}

} // namespace tutu::app
