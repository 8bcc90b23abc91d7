#include "src/view/render/surface_buffers.h"

#include "src/view/render/closed_skin.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace tutu::app {
namespace {

/// `values` twice; the second time through `back`.
template <typename T, typename Back>
const std::vector<T>& doubled(std::span<const T> values, std::vector<T>& out, Back back) {
  out.resize(2 * values.size());
  std::copy(values.begin(), values.end(), out.begin());
  std::transform(values.begin(), values.end(), out.begin() + static_cast<std::ptrdiff_t>(values.size()), back);
  return out;
}

template <typename T> void upload(StreamBuffer& buffer, std::span<const T> values) {
  buffer.upload(GL_ARRAY_BUFFER, values.data(), values.size_bytes());
}

} // namespace

void SurfaceBuffers::update_topology(const SurfaceView& view) {
  const bool same = topology_vertices_ == view.positions.size() && topology_two_sided_ == view.two_sided &&
                    std::equal(topology_.begin(), topology_.end(), view.triangles.begin(), view.triangles.end());
  if (same) return;
  for (const rig::Triangle& t : view.triangles)
    if (std::max({t[0], t[1], t[2]}) >= view.positions.size())
      throw std::invalid_argument("a surface to draw has a triangle with a vertex that does not exist");
  topology_.assign(view.triangles.begin(), view.triangles.end());
  topology_vertices_ = view.positions.size();
  topology_two_sided_ = view.two_sided;
  const std::vector<rig::Triangle>& all =
      view.two_sided ? closed_skin(view.triangles, static_cast<std::uint32_t>(view.positions.size())) : topology_;
  indices_.upload(GL_ELEMENT_ARRAY_BUFFER, all.data(), all.size() * sizeof(rig::Triangle));
  index_count_ = static_cast<int>(3 * all.size());
}

void SurfaceBuffers::update(const SurfaceView& view) {
  if (view.normals.size() != view.positions.size() ||
      (!view.colours.empty() && view.colours.size() != view.positions.size()))
    throw std::invalid_argument("a surface to draw needs one normal, and one colour if any, a position");
  glBindVertexArray(array_.name()); // the element buffer belongs to it
  update_topology(view);
  colour_ = view.colour;
  offset_ = view.two_sided ? view.offset : 0.0f;
  sheen_ = view.sheen;
  wireframe_ = view.wireframe;
  has_colours_ = !view.colours.empty();
  first_back_ = view.two_sided ? static_cast<int>(view.positions.size()) : std::numeric_limits<int>::max();
  if (view.two_sided) {
    upload<Vec3f>(positions_, doubled(view.positions, doubled_positions_, [](const Vec3f& p) { return p; }));
    upload<Vec3f>(normals_, doubled(view.normals, doubled_normals_, [](const Vec3f& n) { return Vec3f(-n); }));
    upload<Colour>(colours_, doubled(view.colours, doubled_colours_, [](const Colour& c) { return c; }));
  } else {
    upload(positions_, view.positions);
    upload(normals_, view.normals);
    upload(colours_, view.colours);
  }
  float_attribute(0, positions_.name(), 3, sizeof(Vec3f), 0);
  float_attribute(1, normals_.name(), 3, sizeof(Vec3f), 0);
  if (has_colours_) float_attribute(2, colours_.name(), 3, sizeof(Colour), 0);
  else glDisableVertexAttribArray(2);
}

void SurfaceBuffers::draw() const {
  if (index_count_ == 0) return;
  glBindVertexArray(array_.name());
  if (!has_colours_) glVertexAttrib3fv(2, colour_.data());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

} // namespace tutu::app
