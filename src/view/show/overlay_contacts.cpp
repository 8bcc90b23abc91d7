#include "src/view/show/overlay_contacts.h"

#include "proxies/distance/signed_distance.h"
#include "src/measure/cloth_depths.h"
#include "src/view/show/overlay_body.h"
#include "src/view/show/overlay_colours.h"

namespace tutu::app {

void find_touches(const cloth::Garment& garment, std::span<const Vec3> positions, const proxies::SweptColliders& all,
                  std::vector<Touch>& touches) {
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garment);
  const double reach = garment.fabric.contact_offset() + k_touch_slack;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (pinned[i]) continue;
    const auto note = [&](int collider, const proxies::Contact& contact) {
      if (contact.distance < reach) touches.push_back({static_cast<int>(i), collider, contact});
    };
    for (int c = 0; c < all.size(); ++c)
      if (all.meets(c)) note(c, proxies::signed_distance(positions[i], all.end[c]));
    if (all.ground) note(all.ground_index(), proxies::signed_distance(positions[i], *all.ground));
  }
}

void add_touches(std::span<const Touch> touches, double gap, std::vector<LineView>& lines) {
  for (const Touch& touch : touches) {
    const double depth = touch.depth(gap);
    const Colour& colour = touch.contact.distance < -k_inside_depth ? k_vermilion
                           : depth > k_pressed                      ? k_orange
                                                                    : k_green;
    const float length = k_touch_arrow + k_depth_magnified * static_cast<float>(depth);
    add_arrow(touch.contact.closest.cast<float>(), length * touch.contact.normal.cast<float>(), colour, lines);
  }
}

void add_broad_phase(const BroadPhaseState& broad, std::span<const Vec3> positions, const proxies::SweptColliders& all,
                     std::vector<LineView>& lines) {
  constexpr float k_box = 0.8f, k_candidate = 0.5f; // widths
  for (std::size_t t = 0; t + 1 < broad.begin.size(); ++t) {
    const bool tiles = !broad.boxes.empty();
    const Vec3 from = tiles ? broad.boxes[t].center() : positions[t];
    bool found = false;
    for (int k = broad.begin[t]; k < broad.begin[t + 1]; ++k) {
      const int collider = broad.colliders[k];
      if (collider >= all.size()) continue; // the ground, which everything is a candidate of
      const Vec3 to = 0.5 * (all.end[collider].a + all.end[collider].b);
      lines.push_back({from.cast<float>(), to.cast<float>(), k_sky, {k_candidate, k_candidate}});
      found = true;
    }
    if (tiles) add_box(broad.boxes[t], found ? k_black : k_grey, k_box, lines);
  }
}

} // namespace tutu::app
