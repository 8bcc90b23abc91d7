// Camera maths: from the world to the picture.
#pragma once

#include "src/view/render/frame_view.h"

#include <optional>
#include <span>

namespace tutu::app {

using Mat4f = Eigen::Matrix4f; ///< column vectors, column-major as OpenGL wants it

/// View space: x to the right, y up, looking along -z. A camera that looks straight up or down keeps -z of the
/// world upwards in the picture.
Mat4f view_from_world(const Camera& camera);

/// Perspective to OpenGL's clip space, -w..w in all axes. `aspect` is width / height; 0 < near_distance < far_distance,
/// m.
Mat4f clip_from_view(const Camera& camera, float aspect, float near_distance, float far_distance);

/// Parallel projection of the box of view space to clip space, for lights.
Mat4f orthographic(const Vec3f& lo, const Vec3f& hi);

/// Where a point of the world appears: pixels from the left and from the top (a pixel's centre is at +0.5).
/// Nothing for a point behind the eye.
std::optional<Eigen::Vector2f> project(const Camera& camera, int width, int height, const Vec3f& point);

/// The other way: the unit direction from the eye through that pixel.
Vec3f ray_through(const Camera& camera, int width, int height, const Eigen::Vector2f& pixel);

/// Looks from `yaw` (rad about +Y; 0 = from +Z, pi/2 = from +X) and `pitch` (rad, positive = from above), as near as
/// it can be with all points, and a margin, inside the picture, and them in its middle. At least one point.
Camera frame_camera(std::span<const Vec3f> points, float yaw, float pitch, float aspect);
/// The same for the corners of a box.
Camera frame_camera(const Vec3f& lo, const Vec3f& hi, float yaw, float pitch, float aspect);

/// Unit vector from a camera's target to its eye for these angles; frame_camera and the viewer share it.
Vec3f eye_direction(float yaw, float pitch);

} // namespace tutu::app
