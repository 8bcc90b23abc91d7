#include "src/view/show/why.h"

#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_motion.h"
#include "rig/error.h"
#include "src/measure/cloth_depths.h"
#include "src/view/show/overlay_contacts.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

namespace tutu::app {
namespace {

const Vec3 k_gravity = cloth::FrameInput{}.gravity;
constexpr std::array<const char*, 3> k_kinds = {"thread", "diagonal", "bend"}; // in the order of SpringKind

const char* name_of_kind(cloth::SpringKind kind) { return k_kinds[static_cast<std::size_t>(kind)]; }

proxies::Contact contact_with(const proxies::SweptColliders& all, int collider, const Vec3& point) {
  return collider == all.ground_index() ? proxies::signed_distance(point, *all.ground)
                                        : proxies::signed_distance(point, all.end[collider]);
}

std::vector<std::string> collider_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const proxies::Proxy& proxy : scene.proxies)
    if (proxy.enabled) names.push_back(proxy.name);
  names.push_back("ground");
  return names;
}

nlohmann::json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

} // namespace

Why explain(const Scene& scene, std::size_t garment, int particle, const FrameState& now, const FrameState* before) {
  const cloth::Garment& cloth = scene.garments[garment];
  const cloth::Particles& particles = now.garments[garment];
  Why why;
  why.garment = cloth.name;
  why.particle = particle;
  why.frame = now.index;
  why.time = now.time;
  why.position = particles.positions[particle];
  why.velocity = particles.velocities[particle];
  why.pinned = cloth::pinned_flags(cloth)[particle] != 0;

  const double gap = cloth.fabric.contact_offset(), h = 1.0 / scene.settings.frames_per_second;
  const proxies::SweptColliders all = now.swept(garment);
  const std::vector<std::string> names = collider_names(scene);
  for (int c = 0; c <= all.ground_index(); ++c) {
    if (!all.meets(c) || (c == all.ground_index() && !all.ground)) continue;
    const proxies::Contact contact = contact_with(all, c, why.position);
    WhyContact entry;
    entry.collider = names[c];
    entry.distance = contact.distance;
    entry.depth = std::max(0.0, gap - contact.distance);
    entry.normal = contact.normal;
    if (before && !why.pinned) {
      const Vec3 velocity = before->garments[garment].velocities[particle] + h * k_gravity;
      const proxies::Contact ahead = contact_with(all, c, before->garments[garment].positions[particle] + h * velocity);
      entry.projection = std::max(0.0, gap - ahead.distance);
      if (entry.projection > 0.0) {
        Vec3 surface = Vec3::Zero();
        if (c < all.size())
          surface = proxies::surface_motion(all.start[c], all.end[c], all.spin.empty() ? Vec3::Zero() : all.spin[c],
                                            ahead.closest) /
                    h;
        entry.cancelled = std::max(0.0, -(velocity - surface).dot(ahead.normal));
      }
    }
    if (contact.distance < gap + k_touch_slack || entry.projection > 0.0) why.contacts.push_back(entry);
  }
  std::stable_sort(why.contacts.begin(), why.contacts.end(),
                   [](const WhyContact& a, const WhyContact& b) { return a.distance < b.distance; });

  for (const cloth::Spring& spring : cloth.springs) {
    if (spring.i != particle && spring.j != particle) continue;
    const int other = spring.i == particle ? spring.j : spring.i;
    why.constraints.push_back(
        {spring.kind, other, spring.rest_length, (particles.positions[other] - why.position).norm()});
  }
  std::stable_sort(why.constraints.begin(), why.constraints.end(),
                   [](const WhyConstraint& a, const WhyConstraint& b) { return a.strain() > b.strain(); });
  return why;
}

std::optional<FirstWrong> wrong_in(const Scene& scene, std::size_t garment, int particle, const FrameState& now) {
  const cloth::Garment& cloth = scene.garments[garment];
  const std::vector<Vec3>& positions = now.garments[garment].positions;
  const proxies::SweptColliders all = now.swept(garment);
  double deepest = k_inside_depth;
  std::optional<int> in;
  for (int c = 0; c <= all.ground_index(); ++c) {
    if (!all.meets(c) || (c == all.ground_index() && !all.ground)) continue;
    const double depth = -contact_with(all, c, positions[particle]).distance;
    if (depth <= deepest) continue;
    deepest = depth;
    in = c;
  }
  if (in) return FirstWrong{now.index, collider_names(scene)[*in], deepest};
  double worst = k_wrong_longer;
  bool overlong = false;
  for (const cloth::Spring& spring : cloth.springs) {
    if (spring.kind != cloth::SpringKind::structural || (spring.i != particle && spring.j != particle)) continue;
    const double strain = cloth::strain_of(spring, positions);
    if (strain <= worst) continue;
    worst = strain;
    overlong = true;
  }
  if (overlong) return FirstWrong{now.index, "longer", worst};
  return std::nullopt;
}

nlohmann::json json_of(const Why& why) {
  nlohmann::json json = {{"garment", why.garment},
                         {"particle", why.particle},
                         {"frame", why.frame},
                         {"time", why.time},
                         {"pinned", why.pinned},
                         {"position", json_of(why.position)},
                         {"velocity", json_of(why.velocity)}};
  json["contacts"] = nlohmann::json::array();
  for (const WhyContact& c : why.contacts)
    json["contacts"].push_back({{"collider", c.collider},
                                {"distance_mm", 1000.0 * c.distance},
                                {"depth_mm", 1000.0 * c.depth},
                                {"normal", json_of(c.normal)},
                                {"projection_mm", 1000.0 * c.projection},
                                {"cancelled_m_s", c.cancelled}});
  json["constraints"] = nlohmann::json::array();
  for (const WhyConstraint& c : why.constraints)
    json["constraints"].push_back({{"kind", name_of_kind(c.kind)},
                                   {"other", c.other},
                                   {"rest_mm", 1000.0 * c.rest},
                                   {"length_mm", 1000.0 * c.length},
                                   {"strain", c.strain()}});
  json["first_wrong"] = nullptr;
  if (why.first_wrong)
    json["first_wrong"] = {
        {"frame", why.first_wrong->frame}, {"what", why.first_wrong->what}, {"value", why.first_wrong->value}};
  return json;
}

std::vector<std::string> text_of(const Why& why) {
  std::vector<std::string> lines = {
      fmt::format("{} {} in frame {}{}", why.garment, why.particle, why.frame, why.pinned ? ", pinned" : ""),
      fmt::format("at ({:.3f}, {:.3f}, {:.3f}) m, {:.2f} m/s", why.position.x(), why.position.y(), why.position.z(),
                  why.velocity.norm())};
  if (why.contacts.empty()) lines.push_back("touches nothing");
  for (const WhyContact& c : why.contacts) {
    lines.push_back(
        fmt::format("{}: {:.2f} mm off, {:.2f} mm into the gap", c.collider, 1000.0 * c.distance, 1000.0 * c.depth));
    lines.push_back(fmt::format("  normal ({:.2f}, {:.2f}, {:.2f}), pushed {:.2f} mm, {:.2f} m/s cancelled",
                                c.normal.x(), c.normal.y(), c.normal.z(), 1000.0 * c.projection, c.cancelled));
  }
  constexpr std::size_t k_shown = 6; // the rest pulls less
  for (std::size_t k = 0; k < std::min(k_shown, why.constraints.size()); ++k) {
    const WhyConstraint& c = why.constraints[k];
    lines.push_back(fmt::format("{} to {}: {:+.1f} % of {:.1f} mm", name_of_kind(c.kind), c.other, 100.0 * c.strain(),
                                1000.0 * c.rest));
  }
  if (!why.first_wrong) {
    lines.push_back("nothing wrong in what is recorded");
  } else if (why.first_wrong->what == "longer") {
    lines.push_back(
        fmt::format("first wrong in frame {}: {:+.1f} % long", why.first_wrong->frame, 100.0 * why.first_wrong->value));
  } else {
    lines.push_back(fmt::format("first wrong in frame {}: {:.2f} mm inside {}", why.first_wrong->frame,
                                1000.0 * why.first_wrong->value, why.first_wrong->what));
  }
  return lines;
}

WhyProxy explain_proxy(const Scene& scene, int collider, const FrameState& now) {
  WhyProxy why;
  why.name = collider_names(scene)[collider];
  why.frame = now.index;
  const proxies::Capsule &start = now.colliders_start[collider], &end = now.colliders_end[collider];
  why.speed = proxies::farthest_way(start, end) * scene.settings.frames_per_second;
  std::vector<Touch> touches;
  for (std::size_t g = 0; g < scene.garments.size(); ++g) {
    const cloth::Garment& garment = scene.garments[g];
    if (!now.swept(g).meets(collider)) why.ignored_by.push_back(garment.name);
    touches.clear();
    find_touches(garment, now.garments[g].positions, now.swept(g), touches);
    for (const Touch& touch : touches) {
      if (touch.collider != collider) continue;
      ++why.touching;
      const double depth = touch.depth(garment.fabric.contact_offset());
      if (depth <= why.depth) continue;
      why.depth = depth;
      why.garment = garment.name;
      why.particle = touch.particle;
    }
  }
  return why;
}

nlohmann::json json_of(const WhyProxy& why) {
  nlohmann::json json = {{"name", why.name},         {"frame", why.frame},           {"speed_m_s", why.speed},
                         {"touching", why.touching}, {"ignored_by", why.ignored_by}, {"deepest", nullptr}};
  if (why.particle >= 0)
    json["deepest"] = {{"garment", why.garment}, {"particle", why.particle}, {"depth_mm", 1000.0 * why.depth}};
  return json;
}

std::vector<std::string> text_of(const WhyProxy& why) {
  std::vector<std::string> lines = {fmt::format("{} in frame {}, {:.2f} m/s", why.name, why.frame, why.speed),
                                    fmt::format("{} particles touch it", why.touching)};
  if (why.particle >= 0)
    lines.push_back(
        fmt::format("deepest: {} {}, {:.2f} mm into the gap", why.garment, why.particle, 1000.0 * why.depth));
  for (const std::string& garment : why.ignored_by) lines.push_back("not met by " + garment);
  return lines;
}

WhyAddress why_address(const Scene& scene, const std::string& text, int most) {
  const auto number = [&](std::string_view digits) {
    int value = -1;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value < 0)
      throw InputError("", "--why", text, "GARMENT:PARTICLE@FRAME, such as skirt:12@340");
    return value;
  };
  const std::size_t at = text.rfind('@'), colon = text.rfind(':', at);
  if (at == std::string::npos || colon == std::string::npos) number("");
  WhyAddress address;
  std::string names;
  for (; address.garment < scene.garments.size(); ++address.garment) {
    const std::string& name = scene.garments[address.garment].name;
    if (text.compare(0, colon, name) == 0) break;
    names += (names.empty() ? "" : ", ") + name;
  }
  if (address.garment == scene.garments.size())
    throw InputError("", "--why", text, names.empty() ? "a scene with garments" : "a garment of the scene: " + names);
  address.particle = number(std::string_view(text).substr(colon + 1, at - colon - 1));
  address.frame = number(std::string_view(text).substr(at + 1));
  const int particles = scene.garments[address.garment].particle_count();
  if (address.particle >= particles)
    throw InputError("", "--why", text, fmt::format("a particle from 0 to {}", particles - 1));
  if (address.frame > most) throw InputError("", "--why", text, fmt::format("a frame from 0 to {}", most));
  return address;
}

} // namespace tutu::app
