#include "src/view/pose/pose_view.h"

namespace tutu::app {

PoseView::PoseView(const rig::Character& character)
    : character_(&character), palette_(character.skin.slot_count()), positions_(character.mesh.positions.size()),
      normals_(positions_.size()) {}

FrameView PoseView::frame(const Editor& editor) {
  FrameView view;
  view.ground_height = editor.ground_height();
  if (!editor.view().body) return view;
  rig::skinning_palette(character_->skin, editor.model_from_joint(), palette_);
  rig::skin_vertices(character_->mesh, character_->skin, palette_, positions_, normals_);
  for (const rig::MeshPart& part : character_->mesh.parts) {
    SurfaceView surface;
    surface.positions = positions_;
    surface.normals = normals_;
    surface.triangles = std::span(character_->mesh.triangles).subspan(part.first_triangle, part.triangle_count);
    surface.colour = part.colour;
    view.surfaces.push_back(surface);
  }
  return view;
}

} // namespace tutu::app
