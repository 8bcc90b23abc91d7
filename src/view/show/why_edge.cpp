#include "src/view/show/why_edge.h"

#include "proxies/distance/feature_contact.h"
#include "src/view/show/overlay_contacts.h"

#include <algorithm>
#include <fmt/format.h>

namespace tutu::app {

WhyEdge explain_edge(const Scene& scene, std::size_t garment, int spring, const FrameState& now) {
  const cloth::Garment& cloth = scene.garments[garment];
  const cloth::Spring& edge = cloth.springs[spring];
  const std::vector<Vec3>& positions = now.garments[garment].positions;
  const Vec3 &p = positions[edge.i], &q = positions[edge.j];
  WhyEdge why{cloth.name, edge.i, edge.j, now.index, edge.rest_length, (q - p).norm(), {}};
  const double gap = cloth.fabric.contact_offset();
  std::size_t collider = 0;
  for (const proxies::Proxy& proxy : scene.proxies) {
    if (!proxy.enabled) continue;
    const proxies::FeatureContact contact = proxies::edge_contact(p, q, now.colliders_end[collider++], Vec3::Zero());
    if (contact.distance < gap + k_touch_slack)
      why.contacts.push_back(
          {proxy.name, contact.distance, std::max(0.0, gap - contact.distance), contact.weights[1], contact.normal});
  }
  std::stable_sort(why.contacts.begin(), why.contacts.end(),
                   [](const WhyEdgeContact& a, const WhyEdgeContact& b) { return a.distance < b.distance; });
  return why;
}

nlohmann::json json_of(const WhyEdge& why) {
  nlohmann::json json = {{"garment", why.garment},
                         {"particles", {why.i, why.j}},
                         {"frame", why.frame},
                         {"rest_mm", 1000.0 * why.rest},
                         {"length_mm", 1000.0 * why.length},
                         {"strain", why.strain()},
                         {"contacts", nlohmann::json::array()}};
  for (const WhyEdgeContact& c : why.contacts)
    json["contacts"].push_back({{"collider", c.collider},
                                {"distance_mm", 1000.0 * c.distance},
                                {"depth_mm", 1000.0 * c.depth},
                                {"at", c.at},
                                {"normal", {c.normal.x(), c.normal.y(), c.normal.z()}}});
  return json;
}

std::vector<std::string> text_of(const WhyEdge& why) {
  std::vector<std::string> lines = {
      fmt::format("{}, thread from {} to {} in frame {}", why.garment, why.i, why.j, why.frame),
      fmt::format("{:+.1f} % of {:.1f} mm", 100.0 * why.strain(), 1000.0 * why.rest)};
  if (why.contacts.empty()) lines.push_back("touches nothing");
  for (const WhyEdgeContact& c : why.contacts)
    lines.push_back(fmt::format("{}: {:.2f} mm off, {:.2f} mm into the gap, at {:.0f} % of it", c.collider,
                                1000.0 * c.distance, 1000.0 * c.depth, 100.0 * c.at));
  return lines;
}

Passing passing(const Vec3& from, const Vec3& direction, const Vec3& p, const Vec3& q) {
  const Vec3 edge = q - p, way = p - from;
  // Both seen along the ray: the nearest point to a point in the plane across it.
  const Vec3 across = edge - edge.dot(direction) * direction, offset = way - way.dot(direction) * direction;
  const double squared = across.squaredNorm();
  const double at = squared > 0.0 ? std::clamp(-offset.dot(across) / squared, 0.0, 1.0) : 0.0;
  return {(way + at * edge).dot(direction), (offset + at * across).norm(), at};
}

} // namespace tutu::app
