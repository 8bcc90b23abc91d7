#include "proxies/fit/detail/model.h"

#include "proxies/distance/closed_forms.h"
#include "rig/strong_poses.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace tutu::proxies::fit {
namespace {

constexpr double k_least_weight = 0.04; // of a joint under an end: less is noise that a person has to read
constexpr double k_mirror_tolerance =
    0.015; // of the height: joints of a pair, and skin, may miss their mirror image by that

Affine affine(const Transform& t) {
  Affine m;
  m.leftCols<3>() = t.rotation.toRotationMatrix();
  m.col(3) = t.translation;
  return m;
}

/// Whether the skin that hangs on a joint has skin where its mirror image is.
std::vector<bool> skin_is_mirrored(const std::vector<SkinPoint>& skin, int joints, double tolerance) {
  std::vector<double> off(joints, 0.0);
  std::vector<int> count(joints, 0);
  for (const SkinPoint& point : skin) {
    const Vec3 there = mirrored(point.rest);
    double least = std::numeric_limits<double>::infinity();
    for (const SkinPoint& other : skin) least = std::min(least, (other.rest - there).squaredNorm());
    off[point.main_joint] += std::sqrt(least);
    ++count[point.main_joint];
  }
  std::vector<bool> is(joints);
  for (int j = 0; j < joints; ++j) is[j] = count[j] == 0 || off[j] / count[j] <= tolerance;
  return is;
}

std::string base_name(const Proxy& proxy, const rig::Skeleton& skeleton) {
  // The joint that carries most of both ends.
  std::map<int, double> share;
  for (const Anchor* end : {&proxy.a, &proxy.b})
    for (int k = 0; k < end->count; ++k) share[end->joints[k]] += end->weights[k];
  int best = share.begin()->first;
  for (const auto& [joint, weight] : share)
    if (weight > share[best] + 1e-9) best = joint;
  return std::string(rig::bare_joint_name(skeleton.names[best]));
}

double in_hundredths_of_mm(double length) { return std::round(length * 1e5) / 1e5; }

Anchor anchor_of(const Vec3& rest_point, const EndSkin& skin, std::span<const Transform> rest) {
  const Vec3 rounded = (rest_point * 1e5).array().round() / 1e5;
  Anchor anchor;
  anchor.count = skin.count;
  for (int k = 0; k < skin.count; ++k) {
    anchor.joints[k] = skin.joints[k];
    anchor.weights[k] = skin.weights[k];
    anchor.points[k] = rest[skin.joints[k]].inverse() * rounded;
  }
  return anchor;
}

} // namespace

BodyMotion body_motion(const rig::Character& character, const std::vector<std::vector<Transform>>& poses,
                       bool symmetric, const std::vector<SkinPoint>& skin) {
  const rig::Skeleton& skeleton = character.skeleton;
  BodyMotion motion;
  motion.poses = static_cast<int>(poses.size());
  motion.joints = skeleton.joint_count();
  const std::vector<Transform> rest = rig::rest_model(skeleton);
  for (const auto& pose : poses)
    for (int j = 0; j < motion.joints; ++j) motion.model_from_rest.push_back(affine(pose[j] * rest[j].inverse()));

  std::vector<Vec3> positions(character.mesh.positions.size()), normals(positions.size());
  rig::skin_vertices_reference(character.mesh, character.skin, rest, positions, normals);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : positions) box.extend(p);
  motion.height = box.sizes().maxCoeff();
  for (const auto& [a, b, c] : character.mesh.triangles)
    motion.area += triangle_area(positions[a], positions[b], positions[c]);

  motion.mirror.assign(motion.joints, -1);
  if (!symmetric) return motion;
  // Samples themselves are never mirrored: half their spacing is no asymmetry.
  const double spacing = std::sqrt(motion.area / static_cast<double>(skin.size()));
  const double tolerance = k_mirror_tolerance * motion.height;
  const std::vector<bool> alike = skin_is_mirrored(skin, motion.joints, tolerance + 0.5 * spacing);
  for (int j = 0; j < motion.joints; ++j) {
    const std::string other = rig::name_on_other_side(skeleton.names[j]);
    const auto partner = other.empty() ? std::optional<int>(j) : skeleton.find(other);
    if (!partner || !alike[j] || !alike[*partner]) continue;
    if ((mirrored(rest[j].translation) - rest[*partner].translation).norm() <= 2.0 * tolerance)
      motion.mirror[j] = *partner;
  }
  return motion;
}

EndSkin mirrored(const EndSkin& skin, const BodyMotion& motion) {
  EndSkin other = skin;
  for (int k = 0; k < skin.count; ++k)
    if (motion.mirror[skin.joints[k]] >= 0) other.joints[k] = motion.mirror[skin.joints[k]];
  return other;
}

EndSkin end_skin(std::vector<double> weight_of_joint, const BodyMotion& motion, bool on_middle) {
  if (on_middle) {
    const std::vector<double> given = weight_of_joint;
    for (int j = 0; j < motion.joints; ++j)
      if (motion.mirror[j] >= 0) weight_of_joint[j] = 0.5 * (given[j] + given[motion.mirror[j]]);
  }
  std::vector<int> falling(weight_of_joint.size());
  std::iota(falling.begin(), falling.end(), 0);
  std::stable_sort(falling.begin(), falling.end(),
                   [&](int a, int b) { return weight_of_joint[a] > weight_of_joint[b]; });
  const double total = std::accumulate(weight_of_joint.begin(), weight_of_joint.end(), 0.0);
  EndSkin skin;
  for (const int j : falling) {
    if (skin.count > 0 && !(weight_of_joint[j] > k_least_weight * total)) break;
    const int other = on_middle ? motion.mirror[j] : j;
    if (other >= 0 && other < j && other != j) continue; // came with its partner
    const bool both = on_middle && other >= 0 && other != j;
    if (skin.count + (both ? 2 : 1) > 4) break;
    for (const int joint : both ? std::vector<int>{j, other} : std::vector<int>{j}) {
      skin.joints[skin.count] = joint;
      skin.weights[skin.count++] = weight_of_joint[j];
    }
  }
  // Thousandths that sum to 1 to the last bit that matters.
  const double kept = std::accumulate(skin.weights.begin(), skin.weights.begin() + skin.count, 0.0);
  if (!(kept > 0.0)) {
    skin.weights[0] = 1.0;
    return skin;
  }
  for (int k = 0; k < skin.count; ++k) skin.weights[k] = std::round(1000.0 * skin.weights[k] / kept) / 1000.0;
  const double sum = std::accumulate(skin.weights.begin(), skin.weights.begin() + skin.count, 0.0);
  for (int k = 0; k < skin.count; ++k) skin.weights[k] /= sum;
  return skin;
}

void Unit::settle(const BodyMotion& motion) {
  if (kind == UnitKind::middle) a.x() = b.x() = 0.0;
  if (kind == UnitKind::across) {
    radius_b = radius_a;
    b = mirrored(a);
    skin_b = fit::mirrored(skin_a, motion);
  }
  const int images = shapes();
  const std::size_t size = static_cast<std::size_t>(images) * motion.poses;
  frames_a.resize(size);
  frames_b.resize(size);
  for (int image = 0; image < images; ++image) {
    const EndSkin at_a = image ? fit::mirrored(skin_a, motion) : skin_a,
                  at_b = image ? fit::mirrored(skin_b, motion) : skin_b;
    for (int p = 0; p < motion.poses; ++p) {
      Affine &fa = frames_a[image * motion.poses + p], &fb = frames_b[image * motion.poses + p];
      fa.setZero();
      fb.setZero();
      for (int k = 0; k < at_a.count; ++k) fa += at_a.weights[k] * motion.at(p, at_a.joints[k]);
      for (int k = 0; k < at_b.count; ++k) fb += at_b.weights[k] * motion.at(p, at_b.joints[k]);
    }
  }
}

void PosedShapes::resize() {
  const std::size_t size = static_cast<std::size_t>(count) * poses;
  capsules.resize(size);
  for (std::vector<float>& v : arrays_) v.resize(size + k_lanes);
}

void PosedShapes::set(std::size_t i, const Capsule& capsule) {
  capsules[i] = capsule;
  Capsule shape = capsule;
  if (!((capsule.b - capsule.a).squaredNorm() > 1e-12)) shape.b = shape.a; // 1 um: one over its square in float
  const PlainCone c = round_cone(shape);
  const std::array<double, 10> values = {
      c.a.x(), c.a.y(), c.a.z(), c.axis.x(), c.axis.y(), c.axis.z(), c.per_axis_squared, c.radius, c.taper, c.lean};
  for (std::size_t k = 0; k < values.size(); ++k) arrays_[k][i] = static_cast<float>(values[k]);
}

ShapeArrays PosedShapes::arrays() const {
  const auto& v = arrays_;
  return {v[0].data(), v[1].data(), v[2].data(), v[3].data(), v[4].data(),
          v[5].data(), v[6].data(), v[7].data(), v[8].data(), v[9].data()};
}

void PosedShapes::place(std::span<const Unit> units, const BodyMotion& motion) {
  unit.clear();
  image.clear();
  for (int u = 0; u < static_cast<int>(units.size()); ++u)
    for (int k = 0; k < units[u].shapes(); ++k) {
      unit.push_back(u);
      image.push_back(static_cast<char>(k));
    }
  count = static_cast<int>(unit.size());
  poses = motion.poses;
  resize();
  for (int p = 0; p < poses; ++p)
    for (int s = 0; s < count; ++s) {
      const Unit& from = units[unit[s]];
      const std::size_t f = static_cast<std::size_t>(image[s]) * poses + p;
      const Vec3 ra = image[s] ? mirrored(from.a) : from.a, rb = image[s] ? mirrored(from.b) : from.b;
      set(at(p, s), {from.frames_a[f].leftCols<3>() * ra + from.frames_a[f].col(3),
                     from.frames_b[f].leftCols<3>() * rb + from.frames_b[f].col(3), from.radius_a,
                     from.radius_b - from.radius_a});
    }
}

std::vector<Proxy> proxies_of(std::span<const Unit> units, const BodyMotion& motion, const rig::Skeleton& skeleton) {
  const std::vector<Transform> rest = rig::rest_model(skeleton);
  std::vector<Proxy> proxies;
  std::map<std::string, int> used;
  for (const Unit& unit : units)
    for (int image = 0; image < unit.shapes(); ++image) {
      const Vec3 axis = unit.b - unit.a;
      const double radius_a = in_hundredths_of_mm(unit.radius_a), radius_b = in_hundredths_of_mm(unit.radius_b);
      Proxy proxy;
      // At rest one ball holds the other, or both are at one point.
      const bool is_sphere = axis.norm() <= std::max(2e-5, std::abs(radius_b - radius_a));
      const bool at_b = is_sphere && radius_b > radius_a;
      const auto anchor = [&](const Vec3& end, const EndSkin& skin) {
        return anchor_of(image ? mirrored(end) : end, image ? mirrored(skin, motion) : skin, rest);
      };
      proxy.kind = is_sphere ? ProxyKind::sphere : ProxyKind::capsule;
      proxy.a = at_b ? anchor(unit.b, unit.skin_b) : anchor(unit.a, unit.skin_a);
      proxy.b = is_sphere ? proxy.a : anchor(unit.b, unit.skin_b);
      proxy.radius = at_b ? radius_b : radius_a;
      proxy.taper = is_sphere ? 0.0 : radius_b - radius_a;
      const std::string name = base_name(proxy, skeleton);
      proxy.name = name + " " + std::to_string(++used[name]);
      proxies.push_back(proxy);
    }
  return proxies;
}

} // namespace tutu::proxies::fit
