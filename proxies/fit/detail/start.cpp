#include "proxies/fit/detail/start.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

namespace tutu::proxies::fit {
namespace {

constexpr double k_least_share = 0.008; // of all samples, for a joint to start with a shape of its own
constexpr double k_pull = 0.8;          // of the radius, along the normals towards the axis
constexpr double k_half_length = 1.2;   // standard deviations
constexpr double k_least_radius = 0.005, k_most_radius = 0.25; // m

struct Spread {
  Vec3 mean = Vec3::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Of points moved by -pull along their normals; with their mirror images where `fold`.
Spread spread(std::span<const UnitPoint> points, double pull, bool fold) {
  Spread result;
  double total = 0.0;
  for (const UnitPoint& p : points) {
    result.mean += p.weight * (p.rest - pull * p.normal);
    total += p.weight;
  }
  result.mean /= total;
  if (fold) result.mean.x() = 0.0;
  for (const UnitPoint& p : points) {
    const Vec3 off = p.rest - pull * p.normal - result.mean;
    result.covariance += p.weight / total * off * off.transpose();
  }
  if (fold)
    for (int k : {1, 2}) result.covariance(0, k) = result.covariance(k, 0) = 0.0;
  return result;
}

} // namespace

UnitPoint unit_point(const SkinPoint& point, bool fold, const BodyMotion& motion) {
  UnitPoint result;
  result.rest = fold ? mirrored(point.rest) : point.rest;
  result.normal = fold ? mirrored(point.normal) : point.normal;
  result.joints = point.joints;
  result.weights = point.weights;
  if (fold)
    for (int& joint : result.joints)
      if (motion.mirror[joint] >= 0) joint = motion.mirror[joint];
  return result;
}

Unit capsule_through(std::span<const UnitPoint> points, UnitKind kind, bool tapered, const BodyMotion& motion) {
  const bool fold = kind == UnitKind::middle || kind == UnitKind::across;
  // Of a tube's skin the variance across is r^2 / 2 each way.
  const Spread outer = spread(points, 0.0, fold);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(outer.covariance);
  const double radius = std::clamp(std::sqrt(std::max(0.0, solver.eigenvalues()[0] + solver.eigenvalues()[1])),
                                   k_least_radius, k_most_radius);
  const Spread inner = spread(points, k_pull * radius, fold);
  solver.compute(inner.covariance);
  Vec3 axis = solver.eigenvectors().col(2);
  double half = k_half_length * std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
  if (fold && kind == UnitKind::middle) {
    // Eigenvectors of a covariance without x-y and x-z are x and two in the plane.
    if (std::abs(axis.x()) > 0.5) kind = UnitKind::across;
  } else if (kind == UnitKind::across) {
    axis = Vec3::UnitX();
    half = k_half_length * std::sqrt(std::max(0.0, inner.covariance(0, 0)));
  }
  if (kind == UnitKind::across && axis.x() < 0.0) axis = -axis;
  if (kind != UnitKind::across) { // a sign that does not hang on the solver
    int most = 0;
    axis.cwiseAbs().maxCoeff(&most);
    if (axis[most] > 0.0) axis = -axis;
  }
  Unit unit;
  unit.kind = kind;
  unit.tapered = tapered;
  unit.a = inner.mean + half * axis;
  unit.b = inner.mean - half * axis;
  unit.radius_a = unit.radius_b = radius;
  take_skins(unit, points, motion);
  unit.settle(motion);
  return unit;
}

void take_skins(Unit& unit, std::span<const UnitPoint> points, const BodyMotion& motion) {
  std::vector<double> at_a(motion.joints, 0.0), at_b(motion.joints, 0.0);
  const Vec3 axis = unit.b - unit.a;
  const double squared = axis.squaredNorm();
  for (const UnitPoint& p : points) {
    double t = squared > 1e-12 ? std::clamp((p.rest - unit.a).dot(axis) / squared, 0.0, 1.0) : 0.5;
    if (unit.kind == UnitKind::across) t = 0.0; // folded: all are on a's side
    for (int k = 0; k < 4; ++k) {
      at_a[p.joints[k]] += p.weight * (1.0 - t) * (1.0 - t) * static_cast<double>(p.weights[k]);
      at_b[p.joints[k]] += p.weight * t * t * static_cast<double>(p.weights[k]);
    }
  }
  const auto sum = [](const std::vector<double>& v) {
    double total = 0.0;
    for (const double x : v) total += x;
    return total;
  };
  // An end that no point is near keeps the skin it has, or takes the other's.
  const bool middle = unit.kind == UnitKind::middle;
  const bool has_a = sum(at_a) > 0.0, has_b = sum(at_b) > 0.0;
  if (has_a) unit.skin_a = end_skin(at_a, motion, middle);
  if (has_b) unit.skin_b = end_skin(at_b, motion, middle);
  if (!has_a && unit.skin_a.count == 0) unit.skin_a = unit.skin_b;
  if (!has_b && unit.skin_b.count == 0) unit.skin_b = unit.skin_a;
}

std::vector<Unit> first_layout(const std::vector<SkinPoint>& skin, const BodyMotion& motion,
                               const rig::Skeleton& skeleton, bool tapered) {
  // Owners: small joints hand their points to the joint above, from the leaves up; what has no joint above keeps them.
  std::vector<int> owned(motion.joints, 0), owner(motion.joints);
  for (const SkinPoint& p : skin) ++owned[p.main_joint];
  const auto least = static_cast<int>(std::ceil(k_least_share * static_cast<double>(skin.size())));
  for (int j = 0; j < motion.joints; ++j) owner[j] = j;
  for (int j = motion.joints - 1; j >= 0; --j) {
    const int parent = skeleton.parents[j];
    if (owned[j] == 0 || owned[j] >= least || parent == rig::k_no_parent) continue;
    owned[parent] += owned[j];
    owned[j] = 0;
    owner[j] = parent;
  }
  const auto final_owner = [&](int j) {
    while (owner[j] != j) j = owner[j];
    return j;
  };
  std::map<int, std::vector<UnitPoint>> groups; // by joint; of a pair by the joint with the smaller index
  for (const SkinPoint& p : skin) {
    const int joint = final_owner(p.main_joint), other = motion.mirror[joint];
    const bool fold = other >= 0 && other < joint;
    UnitPoint point = unit_point(p, fold, motion);
    point.weight = 1.0;
    groups[fold ? other : joint].push_back(point);
  }
  std::vector<Unit> units;
  for (auto& [joint, points] : groups) {
    const int other = motion.mirror[joint];
    UnitKind kind = other < 0 ? UnitKind::one : other == joint ? UnitKind::middle : UnitKind::pair;
    if (kind == UnitKind::middle)
      for (UnitPoint& p : points) {
        if (p.rest.x() >= 0.0) continue;
        p.rest = mirrored(p.rest);
        p.normal = mirrored(p.normal);
        for (int& j : p.joints)
          if (motion.mirror[j] >= 0) j = motion.mirror[j];
      }
    units.push_back(capsule_through(points, kind, tapered, motion));
  }
  return units;
}

} // namespace tutu::proxies::fit
