#include "rig/mannequin/mannequin.h"

#include "rig/mannequin/detail/parts.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tutu::rig {
namespace {

/// To a whole micrometre: what is written in six decimals is what there is.
Vec3f rounded(const Vec3& p) {
  const auto micro = [](double x) { return static_cast<float>(std::round(x * 1e6) / 1e6); };
  return {micro(p.x()), micro(p.y()), micro(p.z())};
}

/// Both halves in one; `mirrored` gives each vertex its mirror image.
Mesh whole_surface(const HalfSurface& half, std::vector<std::uint32_t>& mirrored) {
  Mesh mesh;
  for (const Vec3& p : half.positions) mesh.positions.push_back(rounded(p));
  mirrored.resize(half.positions.size());
  for (std::uint32_t v = 0; v < half.positions.size(); ++v) {
    mirrored[v] = v;
    Vec3f p = mesh.positions[v];
    if (p.x() == 0.0f) continue;
    p.x() = -p.x();
    mirrored[v] = static_cast<std::uint32_t>(mesh.positions.size());
    mirrored.push_back(v);
    mesh.positions.push_back(p);
  }
  mesh.triangles = half.triangles;
  for (const Triangle& t : half.triangles) mesh.triangles.push_back({mirrored[t[0]], mirrored[t[2]], mirrored[t[1]]});
  mesh.normals = angle_weighted_normals(mesh.positions, mesh.triangles);
  mesh.parts = {{"surface", 0, static_cast<std::uint32_t>(mesh.triangles.size()), {0.80f, 0.58f, 0.47f}}};
  return mesh;
}

/// A unit sphere of 42 vertices: an icosahedron whose 20 faces are cut in four.
void unit_sphere(std::vector<Vec3>& points, std::vector<Triangle>& triangles) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
            {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& p : points) p.normalize();
  // Faces are the triples of corners one edge apart, turned to look outward.
  const double edge = (points[0] - points[1]).norm() * 1.01;
  std::vector<Triangle> faces;
  for (std::uint32_t a = 0; a < 12; ++a)
    for (std::uint32_t b = a + 1; b < 12; ++b)
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        const Vec3 &pa = points[a], &pb = points[b], &pc = points[c];
        if (std::max({(pa - pb).norm(), (pb - pc).norm(), (pc - pa).norm()}) > edge) continue;
        const bool outward = pa.dot(pb.cross(pc)) > 0.0;
        faces.push_back(outward ? Triangle{a, b, c} : Triangle{a, c, b});
      }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
    if (is_new) points.push_back((points[a] + points[b]).normalized());
    return entry->second;
  };
  for (const Triangle& f : faces) {
    const std::uint32_t ab = middle(f[0], f[1]), bc = middle(f[1], f[2]), ca = middle(f[2], f[0]);
    triangles.insert(triangles.end(), {{f[0], ab, ca}, {f[1], bc, ab}, {f[2], ca, bc}, {ab, bc, ca}});
  }
}

/// A sphere about every joint, as large as fits under the skin.
void add_spheres(Mannequin& mannequin) {
  constexpr double k_largest = 0.018, k_smallest = 0.003, k_fit = 0.5; // m, m, of the joint's depth below the skin
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  unit_sphere(points, triangles);

  const std::vector<Transform> rest = rest_model(mannequin.skeleton);
  const int joints = mannequin.skeleton.joint_count();
  Mesh& mesh = mannequin.spheres;
  Skin& skin = mannequin.sphere_skin;
  for (int j = 0; j < joints; ++j) {
    const Vec3& centre = rest[j].translation;
    const double depth = -body_distance({std::abs(centre.x()), centre.y(), centre.z()});
    const double radius = std::clamp(k_fit * depth, k_smallest, k_largest);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : points) {
      mesh.positions.push_back(rounded(centre + radius * p));
      mesh.normals.push_back(p.cast<float>());
      // The slots of this skin stand in the opposite order of the joints.
      skin.slots.insert(skin.slots.end(), {static_cast<std::uint16_t>(joints - 1 - j), 0, 0, 0});
      skin.weights.insert(skin.weights.end(), {1.0f, 0.0f, 0.0f, 0.0f});
    }
    for (const Triangle& t : triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  mesh.parts = {{"joint spheres", 0, static_cast<std::uint32_t>(mesh.triangles.size()), {0.06f, 0.05f, 0.06f}}};
  for (int j = joints - 1; j >= 0; --j) {
    skin.slot_joint.push_back(j);
    skin.inverse_bind.emplace_back(Eigen::Translation3d(-rest[j].translation));
  }
}

} // namespace

Mannequin make_mannequin() {
  HalfSurface half = march_body();
  remesh_body(half);
  Mannequin mannequin;
  mannequin.skeleton = mannequin_skeleton();
  std::vector<std::uint32_t> mirrored;
  mannequin.surface = whole_surface(half, mirrored);
  mannequin.surface_skin = mannequin_skin(mannequin.skeleton, mannequin.surface, mirrored);
  add_spheres(mannequin);
  return mannequin;
}

} // namespace tutu::rig
