// The camera that the window of `tutu play` begins with.
#pragma once

#include "src/run/drape.h"
#include "src/view/show/scene_view.h"
#include "src/view/window/orbit.h"

namespace tutu::test {

/// Everything in view at frame 0, the garments as the program drapes them. `aspect`: the picture's width over its
/// height.
inline app::Camera first_camera(const app::Scene& scene, float aspect) {
  app::Session session(scene);
  session.start(app::drape(scene, 4.0, [](int, int) { return true; }).positions);
  session.skin_body();
  app::SceneView view(scene);
  const app::FrameView first = view.frame(session, {});
  Vec3f lo = Vec3f::Constant(1e30f), hi = -lo;
  for (const app::SurfaceView& surface : first.surfaces)
    for (const Vec3f& p : surface.positions) {
      lo = lo.cwiseMin(p);
      hi = hi.cwiseMax(p);
    }
  lo.y() = std::min(lo.y(), first.ground_height);
  return app::frame_orbit(lo, hi, 0.35f, 0.08f, aspect).camera();
}

} // namespace tutu::test
