// From the pointer to the scene: the line of sight under it, and what it meets.
#pragma once

#include "src/view/render/camera.h"

#include <optional>
#include <span>

namespace tutu::app {

/// A camera and the picture it makes, px.
struct Picture {
  Camera camera;
  int width = 1, height = 1;
};

struct Ray {
  Vec3 origin, direction; ///< unit
};

/// The line of sight through a point of the picture: px from the left and from the top (a pixel's centre is at +0.5).
Ray ray_through(const Picture& picture, double x, double y);

/// Where the ray meets a plane; none beside it or behind the eye.
std::optional<Vec3> on_plane(const Ray& ray, const Vec3& point, const Vec3& normal);

/// Where the ray meets a sphere: of its two points the one nearer to `near`. A ray that misses gives its own point
/// nearest to the centre, from which the sphere's nearest is its outline.
Vec3 on_sphere(const Ray& ray, const Vec3& centre, double radius, const Vec3& near);

/// The joint whose place in the picture is nearest to the pointer and within `reach` px of it. Of those that appear at
/// one place (to a pixel) the one nearest to the eye.
std::optional<int> nearest_joint(const Picture& picture, std::span<const Transform> model_from_joint, double x,
                                 double y, double reach);

/// The handle that turns a joint about its bone. World space, m.
struct Ring {
  Vec3 centre, axis; ///< unit
  double radius = 0.0;

  /// A point on it, and the angle (rad, right-handed about the axis) of a point near its plane.
  Vec3 at(double angle) const;
  double angle_of(const Vec3& point) const;
};

/// px in the picture from the pointer to the ring; infinite when it is behind the eye.
double pixels_to_ring(const Picture& picture, const Ring& ring, double x, double y);

/// The angle on the ring under the ray: in the ring's plane; seen nearly from its edge, that of the nearest point.
double angle_on_ring(const Ring& ring, const Ray& ray);

} // namespace tutu::app
