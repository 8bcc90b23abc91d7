#include "src/view/render/overlay.h"

#include "src/view/render/capsule_mesh.h"
#include "src/view/render/shaders.h"
#include "src/view/render/shadow.h"

#include <cstddef>

namespace tutu::app {
namespace {

constexpr float k_line_half_width = 0.9f; // pixels of the finished picture
constexpr float k_least_point = 3.0f;     // pixels across
constexpr float k_thread_nearer = 2e-4f;  // of clip space: 2 cm at the target, before the sheet whose middle it is
constexpr Colour k_point_colour = {0.10f, 0.16f, 0.30f};

void blend(bool on) {
  if (on) {
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  } else {
    glDisable(GL_BLEND);
  }
}

} // namespace

Overlay::Overlay()
    : capsule_program_("capsule", shaders::k_capsule_vertex, shaders::k_capsule_fragment),
      line_program_("line", shaders::k_line_vertex, shaders::k_line_fragment),
      point_program_("point", shaders::k_point_vertex, shaders::k_point_fragment) {
  const CapsuleMesh mesh = capsule_mesh(28, 7);
  glBindVertexArray(capsule_array_.name());
  capsule_vertices_.upload(GL_ARRAY_BUFFER, mesh.vertices.data(), mesh.vertices.size() * sizeof(Eigen::Vector4f));
  capsule_indices_.upload(GL_ELEMENT_ARRAY_BUFFER, mesh.triangles.data(),
                          mesh.triangles.size() * sizeof(rig::Triangle));
  capsule_index_count_ = static_cast<int>(3 * mesh.triangles.size());
  float_attribute(0, capsule_vertices_.name(), 4, sizeof(Eigen::Vector4f), 0);
  float_attribute(1, capsules_.name(), 3, sizeof(CapsuleView), offsetof(CapsuleView, a), 1);
  float_attribute(2, capsules_.name(), 3, sizeof(CapsuleView), offsetof(CapsuleView, b), 1);
  float_attribute(3, capsules_.name(), 2, sizeof(CapsuleView), offsetof(CapsuleView, radius_a), 1);
  float_attribute(4, capsules_.name(), 3, sizeof(CapsuleView), offsetof(CapsuleView, colour), 1);
  glBindVertexArray(line_array_.name());
  float_attribute(0, lines_.name(), 3, sizeof(LineView), offsetof(LineView, a), 1);
  float_attribute(1, lines_.name(), 3, sizeof(LineView), offsetof(LineView, b), 1);
  float_attribute(2, lines_.name(), 3, sizeof(LineView), offsetof(LineView, colour), 1);
  float_attribute(3, lines_.name(), 2, sizeof(LineView), offsetof(LineView, width), 1);
  glBindVertexArray(point_array_.name());
  float_attribute(0, points_.name(), 3, sizeof(PointView), 0);
  float_attribute(1, points_.name(), 3, sizeof(PointView), offsetof(PointView, colour));
}

void Overlay::draw_capsules(std::span<const CapsuleView> capsules, const PictureFit& fit) {
  if (capsules.empty()) return;
  capsules_.upload(GL_ARRAY_BUFFER, capsules.data(), capsules.size_bytes());
  use_for_picture(capsule_program_, fit);
  capsule_program_.set("key_direction", key_direction());
  glBindVertexArray(capsule_array_.name());
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  const auto draw = [&] {
    glDrawElementsInstanced(GL_TRIANGLES, capsule_index_count_, GL_UNSIGNED_INT, nullptr,
                            static_cast<GLsizei>(capsules.size()));
  };

  // 1: mark where some capsule, and so the nearest one, lies before the surfaces.
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_STENCIL_TEST);
  glStencilMask(0xff);
  glClear(GL_STENCIL_BUFFER_BIT);
  glStencilFunc(GL_ALWAYS, 1, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  draw();
  // 2: the capsules' own depth, in the near half of the range: before all that was drawn, and exact among themselves.
  glDepthMask(GL_TRUE);
  glDepthRange(0.0, 0.5);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  draw();
  // 3: the nearest surface once, in two strengths.
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_FALSE);
  blend(true);
  glStencilFunc(GL_EQUAL, 1, 0xff);
  capsule_program_.set("opacity", Eigen::Vector2f(0.62f, 0.95f));
  draw();
  glStencilFunc(GL_EQUAL, 0, 0xff);
  capsule_program_.set("opacity", Eigen::Vector2f(0.30f, 0.70f));
  draw();
  blend(false);
  glDisable(GL_STENCIL_TEST);
  glDepthRange(0.0, 1.0);
  glDepthMask(GL_TRUE);
}

void Overlay::draw_line_list(std::span<const LineView> lines, float nearer, const PictureFit& fit) {
  if (lines.empty()) return;
  lines_.upload(GL_ARRAY_BUFFER, lines.data(), lines.size_bytes());
  use_for_picture(line_program_, fit);
  line_program_.set("half_width", k_line_half_width * fit.pixel_scale);
  line_program_.set("nearer", nearer);
  glBindVertexArray(line_array_.name());
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  blend(true);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(lines.size()));
  blend(false);
  glDepthMask(GL_TRUE);
}

void Overlay::draw_lines(std::span<const LineView> lines, const PictureFit& fit) {
  glDisable(GL_DEPTH_TEST);
  draw_line_list(lines, 0.0f, fit);
  glEnable(GL_DEPTH_TEST);
}

void Overlay::draw_threads(std::span<const LineView> threads, const PictureFit& fit) {
  glDepthFunc(GL_LEQUAL);
  draw_line_list(threads, k_thread_nearer, fit);
}

void Overlay::draw_points(std::span<const Vec3f> points, float radius, float pixels_per_metre, const PictureFit& fit) {
  coloured_.clear();
  for (const Vec3f& point : points) coloured_.push_back({point, k_point_colour});
  glDepthFunc(GL_LEQUAL);
  draw_point_list(coloured_, radius, pixels_per_metre, fit);
}

void Overlay::draw_marks(std::span<const PointView> marks, float radius, float pixels_per_metre,
                         const PictureFit& fit) {
  glDisable(GL_DEPTH_TEST);
  draw_point_list(marks, radius, pixels_per_metre, fit);
  glEnable(GL_DEPTH_TEST);
}

void Overlay::draw_point_list(std::span<const PointView> points, float radius, float pixels_per_metre,
                              const PictureFit& fit) {
  if (points.empty()) return;
  points_.upload(GL_ARRAY_BUFFER, points.data(), points.size_bytes());
  use_for_picture(point_program_, fit);
  point_program_.set("radius", radius);
  point_program_.set("pixels_per_unit", pixels_per_metre);
  point_program_.set("least", k_least_point * fit.pixel_scale);
  glBindVertexArray(point_array_.name());
  glEnable(GL_PROGRAM_POINT_SIZE);
  glDepthMask(GL_FALSE);
  blend(true);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(points.size()));
  blend(false);
  glDepthMask(GL_TRUE);
}

} // namespace tutu::app
