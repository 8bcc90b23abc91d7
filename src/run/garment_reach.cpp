#include "src/run/garment_reach.h"

#include "cloth/garment/reach.h"
#include "proxies/distance/signed_distance.h"

#include <algorithm>
#include <limits>

namespace tutu::app {
namespace {

/// Where a pin is in its joint's frame, m.
struct JointPoint {
  int joint = 0;
  Vec3 at = Vec3::Zero();
};

/// The balls of a garment in each pose, pose by pose; nothing where some cloth hangs on no pin.
std::optional<std::vector<proxies::Capsule>> balls_of(const cloth::Garment& garment, const std::vector<int>& joints,
                                                      std::span<const Transform> rest,
                                                      const std::vector<std::vector<Transform>>& poses) {
  const cloth::GarmentReach reach(garment);
  if (!reach.bounded()) return std::nullopt;
  std::vector<JointPoint> points;
  for (const cloth::Pin& pin : garment.pins) {
    const int joint = joints[pin.attachment];
    points.push_back({joint, rest[joint].inverse() * garment.rest_positions[pin.particle]});
  }
  std::vector<proxies::Capsule> balls;
  std::vector<Vec3> pins(points.size());
  for (const std::vector<Transform>& pose : poses) {
    for (std::size_t k = 0; k < pins.size(); ++k) pins[k] = pose[points[k].joint] * points[k].at;
    reach.place(pins, balls);
  }
  return balls;
}

} // namespace

std::vector<std::optional<double>> garment_clearance(const rig::Character& character,
                                                     std::span<const cloth::Garment> garments,
                                                     std::span<const std::vector<int>> attachment_joints,
                                                     const std::vector<std::vector<Transform>>& poses,
                                                     std::span<const proxies::Proxy> proxies) {
  const std::vector<Transform> rest = rig::rest_model(character.skeleton);
  std::vector<double> least(proxies.size(), std::numeric_limits<double>::infinity());
  for (std::size_t g = 0; g < garments.size(); ++g) {
    const auto balls = balls_of(garments[g], attachment_joints[g], rest, poses);
    if (!balls) return std::vector<std::optional<double>>(proxies.size());
    const std::size_t pins = garments[g].pins.size();
    for (std::size_t p = 0; p < proxies.size(); ++p)
      for (std::size_t k = 0; k < balls->size(); ++k) {
        const std::vector<Transform>& pose = poses[k / pins];
        const proxies::Capsule capsule{proxies[p].a.place(pose), proxies[p].b.place(pose), proxies[p].radius,
                                       proxies[p].taper};
        const proxies::Capsule& ball = (*balls)[k];
        least[p] = std::min(least[p], proxies::signed_distance(ball.a, capsule).distance - ball.radius);
      }
  }
  return {least.begin(), least.end()};
}

} // namespace tutu::app
