// What there is to draw in one frame: const spans into somebody else's memory. The simulation knows no screen.
#pragma once

#include "rig/math.h"
#include "rig/mesh.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tutu::app {

using Colour = std::array<float, 3>; ///< linear RGB, 0..1

/// A triangle surface, world space. Spans must live until it is drawn.
struct SurfaceView {
  std::span<const Vec3f> positions, normals; ///< unit normals, one a position
  std::span<const rig::Triangle> triangles;
  Colour colour = {0.8f, 0.8f, 0.8f};
  std::span<const Colour> colours = {}; ///< empty, or one a position in the place of `colour` (heat maps)
  bool wireframe = false;               ///< the triangles' edges drawn on the surface
  bool two_sided = false;               ///< cloth: both sides lit, the back a little darker
  float offset = 0.0f;                  ///< m along the normal: half the cloth's thickness, drawn on both sides
  float sheen = 0.0f;                   ///< 0 matt .. 1 silky
};

struct CapsuleView {
  Vec3f a, b;
  float radius_a = 0.0f, radius_b = 0.0f;
  Colour colour = {0.9f, 0.5f, 0.1f};
};

struct LineView {
  Vec3f a, b;
  Colour colour = {1, 1, 1};
  std::array<float, 2> width = {1, 1}; ///< at a and b, times the usual
};

/// Two lines, shaft and head, from `from` to `from + way`.
inline void add_arrow(const Vec3f& from, const Vec3f& way, const Colour& colour, std::vector<LineView>& lines) {
  constexpr float k_shaft = 0.65f, k_head = 4.0f; // share of the length; width of the head where it begins
  const Vec3f neck = from + k_shaft * way;
  lines.push_back({from, neck, colour});
  lines.push_back({neck, from + way, colour, {k_head, 0.0f}});
}

struct PointView {
  Vec3f position;
  Colour colour = {1, 1, 1};
};

/// A colour and what it means.
struct LegendEntry {
  std::string text;
  Colour colour;
};

/// What the colours of an error overlay mean (error_colours.h), m; 0 < tolerance < full.
struct ErrorScale {
  double tolerance = 0.01; ///< below it, either way, nothing is coloured
  double full = 0.04;      ///< from here on the strongest colour

  /// Of this tolerance: full at four times that.
  static ErrorScale of(double tolerance) { return {tolerance, 4.0 * tolerance}; }
};

struct FrameView {
  std::vector<SurfaceView> surfaces;
  std::vector<CapsuleView> capsules; ///< drawn translucent over the surfaces
  std::vector<LineView> lines;       ///< drawn over everything
  std::vector<LineView> threads;     ///< drawn on the surfaces, and hidden by what lies before them
  std::vector<Vec3f> points;         ///< particles
  std::vector<PointView> marks;      ///< drawn over everything
  bool ground = true;                ///< a floor at `ground_height` with the shadow of all surfaces
  float ground_height = 0.0f;
  std::optional<ErrorScale> error_scale; ///< surfaces' colours are errors: a picture gets a labelled bar
  std::vector<LegendEntry> legend;       ///< of lines, points and colours: written into pictures
  std::string caption;                   ///< below the picture, "" for none
};

/// Looks from `eye` at `target`, +Y up.
struct Camera {
  Vec3f eye = {0, 1.2f, 4};
  Vec3f target = {0, 0.9f, 0};
  float vertical_fov = 0.6f; ///< rad
};

} // namespace tutu::app
