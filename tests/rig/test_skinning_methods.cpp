// Dual quaternions and centres of rotation: closed forms, twins, and what they are for: the volume of bent limbs.
#include "rig/error.h"
#include "rig/mannequin/mannequin.h"
#include "tests/rig/random_skeleton.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr Skinning k_methods[] = {Skinning::linear, Skinning::dual_quaternion, Skinning::centres_of_rotation};

struct Limb {
  Mesh mesh;
  Skin skin;
};

/// A closed cylinder along +Y, 0.5 m long and 40 mm in radius; two joints, at 0 and at half its length. The weights
/// pass from one to the other within 60 mm on either side of the second.
Limb cylinder(int around = 24, int along = 100) {
  constexpr double k_length = 0.5, k_radius = 0.04, k_blend = 0.06;
  Limb limb;
  limb.skin.slot_joint = {0, 1};
  limb.skin.inverse_bind = {Eigen::Affine3d::Identity(), Eigen::Affine3d(Eigen::Translation3d(0, -0.5 * k_length, 0))};
  const auto add = [&](const Vec3& position, const Vec3& normal) {
    limb.mesh.positions.push_back(position.cast<float>());
    limb.mesh.normals.push_back(normal.cast<float>());
    const double s = std::clamp((position.y() - 0.5 * k_length) / (2.0 * k_blend) + 0.5, 0.0, 1.0);
    const auto upper = static_cast<float>(s * s * (3.0 - 2.0 * s));
    const bool mostly_upper = upper > 0.5f;
    const std::uint16_t first = mostly_upper ? 1 : 0, second = mostly_upper ? 0 : 1;
    limb.skin.slots.insert(limb.skin.slots.end(), {first, second, 0, 0});
    limb.skin.weights.insert(limb.skin.weights.end(),
                             {std::max(upper, 1.0f - upper), std::min(upper, 1.0f - upper), 0.0f, 0.0f});
  };
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j < around; ++j) {
      const double angle = 2.0 * k_pi * j / around;
      const Vec3 out(std::cos(angle), 0.0, std::sin(angle));
      add(k_radius * out + Vec3(0, k_length * i / along, 0), out);
    }
  add({0, 0, 0}, -Vec3::UnitY());
  add({0, k_length, 0}, Vec3::UnitY());
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * around + j % around); };
  const auto bottom = static_cast<std::uint32_t>((along + 1) * around), top = bottom + 1;
  for (int j = 0; j < around; ++j) {
    for (int i = 0; i < along; ++i) {
      limb.mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      limb.mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    limb.mesh.triangles.push_back({bottom, at(0, j), at(0, j + 1)});
    limb.mesh.triangles.push_back({top, at(along, j + 1), at(along, j)});
  }
  return limb;
}

/// The lower joint at rest, the upper one turned.
std::vector<Transform> turned(const Vec3& axis, double degrees) {
  return {{}, {Quat(Eigen::AngleAxisd(degrees * k_pi / 180.0, axis)), {0, 0.25, 0}}};
}

std::vector<Vec3> skinned(const Mesh& mesh, const Skin& skin, std::span<const Transform> model) {
  std::vector<Vec3> positions(mesh.positions.size());
  skin_vertices_reference(mesh, skin, model, positions, {});
  return positions;
}

double volume_of(const std::vector<Triangle>& triangles, const std::vector<Vec3>& p) { // divergence theorem
  double sum = 0.0;
  for (const Triangle& t : triangles) sum += p[t[0]].dot(p[t[1]].cross(p[t[2]]));
  return sum / 6.0;
}

TEST(SkinningMethods, ATwistedTubeByClosedForm) {
  // Rings turn by a blend of 0 and theta. Matrices: the radius shrinks to |(1 - w) + w e^(i theta)|. Quaternions (and
  // centres on the axis): it stays.
  Limb limb = cylinder();
  const double theta = 150.0 * k_pi / 180.0;
  const std::vector<Transform> model = turned(Vec3::UnitY(), 150.0);
  for (const Skinning method : k_methods) {
    set_skinning(limb.skin, limb.mesh, method, "");
    const std::vector<Vec3> positions = skinned(limb.mesh, limb.skin, model);
    for (std::size_t v = 0; v < positions.size() - 2; ++v) {
      const double heavy = limb.skin.weights[4 * v], light = limb.skin.weights[4 * v + 1];
      const double kept = std::sqrt(heavy * heavy + light * light + 2.0 * heavy * light * std::cos(theta));
      const double radius = std::hypot(positions[v].x(), positions[v].z());
      EXPECT_NEAR(radius, method == Skinning::linear ? 0.04 * kept : 0.04, 1e-6);
      EXPECT_NEAR(positions[v].y(), limb.mesh.positions[v].y(), 1e-6);
    }
  }
}

TEST(SkinningMethods, DualQuaternionsBlendScrewsByTheFormula) {
  // Against dual quaternions written out as 2 x 4 numbers, with the point as one: q (1 + eps v) q* conjugated.
  std::mt19937_64 random(1);
  for (int round = 0; round < 300; ++round) {
    Limb limb;
    limb.skin.slot_joint = {0, 1, 2, 3};
    limb.skin.inverse_bind.assign(4, Eigen::Affine3d::Identity());
    limb.skin.slots = {0, 1, 2, 3};
    limb.skin.weights = {0.4f, 0.3f, 0.2f, 0.1f};
    limb.mesh.positions = {test::random_vector(random).cast<float>()};
    limb.mesh.normals = {Vec3f::UnitX()};
    std::vector<Transform> model;
    for (int j = 0; j < 4; ++j)
      model.push_back({nlerp(Quat::Identity(), test::random_rotation(random), 0.5), test::random_vector(random)});
    set_skinning(limb.skin, limb.mesh, Skinning::dual_quaternion, "");
    const Vec3 got = skinned(limb.mesh, limb.skin, model)[0];

    Eigen::Vector4d real = Eigen::Vector4d::Zero(), dual = real;
    for (int j = 0; j < 4; ++j) {
      const Quat& q = model[j].rotation;
      const Vec3& t = model[j].translation;
      const Quat half(-0.5 * (t.x() * q.x() + t.y() * q.y() + t.z() * q.z()),
                      0.5 * (t.x() * q.w() + t.y() * q.z() - t.z() * q.y()),
                      0.5 * (-t.x() * q.z() + t.y() * q.w() + t.z() * q.x()),
                      0.5 * (t.x() * q.y() - t.y() * q.x() + t.z() * q.w())); // [Kavan et al. 2007]
      const double w = limb.skin.weights[j] * (q.dot(model[0].rotation) < 0.0 ? -1.0 : 1.0);
      real += w * q.coeffs();
      dual += w * half.coeffs();
    }
    dual /= real.norm();
    real.normalize();
    const Vec3 v = limb.mesh.positions[0].cast<double>(), c = real.head<3>(), d = dual.head<3>();
    const Vec3 expected = v + 2.0 * c.cross(c.cross(v) + real.w() * v) +
                          2.0 * (real.w() * d - dual.w() * c + c.cross(d)); // the same, multiplied out
    EXPECT_LT((got - expected).norm(), 1e-12);
  }
}

TEST(SkinningMethods, CentresOfRotationAgainstTheSumWrittenOut) {
  Limb limb = cylinder(8, 30);
  set_skinning(limb.skin, limb.mesh, Skinning::centres_of_rotation, "");
  const auto weights = [&](std::uint32_t v) {
    Eigen::Vector2d w = Eigen::Vector2d::Zero();
    for (int k = 0; k < 4; ++k) w[limb.skin.slots[4 * v + k]] += limb.skin.weights[4 * v + k];
    return w;
  };
  int blended = 0;
  for (std::uint32_t v = 0; v < limb.mesh.positions.size(); ++v) {
    const Eigen::Vector2d w = weights(v);
    Vec3 sum = Vec3::Zero();
    double total = 0.0;
    for (const Triangle& t : limb.mesh.triangles) {
      const Vec3 a = limb.mesh.positions[t[0]].cast<double>(), b = limb.mesh.positions[t[1]].cast<double>(),
                 c = limb.mesh.positions[t[2]].cast<double>();
      const Eigen::Vector2d u = (weights(t[0]) + weights(t[1]) + weights(t[2])) / 3.0;
      double similarity = 0.0;
      for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 2; ++k)
          if (j != k)
            similarity += w[j] * w[k] * u[j] * u[k] * std::exp(-std::pow((w[j] * u[k] - w[k] * u[j]) / 0.1, 2));
      const double area = 0.5 * (b - a).cross(c - a).norm();
      sum += similarity * area * (a + b + c) / 3.0;
      total += similarity * area;
    }
    if (w.minCoeff() < 2e-3) continue; // one joint's alone: any centre will do
    ++blended;
    const Vec3 centre = limb.skin.centres[v].cast<double>();
    EXPECT_LT((centre - sum / total).norm(), 2e-5);      // weights below 0.001 are left out
    EXPECT_LT(std::hypot(centre.x(), centre.z()), 1e-6); // on the axis, as it must be for a tube
  }
  EXPECT_GT(blended, 30);
}

TEST(SkinningMethods, TheFloatsAgreeWithTheTwinInDouble) {
  std::mt19937_64 random(2);
  Limb limb = cylinder();
  const int vertices = limb.mesh.vertex_count();
  for (const Skinning method : {Skinning::dual_quaternion, Skinning::centres_of_rotation}) {
    set_skinning(limb.skin, limb.mesh, method, "");
    for (int round = 0; round < 10; ++round) {
      const std::vector<Transform> model = {{test::random_rotation(random), test::random_vector(random)},
                                            {test::random_rotation(random), test::random_vector(random)}};
      std::vector<SkinMatrix> palette(2);
      skinning_palette(limb.skin, model, palette);
      std::vector<Vec3f> p(vertices), n(vertices), part(vertices, Vec3f::Zero());
      skin_vertices(limb.mesh, limb.skin, palette, p, n);
      skin_vertices(limb.mesh, limb.skin, palette, 100, 200, part, {});
      std::vector<Vec3> pd(vertices), nd(vertices);
      skin_vertices_reference(limb.mesh, limb.skin, model, pd, nd);
      for (int v = 0; v < vertices; ++v) {
        EXPECT_LT((p[v].cast<double>() - pd[v]).norm(), 3e-6);
        EXPECT_LT((n[v].cast<double>() - nd[v]).norm(), 3e-6);
        EXPECT_EQ(part[v], v >= 100 && v < 200 ? p[v] : Vec3f(0, 0, 0));
      }
    }
  }
}

TEST(SkinningMethods, TheRestPoseGivesTheBindPose) {
  Limb limb = cylinder();
  for (const Skinning method : k_methods) {
    set_skinning(limb.skin, limb.mesh, method, "");
    const std::vector<Vec3> positions = skinned(limb.mesh, limb.skin, turned(Vec3::UnitY(), 0.0));
    for (std::size_t v = 0; v < positions.size(); ++v)
      EXPECT_LT((positions[v] - limb.mesh.positions[v].cast<double>()).norm(), 1e-7);
  }
}

TEST(SkinningMethods, BindsWithAScaleAreRefused) {
  Limb limb = cylinder();
  limb.skin.inverse_bind[1] = limb.skin.inverse_bind[1] * Eigen::Scaling(0.5);
  EXPECT_THROW(set_skinning(limb.skin, limb.mesh, Skinning::dual_quaternion, "x.dae"), InputError);
  EXPECT_NO_THROW(set_skinning(limb.skin, limb.mesh, Skinning::linear, "x.dae"));
}

TEST(SkinningMethods, VolumeOfABentAndATwistedTube) {
  // Of the 120 mm that are blended: loss in per cent of their volume.
  Limb limb = cylinder();
  const double blended = 0.24 * volume_of(limb.mesh.triangles, skinned(limb.mesh, limb.skin, turned(Vec3::UnitY(), 0)));
  const auto loss = [&](Skinning method, const Vec3& axis, double degrees) {
    set_skinning(limb.skin, limb.mesh, method, "");
    const double before = volume_of(limb.mesh.triangles, skinned(limb.mesh, limb.skin, turned(axis, 0.0)));
    return 100.0 * (before - volume_of(limb.mesh.triangles, skinned(limb.mesh, limb.skin, turned(axis, degrees)))) /
           blended;
  };
  std::printf("volume lost of the blended 120 mm of a tube, per cent: bent 90, 120, twisted 90, 150 degrees\n");
  double bent[3], twisted[3];
  for (int m = 0; m < 3; ++m) {
    const auto method = k_methods[m];
    bent[m] = loss(method, Vec3::UnitZ(), 90.0);
    twisted[m] = loss(method, Vec3::UnitY(), 150.0);
    std::printf("  %-20s %6.1f %6.1f %6.1f %6.1f\n", std::string(k_skinning_names[m]).c_str(), bent[m],
                loss(method, Vec3::UnitZ(), 120.0), loss(method, Vec3::UnitY(), 90.0), twisted[m]);
  }
  EXPECT_GT(twisted[0], 20.0); // the candy wrapper
  EXPECT_NEAR(twisted[1], 0.0, 1.0);
  EXPECT_NEAR(twisted[2], 0.0, 1.0);
  EXPECT_LT(std::abs(bent[2]), std::abs(bent[0]));
}

TEST(SkinningMethods, VolumeOfTheDancersElbowAndWrist) {
  Mannequin dancer = make_mannequin();
  const Skeleton& skeleton = dancer.skeleton;
  const int forearm = *skeleton.find("LeftForeArm"), hand = *skeleton.find("LeftHand");
  const std::vector<Transform> rest = rest_model(skeleton);
  // In model space: the bend about +Y (the hand comes forward), the twist about the forearm.
  const Vec3 along = (rest[hand].translation - rest[forearm].translation).normalized();
  const auto posed = [&](int joint, const Vec3& axis, double degrees) {
    std::vector<Transform> local = skeleton.rest_local, model(local.size());
    const Quat above = rest[skeleton.parents[joint]].rotation;
    local[joint].rotation =
        above.conjugate() * Quat(Eigen::AngleAxisd(degrees * k_pi / 180.0, axis)) * above * local[joint].rotation;
    model_from_local(skeleton, local, model);
    return model;
  };
  std::printf("volume the dancer loses, cm3: elbow bent by 90, 120, wrist twisted by 90 degrees\n");
  double elbow[3], wrist[3];
  for (int m = 0; m < 3; ++m) {
    set_skinning(dancer.surface_skin, dancer.surface, k_methods[m], "");
    const auto volume = [&](const std::vector<Transform>& model) {
      return 1e6 * volume_of(dancer.surface.triangles, skinned(dancer.surface, dancer.surface_skin, model));
    };
    const double before = volume(rest);
    elbow[m] = before - volume(posed(forearm, -Vec3::UnitY(), 90.0));
    wrist[m] = before - volume(posed(hand, along, 90.0));
    std::printf("  %-20s %6.1f %6.1f %6.1f\n", std::string(k_skinning_names[m]).c_str(), elbow[m],
                before - volume(posed(forearm, -Vec3::UnitY(), 120.0)), wrist[m]);
  }
  EXPECT_GT(wrist[0], 0.0);
  EXPECT_LT(std::abs(wrist[1]), 0.5 * wrist[0]);
  EXPECT_LT(std::abs(wrist[2]), 0.5 * wrist[0]);
}

} // namespace
