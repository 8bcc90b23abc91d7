#include "src/scene/garment_reach.h"

#include "cloth/garment_elements.h"
#include "proxies/signed_distance.h"

#include <algorithm>
#include <limits>
#include <map>

namespace tutu::app {
namespace {

/// A ball about a point that rides on a joint: all cloth that hangs on one pin.
struct Ball {
  int joint = 0;
  Vec3 centre = Vec3::Zero(); ///< in the joint's frame, m
  double radius = 0.0;        ///< m
};

/// Nothing where some cloth hangs on no pin.
std::optional<std::vector<Ball>> balls_of(const cloth::Garment& garment, const std::vector<int>& joints,
                                          std::span<const Transform> rest) {
  if (garment.pins.empty()) return std::nullopt;
  const double keeps = garment.fabric.contact_offset();
  std::map<int, Ball> by_particle;
  for (const cloth::Pin& pin : garment.pins) {
    const int joint = joints[pin.attachment];
    by_particle[pin.particle] = {joint, rest[joint].inverse() * garment.rest_positions[pin.particle], keeps};
  }
  const std::vector<cloth::Tether> tethers = cloth::build_tethers(garment);
  if (tethers.size() + garment.pins.size() < garment.rest_positions.size()) return std::nullopt;
  for (const cloth::Tether& tether : tethers) {
    Ball& ball = by_particle.at(tether.anchor);
    ball.radius = std::max(ball.radius, k_reach_stretch * tether.length + keeps);
  }
  std::vector<Ball> balls;
  for (const auto& [particle, ball] : by_particle) balls.push_back(ball);
  return balls;
}

} // namespace

std::vector<std::optional<double>> garment_clearance(const rig::Character& character,
                                                     std::span<const cloth::Garment> garments,
                                                     std::span<const std::vector<int>> attachment_joints,
                                                     const std::vector<std::vector<Transform>>& poses,
                                                     std::span<const proxies::Proxy> proxies) {
  const std::vector<Transform> rest = rig::rest_model(character.skeleton);
  std::vector<Ball> balls;
  for (std::size_t g = 0; g < garments.size(); ++g) {
    const auto of_garment = balls_of(garments[g], attachment_joints[g], rest);
    if (!of_garment) return std::vector<std::optional<double>>(proxies.size());
    balls.insert(balls.end(), of_garment->begin(), of_garment->end());
  }
  std::vector<std::optional<double>> clearance;
  for (const proxies::Proxy& proxy : proxies) {
    double least = std::numeric_limits<double>::infinity();
    for (const std::vector<Transform>& pose : poses) {
      const proxies::Capsule capsule{proxy.a.place(pose), proxy.b.place(pose), proxy.radius};
      for (const Ball& ball : balls)
        least =
            std::min(least, proxies::signed_distance(pose[ball.joint] * ball.centre, capsule).distance - ball.radius);
    }
    clearance.push_back(least);
  }
  return clearance;
}

} // namespace tutu::app
