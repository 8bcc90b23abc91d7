// What lies over the surfaces: translucent capsules, lines and points.
#pragma once

#include "src/view/render/gl_objects.h"
#include "src/view/render/picture_fit.h"

#include <span>
#include <vector>

namespace tutu::app {

/// All draw into the bound framebuffer and leave depth test on, blending off.
class Overlay {
public:
  Overlay();

  /// Each pixel shows the nearest capsule only. Where it lies before the surfaces it is stronger than where it is
  /// inside or behind. Writes depth and stencil.
  void draw_capsules(std::span<const CapsuleView> capsules, const PictureFit& fit);
  void draw_lines(std::span<const LineView> lines, const PictureFit& fit); ///< over everything
  /// Hidden by surfaces before them.
  void draw_threads(std::span<const LineView> threads, const PictureFit& fit);
  /// Round, `radius` in m; hidden by surfaces before them. `pixels_per_metre` is at distance 1 m.
  void draw_points(std::span<const Vec3f> points, float radius, float pixels_per_metre, const PictureFit& fit);
  /// Like them, over everything.
  void draw_marks(std::span<const PointView> marks, float radius, float pixels_per_metre, const PictureFit& fit);

private:
  void draw_line_list(std::span<const LineView> lines, float nearer, const PictureFit& fit);
  void draw_point_list(std::span<const PointView> points, float radius, float pixels_per_metre, const PictureFit& fit);

  Program capsule_program_, line_program_, point_program_;
  VertexArray capsule_array_, line_array_, point_array_;
  StreamBuffer capsule_vertices_, capsule_indices_, capsules_, lines_, points_;
  std::vector<PointView> coloured_;
  int capsule_index_count_ = 0;
};

} // namespace tutu::app
