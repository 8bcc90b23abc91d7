#include "src/measure/run_end.h"

#include "proxies/distance/signed_distance.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tutu::app {

DeepestPoint deepest_of(const ClothDepths& depths) { return {depths.surface, depths.surface_particle}; }

std::string place_among(const Vec3& place, std::span<const proxies::Capsule> colliders,
                        const std::vector<proxies::Proxy>& proxies) {
  struct Near {
    proxies::Contact contact;
    std::size_t collider;
  };
  std::vector<Near> near;
  for (std::size_t c = 0; c < colliders.size(); ++c)
    if (const proxies::Contact contact = proxies::signed_distance(place, colliders[c]); contact.distance < k_by)
      near.push_back({contact, c});
  if (near.empty()) return "";
  std::ranges::stable_sort(near, {}, [](const Near& n) { return n.contact.distance; });
  const Near& nearest = near.front();
  const auto across = std::ranges::find_if(
      near, [&](const Near& other) { return other.contact.normal.dot(nearest.contact.normal) < 0.0; });
  const std::string& name = proxies[nearest.collider].name;
  return across == near.end() ? "by " + name : fmt::format("between {} and {}", name, proxies[across->collider].name);
}

std::string RunEnd::warning() const {
  std::vector<std::string> ends;
  for (const GarmentEnd& end : garments) {
    std::vector<std::string> wrong;
    if (end.longest.longer > k_most_longer)
      wrong.push_back(fmt::format("a thread {:.0f} % longer than at rest (particles {} - {}{}{})",
                                  100.0 * end.longest.longer, end.longest.i, end.longest.j,
                                  end.longest_at.empty() ? "" : ", ", end.longest_at));
    const auto deep = [&](const std::optional<DeepestPoint>& point, const char* in) {
      if (point && point->depth > k_most_depth)
        wrong.push_back(
            fmt::format("its surface {:.0f} mm deep in {} (by particle {})", 1e3 * point->depth, in, point->particle));
    };
    deep(end.in_proxies, "the proxies");
    deep(end.in_body, "the body");
    if (!wrong.empty()) ends.push_back(fmt::format("{} ends with {}", end.garment, fmt::join(wrong, " and ")));
  }
  return fmt::format("{}", fmt::join(ends, "; "));
}

nlohmann::json RunEnd::json() const {
  nlohmann::json rows = nlohmann::json::array();
  for (const GarmentEnd& end : garments) {
    nlohmann::json row = {{"garment", end.garment},
                          {"longer_pct", 100.0 * end.longest.longer},
                          {"thread", {end.longest.i, end.longest.j}}};
    if (!end.longest_at.empty()) row["thread_at"] = end.longest_at;
    const auto add = [&](const char* in, const std::optional<DeepestPoint>& point) {
      if (point) row["surface_mm"][in] = 1e3 * point->depth;
    };
    add("proxies", end.in_proxies);
    add("body", end.in_body);
    rows.push_back(std::move(row));
  }
  const std::string text = warning();
  return {{"garments", rows}, {"warning", text.empty() ? nlohmann::json(nullptr) : nlohmann::json(text)}};
}

RunEnd end_of(const Session& session, std::span<const ClothProbe> probes, const proxies::BodyMesh* body) {
  RunEnd result;
  const proxies::SweptColliders colliders = session.colliders().swept();
  for (std::size_t g = 0; g < probes.size(); ++g) {
    const std::vector<Vec3>& positions = session.garment(static_cast<int>(g)).particles().positions;
    GarmentEnd end{session.scene().garments[g].name, cloth::longest_thread(probes[g].parts(), positions), {}, {}};
    if (!session.failure() && !session.stopped()) {
      end.longest_at =
          place_among(cloth::middle_of(end.longest, positions), colliders.end, session.colliders().proxies());
      ClothDepths in_proxies, in_body;
      if (!session.collides_with_body()) {
        probes[g].measure(session.colliders_of(static_cast<int>(g)), positions, in_proxies);
        end.in_proxies = deepest_of(in_proxies);
      }
      if (body) {
        probes[g].measure(*body, positions, in_body);
        end.in_body = deepest_of(in_body);
      }
    }
    result.garments.push_back(std::move(end));
  }
  return result;
}

} // namespace tutu::app
