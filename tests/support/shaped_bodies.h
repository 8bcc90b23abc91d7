// Bodies whose shape is known in closed form, and cloth near them.
#pragma once

#include "tests/support/capsule_body.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/solids.h"

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace tutu::test {

/// A mesh, and which way is out of the shape at a point of its surface (of any length).
struct ShapedBody {
  std::string name;
  Surface surface;
  std::function<Vec3(const Vec3&)> outward;
};

/// A ball whose radius is a function of the direction.
inline ShapedBody ball_of(const std::string& name, int rounds, const std::function<double(const Vec3&)>& radius) {
  ShapedBody body{name, sphere_surface(1.0, rounds), {}};
  for (Vec3f& p : body.surface.positions) {
    const Vec3 direction = p.cast<double>().normalized();
    p = (radius(direction) * direction).cast<float>();
  }
  body.outward = [radius](const Vec3& p) {
    const auto height = [&](const Vec3& at) { return at.norm() - radius(at.normalized()); };
    Vec3 gradient;
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = 1e-6 * Vec3::Unit(k);
      gradient[k] = height(p + step) - height(p - step);
    }
    return gradient;
  };
  return body;
}

inline ShapedBody sphere_body() {
  return ball_of("sphere", 3, [](const Vec3&) { return 0.1; });
}

/// With a dent of 4 cm on its top.
inline ShapedBody dented_body() {
  return ball_of("dented ball", 3,
                 [](const Vec3& d) { return 0.1 - 0.04 * std::exp(-(d - Vec3::UnitY()).squaredNorm() / 0.2); });
}

/// With bumps 3 mm high, 4 cm from one to the next.
inline ShapedBody bumpy_body(int rounds) {
  return ball_of("bumpy ball", rounds, [](const Vec3& d) {
    return 0.15 + 0.0015 * (std::sin(24.0 * d.x()) + std::sin(24.0 * d.y() + 1.0) * std::cos(24.0 * d.z()));
  });
}

/// Faces divided: most of its edges and vertices are flat.
inline ShapedBody box_body() {
  const Vec3 half(0.1, 0.06, 0.08);
  const Surface surface = subdivided(subdivided(box_surface(half.cast<float>())));
  return {"box", surface, [half](const Vec3& p) {
            Vec3 out;
            for (int k = 0; k < 3; ++k) out[k] = std::abs(p[k]) > half[k] - 1e-6 ? std::copysign(1.0, p[k]) : 0.0;
            return out;
          }};
}

inline ShapedBody capsule_shaped(double radius, double length) {
  CapsuleBody mesh;
  const Vec3 a(0, -0.5 * length, 0), b(0, 0.5 * length, 0);
  mesh.add({a, b, radius}, 20, 5, 8);
  return {"capsule", {mesh.positions, mesh.triangles}, [a, b](const Vec3& p) {
            return Vec3(p - Vec3(0, std::clamp(p.y(), a.y(), b.y()), 0));
          }};
}

/// Cloth of up to `size` (m) about a point at `height` off the surface; two of three lie about as the surface does.
inline std::array<Vec3, 3> cloth_near(std::mt19937_64& random, const ShapedBody& body, double height, double size) {
  const rig::Triangle& t = body.surface.triangles[random() % body.surface.triangles.size()];
  std::array<Vec3, 3> corners;
  for (int k = 0; k < 3; ++k) corners[k] = body.surface.positions[t[k]].cast<double>();
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double u = uniform(random), v = (1.0 - u) * uniform(random);
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const Vec3 middle = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]) + height * normal;
  const bool lies = random() % 3 != 0;
  std::array<Vec3, 3> cloth;
  for (Vec3& corner : cloth) {
    Vec3 off = random_point(random, 0.6 * size);
    if (lies) off -= 0.95 * normal.dot(off) * normal;
    corner = middle + off;
  }
  return cloth;
}

} // namespace tutu::test
