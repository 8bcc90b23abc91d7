#include "rig/io/file_io.h"
#include "rig/mannequin/mannequin.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>
#include <map>
#include <numeric>
#include <set>

namespace tutu::rig {
namespace {

const Mannequin& dancer() {
  static const Mannequin k_dancer = make_mannequin();
  return k_dancer;
}

using Point = std::array<float, 3>;
Point key(const Vec3f& p) { return {p.x() + 0.0f, p.y(), p.z()}; }
Point mirrored_key(const Vec3f& p) { return {-p.x() + 0.0f, p.y(), p.z()}; }

std::string mirrored_name(std::string name) {
  if (const auto at = name.find("Left"); at != std::string::npos) return name.replace(at, 4, "Right");
  if (const auto at = name.find("Right"); at != std::string::npos) return name.replace(at, 5, "Left");
  return name;
}

int components(const Mesh& mesh) {
  std::vector<std::uint32_t> root(mesh.positions.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) root[find(t[0])] = root[find(t[1])] = find(t[2]);
  std::set<std::uint32_t> roots;
  for (std::uint32_t v = 0; v < root.size(); ++v) roots.insert(find(v));
  return static_cast<int>(roots.size());
}

/// Every edge once in each direction: closed, and all triangles turned the same way. Gives the number of edges.
std::size_t expect_closed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) ++edges[{t[c], t[(c + 1) % 3]}];
  int wrong = 0;
  for (const auto& [edge, count] : edges) wrong += count != 1 || !edges.contains({edge.second, edge.first});
  EXPECT_EQ(wrong, 0);
  return edges.size() / 2;
}

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]].cast<double>(), b = mesh.positions[t[1]].cast<double>();
    sum += a.dot(b.cross(mesh.positions[t[2]].cast<double>())) / 6.0;
  }
  return sum;
}

TEST(Mannequin, is_written_with_the_same_bytes_as_the_asset_slow) {
  const std::string written = collada_of(dancer());
  EXPECT_TRUE(written == read_file(test::source_file("assets/characters/dancer.dae")))
      << "write the asset anew: tutu mannequin --out assets/characters/dancer.dae";
}

TEST(Mannequin, has_the_52_joints_at_mirrored_places_and_unturned_slow) {
  const Skeleton& skeleton = dancer().skeleton;
  ASSERT_EQ(skeleton.joint_count(), 52);
  EXPECT_NO_THROW(skeleton.check("dancer"));
  const std::vector<Transform> rest = rest_model(skeleton);
  for (const char* name :
       {"Hips", "Spine", "Spine1", "Spine2", "Neck", "Head", "LeftShoulder", "RightHandPinky3", "LeftToeBase"})
    EXPECT_TRUE(skeleton.find(name)) << name;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    EXPECT_TRUE(skeleton.names[j].starts_with("mixamorig_"));
    EXPECT_EQ(skeleton.rest_local[j].rotation.coeffs(), Quat::Identity().coeffs());
    const auto other = skeleton.find(mirrored_name(skeleton.names[j]));
    ASSERT_TRUE(other) << skeleton.names[j];
    const Vec3 here = rest[j].translation, there = rest[*other].translation;
    EXPECT_LT((here - Vec3(-there.x(), there.y(), there.z())).norm(), 1e-12) << skeleton.names[j];
    EXPECT_NEAR(skeleton.rest_local[j].translation.norm(), skeleton.rest_local[*other].translation.norm(), 1e-12);
    if (skeleton.names[j].find("Left") != std::string::npos) {
      EXPECT_GT(here.x(), 0.0) << skeleton.names[j];
    }
  }
}

TEST(Mannequin, surface_is_one_closed_skin_without_handles) {
  const Mesh& mesh = dancer().surface;
  const std::size_t edges = expect_closed(mesh);
  EXPECT_EQ(components(mesh), 1);
  EXPECT_EQ(mesh.vertex_count() - static_cast<int>(edges) + static_cast<int>(mesh.triangles.size()), 2); // genus 0
  EXPECT_GT(volume(mesh), 0.045);                                                                        // m3
  EXPECT_LT(volume(mesh), 0.075);
  EXPECT_GE(mesh.vertex_count() + dancer().spheres.vertex_count(), 8000);
  EXPECT_LE(mesh.vertex_count() + dancer().spheres.vertex_count(), 15000);
}

TEST(Mannequin, stands_on_the_ground_1_70_m_tall_slow) {
  float lowest = 10.0f, highest = -10.0f;
  for (const Vec3f& p : dancer().surface.positions) {
    lowest = std::min(lowest, p.y());
    highest = std::max(highest, p.y());
  }
  EXPECT_NEAR(lowest, 0.0, 1e-3);
  EXPECT_NEAR(highest - lowest, 1.70, 1e-3);
}

TEST(Mannequin, triangles_have_area_and_normals_look_outward_slow) {
  for (const Mesh* mesh : {&dancer().surface, &dancer().spheres}) {
    ASSERT_EQ(mesh->normals.size(), mesh->positions.size());
    int slivers = 0, inward = 0, not_unit = 0;
    for (const Triangle& t : mesh->triangles) {
      const Vec3 a = mesh->positions[t[0]].cast<double>(), b = mesh->positions[t[1]].cast<double>(),
                 c = mesh->positions[t[2]].cast<double>();
      const Vec3 area = (b - a).cross(c - a);
      const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
      slivers += area.norm() < 0.1 * longest;
      for (const std::uint32_t v : t) inward += area.dot(mesh->normals[v].cast<double>()) <= 0.0;
    }
    for (const Vec3f& n : mesh->normals) not_unit += std::abs(n.norm() - 1.0f) > 1e-5f;
    EXPECT_EQ(slivers, 0);
    EXPECT_EQ(inward, 0);
    EXPECT_EQ(not_unit, 0);
  }
}

TEST(Mannequin, weights_are_few_sum_to_one_and_mirror_slow) {
  const Mannequin& d = dancer();
  const Skin& skin = d.surface_skin;
  ASSERT_EQ(skin.influences, 4);
  ASSERT_EQ(skin.weights.size(), d.surface.positions.size() * 4);
  std::map<Point, std::map<std::string, float>> by_place;
  std::set<int> used;
  for (std::size_t v = 0; v < d.surface.positions.size(); ++v) {
    float sum = 0.0f;
    auto& joints = by_place[key(d.surface.positions[v])];
    for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
      EXPECT_GE(skin.weights[k], 0.0f);
      if (k > 4 * v) {
        EXPECT_LE(skin.weights[k], skin.weights[k - 1]);
      }
      sum += skin.weights[k];
      if (skin.weights[k] == 0.0f) continue;
      used.insert(skin.slot_joint[skin.slots[k]]);
      joints[d.skeleton.names[skin.slot_joint[skin.slots[k]]]] = skin.weights[k];
    }
    EXPECT_NEAR(sum, 1.0f, 1e-6f);
  }
  EXPECT_EQ(by_place.size(), d.surface.positions.size()); // no two vertices in one place
  EXPECT_EQ(used.size(), 52u);
  int unlike = 0;
  for (const Vec3f& p : d.surface.positions) {
    const auto other = by_place.find(mirrored_key(p));
    if (other == by_place.end()) {
      ++unlike;
      continue;
    }
    std::map<std::string, float> swapped;
    for (const auto& [name, weight] : other->second) swapped[mirrored_name(name)] = weight;
    bool alike = swapped.size() == by_place[key(p)].size();
    for (const auto& [name, weight] : by_place[key(p)])
      alike = alike && swapped.contains(name) && std::abs(swapped[name] - weight) < 2e-5f; // steps of 1e-5
    unlike += !alike;
  }
  EXPECT_EQ(unlike, 0);
}

TEST(Mannequin, nothing_hangs_on_a_limb_it_does_not_touch_slow) {
  const Mannequin& d = dancer();
  const Skin& skin = d.surface_skin;
  const auto weight = [&](std::size_t v, const char* part) {
    float sum = 0.0f;
    for (std::size_t k = 4 * v; k < 4 * v + 4; ++k)
      if (d.skeleton.names[skin.slot_joint[skin.slots[k]]].find(part) != std::string::npos) sum += skin.weights[k];
    return sum;
  };
  for (std::size_t v = 0; v < d.surface.positions.size(); ++v) {
    const Vec3f& p = d.surface.positions[v];
    if (p.y() < 0.75f) {
      EXPECT_EQ(weight(v, p.x() > 0.0f ? "Right" : "Left"), 0.0f);
    }
    if (p.y() < 1.15f && std::abs(p.x()) < 0.2f) {
      EXPECT_EQ(weight(v, "Arm") + weight(v, "Hand"), 0.0f);
    }
    if (p.y() > 1.15f) {
      EXPECT_EQ(weight(v, "Leg"), 0.0f);
    }
    if (weight(v, "Index") > 0.3f) {
      EXPECT_LT(weight(v, "Ring") + weight(v, "Pinky"), 0.05f);
    }
  }
}

TEST(Mannequin, spheres_hide_at_the_joints_they_hang_on_slow) {
  const Mannequin& d = dancer();
  const std::vector<Transform> rest = rest_model(d.skeleton);
  expect_closed(d.spheres);
  EXPECT_EQ(components(d.spheres), 52);
  EXPECT_EQ(d.spheres.vertex_count() % 52, 0);
  for (std::size_t v = 0; v < d.spheres.positions.size(); ++v) {
    const std::uint16_t slot = d.sphere_skin.slots[4 * v];
    EXPECT_EQ(d.sphere_skin.weights[4 * v], 1.0f);
    const Vec3 joint = rest[d.sphere_skin.slot_joint[slot]].translation;
    EXPECT_LE((d.spheres.positions[v].cast<double>() - joint).norm(), 0.0181);
    EXPECT_LT((d.sphere_skin.inverse_bind[slot] * joint).norm(), 1e-12);
  }
}

} // namespace
} // namespace tutu::rig
