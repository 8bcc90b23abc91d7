// Constraints, attachments and seams as things to draw. All append; positions: of all particles, world, m.
#pragma once

#include "cloth/garment/garment.h"
#include "src/view/render/frame_view.h"

#include <span>
#include <vector>

namespace tutu::app {

/// What strain (length / rest length - 1) looks like: white within 1 %, to orange and dark red where longer, to blue
/// where shorter, the strongest at 10 %.
inline constexpr ErrorScale k_strain_scale = {0.01, 0.10};
Colour strain_colour(double strain);

/// One line a structural or shear spring.
void add_strain(const cloth::Garment& garment, std::span<const Vec3> positions, std::vector<LineView>& lines);

/// A point each pinned and each sewn particle (two of a seam share a place: one point), a line along each edge between
/// two pinned, and between two sewn ones.
void add_attachments(const cloth::Garment& garment, std::span<const Vec3> positions, std::vector<PointView>& points,
                     std::vector<LineView>& lines);

} // namespace tutu::app
