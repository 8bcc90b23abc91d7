#include "src/view/show/overlay_body.h"

#include "proxies/motion/collider_motion.h"
#include "src/view/show/overlay_colours.h"

#include <algorithm>

namespace tutu::app {
namespace {

constexpr double k_still = 1e-4; // m that a collider's end goes in a frame: less is not seen

CapsuleView drawn(const proxies::Capsule& capsule, const Colour& colour) {
  return {capsule.a.cast<float>(), capsule.b.cast<float>(), static_cast<float>(capsule.radius_at(0.0)),
          static_cast<float>(capsule.radius_at(1.0)), colour};
}

} // namespace

void add_skeleton(const rig::Skeleton& skeleton, std::span<const Transform> joints, std::vector<LineView>& lines) {
  for (int j = 0; j < skeleton.joint_count(); ++j)
    if (const int parent = skeleton.parents[j]; parent != rig::k_no_parent)
      lines.push_back({joints[parent].translation.cast<float>(), joints[j].translation.cast<float>(), k_vermilion});
}

void add_joint_frames(std::span<const Transform> joints, std::vector<LineView>& lines) {
  constexpr std::array<Colour, 3> k_axes = {k_vermilion, k_green, k_blue};
  for (const Transform& joint : joints)
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 direction = (joint * Vec3(Vec3::Unit(axis)) - joint.translation).normalized();
      add_arrow(joint.translation.cast<float>(), k_joint_axis * direction.cast<float>(), k_axes[axis], lines);
    }
}

void add_proxies(const FrameState& state, std::vector<CapsuleView>& capsules) {
  for (std::size_t c = 0; c < state.colliders_end.size(); ++c) {
    const proxies::Capsule& collider = state.colliders_end[c];
    const bool is_ignored = std::ranges::any_of(
        state.ignored, [&](const std::vector<std::uint8_t>& mask) { return !mask.empty() && mask[c] != 0; });
    capsules.push_back(drawn(collider, is_ignored ? k_grey : collider.a == collider.b ? k_sky : k_orange));
  }
}

void add_box(const proxies::Box& box, const Colour& colour, float width, std::vector<LineView>& lines) {
  using Corner = proxies::Box::CornerType;
  for (int from = 0; from < 8; ++from)
    for (int axis = 0; axis < 3; ++axis)
      if (const int to = from | 1 << axis; to != from)
        lines.push_back({box.corner(static_cast<Corner>(from)).cast<float>(),
                         box.corner(static_cast<Corner>(to)).cast<float>(),
                         colour,
                         {width, width}});
}

void add_swept_boxes(const proxies::SweptColliders& colliders, std::vector<LineView>& lines) {
  for (int c = 0; c < colliders.size(); ++c)
    add_box(proxies::swept_box(colliders.start[c], colliders.end[c]), k_blue, 0.6f, lines);
}

void add_sweeps(const proxies::SweptColliders& colliders, std::vector<CapsuleView>& capsules,
                std::vector<LineView>& lines) {
  for (int c = 0; c < colliders.size(); ++c) {
    const proxies::Capsule &start = colliders.start[c], &end = colliders.end[c];
    if (proxies::farthest_way(start, end) < k_still) continue;
    proxies::Capsule before = start;
    for (int k = 0; k < k_sweep_poses; ++k) {
      capsules.push_back(drawn(before, k_purple));
      const proxies::Capsule next = proxies::capsule_at(start, end, (k + 1.0) / k_sweep_poses);
      lines.push_back({before.a.cast<float>(), next.a.cast<float>(), k_purple});
      if (start.a != start.b) lines.push_back({before.b.cast<float>(), next.b.cast<float>(), k_purple});
      before = next;
    }
  }
}

} // namespace tutu::app
