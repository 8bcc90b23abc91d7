// The camera a hand moves: around, nearer, aside.
#pragma once

#include "src/view/render/camera.h"

namespace tutu::app {

/// Plain values; every function leaves pitch within +-1.5 rad, distance within 0.05 .. 100 m, all finite.
struct OrbitCamera {
  Vec3f target = {0, 0.9f, 0};
  float yaw = 0.35f;  ///< rad about +Y; 0 = the eye on +Z of the target
  float pitch = 0.1f; ///< rad, positive = from above
  float distance = 4; ///< m
  float vertical_fov = 0.6f;

  Camera camera() const;
};

/// Drags in pixels, right and down positive; `height` of the picture in pixels.
/// The scene follows the hand: dragging to the right turns its front to the right.
void rotate(OrbitCamera& orbit, float dx, float dy, int height);
/// The target's plane stays under the pointer.
void pan(OrbitCamera& orbit, float dx, float dy, int height);
/// Wheel notches, positive = nearer. Each is the same factor.
void zoom(OrbitCamera& orbit, float notches);

/// The orbit whose camera() is frame_camera() of these values.
OrbitCamera frame_orbit(const Vec3f& lo, const Vec3f& hi, float yaw, float pitch, float aspect);

} // namespace tutu::app
