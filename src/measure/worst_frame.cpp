#include "src/measure/worst_frame.h"

#include "cloth/metrics.h"
#include "proxies/distance/capsule_union.h"
#include "src/run/posed_body.h"

#include <algorithm>

namespace tutu::app {

std::optional<int> worst_frame(const Scene& scene, const std::function<bool(int, int)>& progress) {
  PosedBody body(scene);
  if (body.colliders().empty()) return std::nullopt;
  proxies::CapsuleUnion solid;
  std::vector<double> out(body.positions().size());
  double most = -1.0;
  int worst = 0;
  for (int frame = 0, total = frames_of(scene); frame < total; ++frame) {
    body.pose_at(frame / static_cast<double>(scene.settings.frames_per_second));
    solid.assign(body.colliders());
    for (std::size_t v = 0; v < out.size(); ++v)
      out[v] = std::max(0.0, solid.distance(body.positions()[v].cast<double>()));
    if (const double p95 = cloth::percentile(out, 0.95); p95 > most) {
      most = p95;
      worst = frame;
    }
    if (!progress(frame + 1, total)) return std::nullopt;
  }
  return worst;
}

} // namespace tutu::app
