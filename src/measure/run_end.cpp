#include "src/measure/run_end.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tutu::app {

DeepestPoint deepest_of(const ClothDepths& depths) { return {depths.surface, depths.surface_particle}; }

std::string RunEnd::warning() const {
  std::vector<std::string> ends;
  for (const GarmentEnd& end : garments) {
    std::vector<std::string> wrong;
    if (end.longest.longer > k_most_longer)
      wrong.push_back(fmt::format("a thread {:.0f} % longer than at rest (particles {} - {})",
                                  100.0 * end.longest.longer, end.longest.i, end.longest.j));
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
      ClothDepths in_proxies, in_body;
      if (!session.collides_with_body()) {
        probes[g].measure(colliders.end, colliders.ground, positions, in_proxies);
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
