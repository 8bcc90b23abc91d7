#include "src/view/show/overlay_cloth.h"

#include "src/view/render/error_colours.h"
#include "src/view/show/overlay_colours.h"

namespace tutu::app {

Colour strain_colour(double strain) { return error_colour(k_strain_scale, strain); }

void add_strain(const cloth::Garment& garment, std::span<const Vec3> positions, std::vector<LineView>& lines) {
  constexpr float k_thread = 1.4f, k_diagonal = 0.7f; // widths
  for (const cloth::Spring& spring : garment.springs) {
    if (spring.kind == cloth::SpringKind::bend) continue;
    const Vec3 &a = positions[spring.i], &b = positions[spring.j];
    const float width = spring.kind == cloth::SpringKind::shear ? k_diagonal : k_thread;
    lines.push_back(
        {a.cast<float>(), b.cast<float>(), strain_colour((b - a).norm() / spring.rest_length - 1.0), {width, width}});
  }
}

void add_attachments(const cloth::Garment& garment, std::span<const Vec3> positions, std::vector<PointView>& points,
                     std::vector<LineView>& lines) {
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garment);
  std::vector<std::uint8_t> sewn(positions.size(), 0);
  for (const cloth::Seam& seam : garment.seams) sewn[seam.i] = 1; // the other side lies on it
  for (std::size_t s = 0; s < static_cast<std::size_t>(garment.structural_count); ++s) {
    const cloth::Spring& edge = garment.springs[s];
    const auto along = [&](const Colour& colour) {
      lines.push_back({positions[edge.i].cast<float>(), positions[edge.j].cast<float>(), colour, {1.6f, 1.6f}});
    };
    if (pinned[edge.i] && pinned[edge.j]) along(k_orange);
    else if (sewn[edge.i] && sewn[edge.j]) along(k_purple);
  }
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (pinned[i]) points.push_back({positions[i].cast<float>(), k_orange});
    else if (sewn[i]) points.push_back({positions[i].cast<float>(), k_purple});
}

} // namespace tutu::app
