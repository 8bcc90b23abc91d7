// One surface of a frame on the graphics card.
#pragma once

#include "src/view/render/gl_objects.h"

#include <vector>

namespace tutu::app {

/// Keeps its index buffer while the triangles stay the same; positions, normals and colours go up each frame.
/// A two-sided sheet becomes a closed skin: front, back with turned normals and triangles, and a rim along the hem.
class SurfaceBuffers {
public:
  /// Throws std::invalid_argument when spans disagree in length or a triangle names a vertex that is not there.
  void update(const SurfaceView& view);

  /// Draws the triangles with the program in use; its vertex shader takes position, normal, colour at locations 0,
  /// 1, 2.
  void draw() const;

  float offset() const { return offset_; }
  float sheen() const { return sheen_; }
  bool wireframe() const { return wireframe_; }
  int first_back() const { return first_back_; } ///< vertices from here on are the back; past the end when one-sided

private:
  void update_topology(const SurfaceView& view);

  VertexArray array_;
  StreamBuffer positions_, normals_, colours_, indices_;
  std::vector<rig::Triangle> topology_; ///< what indices_ was made of
  std::size_t topology_vertices_ = 0;
  bool topology_two_sided_ = false, has_colours_ = false, wireframe_ = false;
  int index_count_ = 0, first_back_ = 0;
  Colour colour_{};
  float offset_ = 0, sheen_ = 0;
  std::vector<Vec3f> doubled_positions_, doubled_normals_;
  std::vector<Colour> doubled_colours_;
};

} // namespace tutu::app
