#include "src/view/show/heat_maps.h"

#include "src/run/posed_body.h"
#include "src/view/render/camera.h"
#include "src/view/render/offscreen.h"
#include "src/view/render/png.h"
#include "src/view/show/proxy_error_colours.h"

#include <algorithm>
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
  std::vector<Vec3f> turned, turned_normals, shown;
  for (const int frame : frames) {
    body.pose_at(frame / static_cast<double>(scene.settings.frames_per_second));
    FrameView view;
    SurfaceView skin;
    skin.positions = body.positions();
    skin.normals = body.normals();
    skin.triangles = scene.character.mesh.triangles;
    skin.colours = colours.update(body.positions(), body.colliders(), scale);
    view.surfaces.push_back(skin);
    view.ground = scene.ground_height.has_value();
    view.ground_height = static_cast<float>(scene.ground_height.value_or(0.0));
    view.error_scale = scale;
    // Below the feet there is room for the bar.
    constexpr float k_bar = 0.14f; // of the body's extent upwards
    const auto picture = [&] {
      constexpr float k_yaw = 0.0f, k_pitch = 0.08f; // rad: from the front, a little of the floor
      shown.assign(skin.positions.begin(), skin.positions.end());
      const auto lower = [](const Vec3f& p, const Vec3f& q) { return p.y() < q.y(); };
      const auto [lowest, highest] = std::minmax_element(shown.begin(), shown.end(), lower);
      shown.push_back(*lowest - k_bar * (highest->y() - lowest->y()) * Vec3f::UnitY());
      return png_bytes(offscreen->draw(view, frame_camera(shown, k_yaw, k_pitch, offscreen->aspect())));
    };
    HeatMap map{frame, picture(), {}};
    // The body turns, not the camera: the studio's light comes from the front, and white shall look white.
    turned.assign(body.positions().begin(), body.positions().end());
    turned_normals.assign(body.normals().begin(), body.normals().end());
    for (auto* points : {&turned, &turned_normals})
      for (Vec3f& p : *points) p = Vec3f(-p.x(), p.y(), -p.z());
    view.surfaces[0].positions = skin.positions = turned;
    view.surfaces[0].normals = turned_normals;
    map.back = picture();
    maps.push_back(std::move(map));
    if (!go_on()) break;
  }
  return maps;
}

} // namespace tutu::app
