// The body in the pose in hand, as things to draw.
#pragma once

#include "src/view/pose/editor.h"
#include "src/view/render/frame_view.h"

namespace tutu::app {

class PoseView {
public:
  explicit PoseView(const rig::Character& character);

  /// Spans are good until the next call.
  FrameView frame(const Editor& editor);

private:
  const rig::Character* character_;
  std::vector<rig::SkinMatrix> palette_;
  std::vector<Vec3f> positions_, normals_;
};

} // namespace tutu::app
