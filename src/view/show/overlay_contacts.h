// Who looked for whom and who touches whom, as things to draw. All append.
#pragma once

#include "cloth/garment/garment.h"
#include "proxies/contact.h"
#include "proxies/motion/collider_set.h"
#include "src/run/frame_state.h"
#include "src/view/render/frame_view.h"

#include <span>
#include <vector>

namespace tutu::app {

/// A particle that touches a collider.
struct Touch {
  int particle = 0;
  int collider = 0; ///< or the ground's index
  proxies::Contact contact;

  /// m, >= 0: how much nearer it is than `gap`.
  double depth(double gap) const { return std::max(0.0, gap - contact.distance); }
};

/// m. A particle that was pushed to the gap's very edge touches; so does one that keeps somewhat more, since where
/// cells are wide particles keep up to 3 mm more to keep triangles out (cloth::k_most_rise).
inline constexpr double k_touch_slack = 0.003;

/// Every free particle nearer to a collider or the ground than the garment's gap (Fabric::contact_offset) and
/// k_touch_slack, at the frame's end: particles rise, and colliders for each. Computed anew, in closed form and double:
/// solvers do not keep their contacts.
void find_touches(const cloth::Garment& garment, std::span<const Vec3> positions, const proxies::SweptColliders& all,
                  std::vector<Touch>& touches);

/// One arrow a touch, from the surface out along the normal, longer by ten times the depth. Green at the gap, orange
/// nearer than the gap by more than k_pressed, vermilion inside the collider by more than k_inside_depth
/// (cloth_depths.h).
inline constexpr double k_pressed = 1e-4;     // m
inline constexpr float k_touch_arrow = 0.02f; // m
inline constexpr float k_depth_magnified = 10.0f;
void add_touches(std::span<const Touch> touches, double gap, std::vector<LineView>& lines);

/// Tiles of the broad phase that found a collider in black, those that found none in grey, and a line from the middle
/// of a tile to that of each candidate. Where particles are asked one by one (no tiles): a line from each particle.
void add_broad_phase(const BroadPhaseState& broad, std::span<const Vec3> positions, const proxies::SweptColliders& all,
                     std::vector<LineView>& lines);

} // namespace tutu::app
