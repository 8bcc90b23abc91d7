// Joints and proxies as things to draw. All append.
#pragma once

#include "proxies/motion/collider_set.h"
#include "rig/skeleton.h"
#include "src/run/frame_state.h"
#include "src/view/render/frame_view.h"

#include <span>
#include <vector>

namespace tutu::app {

/// The segment from each joint to its parent.
void add_skeleton(const rig::Skeleton& skeleton, std::span<const Transform> joints, std::vector<LineView>& lines);

/// Three arrows a joint, x y z in vermilion, green and blue, k_joint_axis long.
inline constexpr float k_joint_axis = 0.05f; // m
void add_joint_frames(std::span<const Transform> joints, std::vector<LineView>& lines);

/// The colliders at the frame's end: balls sky blue, all others orange, what a garment ignores grey.
void add_proxies(const FrameState& state, std::vector<CapsuleView>& capsules);

/// Twelve edges a box.
void add_box(const proxies::Box& box, const Colour& colour, float width, std::vector<LineView>& lines);

/// The boxes that the broad phase is asked with: proxies::swept_box of each collider.
void add_swept_boxes(const proxies::SweptColliders& colliders, std::vector<LineView>& lines);

/// What each collider that moves passes through: itself at k_sweep_poses moments of the frame, evenly from its start,
/// the end left out, and the way of both ends of its axis.
inline constexpr int k_sweep_poses = 4;
void add_sweeps(const proxies::SweptColliders& colliders, std::vector<CapsuleView>& capsules,
                std::vector<LineView>& lines);

} // namespace tutu::app
