#include "proxies/body/detail/mesh_tree.h"

#include "proxies/body/detail/solid_angle.h"
#include "proxies/body/point_triangle.h"
#include "proxies/distance/feature_contact.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_shape_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tutu::proxies {
namespace {

using Boxed = fcl::BVHModel<fcl::AABBd>;
using Node = fcl::BVNode<fcl::AABBd>;

/// Open ends of a descent: one a level, and FCL halves by the mean, so that a bad mesh can be deep.
constexpr int k_deepest = 512;
/// A probe has no plane when its area is below this share of its size squared: rounding would then lift its own corners
/// off the plane by more than 1e-10 of its size.
constexpr double k_no_plane = 1e-6;
constexpr double k_anywhere = std::numeric_limits<double>::infinity();

double distance_squared(const fcl::AABBd& box, const Vec3& point) {
  return (box.min_ - point).cwiseMax(point - box.max_).cwiseMax(0.0).squaredNorm();
}

int depth_below(const Boxed& boxes, int node) {
  std::vector<int> depth(boxes.getNumBVs(), 0);
  int deepest = 0;
  for (int i = node; i < boxes.getNumBVs(); ++i) { // children come after their parent
    deepest = std::max(deepest, depth[i]);
    if (!boxes.getBV(i).isLeaf()) depth[boxes.getBV(i).leftChild()] = depth[boxes.getBV(i).rightChild()] = depth[i] + 1;
  }
  return deepest;
}

fcl::Transform3d pose_of(const Capsule& capsule) {
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.linear() = rotation_between(Vec3::UnitZ(), capsule.b - capsule.a).toRotationMatrix();
  pose.translation() = 0.5 * (capsule.a + capsule.b);
  return pose;
}

} // namespace

TriangleProbe::TriangleProbe(const std::array<Vec3, 3>& corners)
    : low_(corners[0].cwiseMin(corners[1]).cwiseMin(corners[2])),
      high_(corners[0].cwiseMax(corners[1]).cwiseMax(corners[2])) {
  const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (!(area.norm() > k_no_plane * (high_ - low_).squaredNorm())) return;
  normal_ = area.normalized();
  level_ = normal_.dot(corners[0]);
}

double TriangleProbe::least_height(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const double at_a = normal_.dot(a) - level_, at_b = normal_.dot(b) - level_, at_c = normal_.dot(c) - level_;
  return std::max({std::min({at_a, at_b, at_c}), -std::max({at_a, at_b, at_c}), 0.0});
}

/// BVHModel<AABB>, for the others cannot be refitted quickly: RSS loses points bottom-up, and top-down takes 50 times
/// as long. FCL has no distance query for it, so the descents below are our own.
struct MeshTree::Boxes {
  Boxed model;
};

MeshTree::MeshTree(std::span<const Vec3> positions, std::span<const rig::Triangle> triangles)
    : positions_(positions), triangles_(triangles), boxes_(std::make_unique<Boxes>()) {
  std::vector<fcl::Triangle> indices;
  indices.reserve(triangles.size());
  for (const rig::Triangle& t : triangles) indices.emplace_back(t[0], t[1], t[2]);
  Boxed& model = boxes_->model;
  model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(positions.size()));
  model.addSubModel(std::vector<Vec3>(positions.begin(), positions.end()), indices);
  model.endModel();
  if (depth_below(model, 0) >= k_deepest) throw std::invalid_argument("body mesh: too many triangles in one place");
  find_dipoles();
}

MeshTree::~MeshTree() = default;

void MeshTree::refit(const std::vector<Vec3>& positions, bool with_dipoles) {
  Boxed& model = boxes_->model;
  model.beginReplaceModel();
  model.replaceSubModel(positions);
  model.endReplaceModel(true, true);
  positions_ = positions;
  if (with_dipoles) find_dipoles();
}

void MeshTree::find_dipoles() {
  const Boxed& model = boxes_->model;
  dipoles_.resize(model.getNumBVs());
  for (int i = model.getNumBVs() - 1; i >= 0; --i) { // children before their parent
    const Node& node = model.getBV(i);
    Dipole& dipole = dipoles_[i];
    dipole.first_child = node.first_child;
    if (node.isLeaf()) {
      const rig::Triangle& t = triangles_[node.primitiveId()];
      const Vec3 &a = positions_[t[0]], &b = positions_[t[1]], &c = positions_[t[2]];
      dipole.area = 0.5 * (b - a).cross(c - a);
      dipole.weight = dipole.area.norm();
      dipole.centre = (a + b + c) / 3.0;
    } else {
      const Dipole &left = dipoles_[node.leftChild()], &right = dipoles_[node.rightChild()];
      dipole.area = left.area + right.area;
      dipole.weight = left.weight + right.weight;
      dipole.centre = dipole.weight > 0.0
                          ? Vec3((left.weight * left.centre + right.weight * right.centre) / dipole.weight)
                          : left.centre;
    }
    dipole.radius_squared = (dipole.centre - node.bv.min_).cwiseMax(node.bv.max_ - dipole.centre).squaredNorm();
  }
}

std::optional<MeshPoint> MeshTree::nearest(const Vec3& point, double within, std::span<const std::uint8_t> skip) const {
  struct Open {
    int node;
    double distance_squared;
  };
  std::array<Open, k_deepest + 2> open;
  const Boxed& model = boxes_->model;
  int best = -1;
  double limit_squared = within * within;
  int count = 0;
  open[count++] = {0, distance_squared(model.getBV(0).bv, point)};
  while (count > 0) {
    const Open next = open[--count];
    if (!(next.distance_squared < limit_squared)) continue;
    const Node& node = model.getBV(next.node);
    if (!node.isLeaf()) {
      const int left = node.leftChild(), right = node.rightChild();
      const Open a = {left, distance_squared(model.getBV(left).bv, point)};
      const Open b = {right, distance_squared(model.getBV(right).bv, point)};
      const bool left_first = a.distance_squared <= b.distance_squared;
      open[count++] = left_first ? b : a;
      open[count++] = left_first ? a : b;
      continue;
    }
    const int triangle = node.primitiveId();
    if (!skip.empty() && skip[triangle]) continue;
    const rig::Triangle& t = triangles_[triangle];
    const Vec3 &a = positions_[t[0]], &b = positions_[t[1]], &c = positions_[t[2]];
    const OnTriangle on = nearest_place(point, a, b, c);
    const double here = (point - a - on.v * (b - a) - on.w * (c - a)).squaredNorm();
    if (!(here < limit_squared)) continue;
    limit_squared = here;
    best = triangle;
  }
  if (best < 0) return std::nullopt;
  const rig::Triangle& t = triangles_[best];
  MeshPoint found = nearest_on_triangle(point, positions_[t[0]], positions_[t[1]], positions_[t[2]]);
  found.triangle = best;
  return found;
}

double MeshTree::clearance(const TriangleProbe& probe, double enough, std::span<const std::uint8_t> skip) const {
  struct Open {
    int node;
    double distance;
  };
  std::array<Open, k_deepest + 2> open;
  const Boxed& model = boxes_->model;
  const auto opened = [&](int node) {
    const fcl::AABBd& box = model.getBV(node).bv;
    return Open{node, probe.least_distance(box.min_, box.max_)};
  };
  double least = k_anywhere;
  int count = 0;
  open[count++] = opened(0);
  while (count > 0) {
    const Open next = open[--count];
    if (next.distance >= least) continue;
    const Node& node = model.getBV(next.node);
    if (!node.isLeaf()) {
      const Open a = opened(node.leftChild()), b = opened(node.rightChild());
      const bool left_first = a.distance <= b.distance;
      open[count++] = left_first ? b : a;
      open[count++] = left_first ? a : b;
      continue;
    }
    if (!skip.empty() && skip[node.primitiveId()]) continue;
    const rig::Triangle& t = triangles_[node.primitiveId()];
    const double height = probe.least_height(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
    least = std::min(least, std::max(next.distance, height));
    if (least <= enough) return 0.0;
  }
  return least;
}

void MeshTree::around(const TriangleProbe& probe, double within, const std::function<void(int)>& visit) const {
  std::array<int, k_deepest + 2> open;
  const Boxed& model = boxes_->model;
  int count = 0;
  open[count++] = 0;
  while (count > 0) {
    const Node& node = model.getBV(open[--count]);
    if (probe.least_distance(node.bv.min_, node.bv.max_) > within) continue;
    if (node.isLeaf()) {
      visit(node.primitiveId());
      continue;
    }
    open[count++] = node.leftChild();
    open[count++] = node.rightChild();
  }
}

double MeshTree::winding_number(const Vec3& point, double beta) const {
  std::array<int, k_deepest + 2> open;
  const double near = beta * beta;
  double sum = 0.0;
  int count = 0;
  open[count++] = 0;
  while (count > 0) {
    const Dipole& dipole = dipoles_[open[--count]];
    const Vec3 to = dipole.centre - point;
    const double distance_squared = to.squaredNorm();
    if (distance_squared > near * dipole.radius_squared) {
      sum += dipole.area.dot(to) / (4.0 * M_PI * distance_squared * std::sqrt(distance_squared));
      continue;
    }
    if (dipole.first_child >= 0) {
      open[count++] = dipole.first_child;
      open[count++] = dipole.first_child + 1;
      continue;
    }
    const rig::Triangle& t = triangles_[-dipole.first_child - 1];
    sum += winding_of(point, positions_[t[0]], positions_[t[1]], positions_[t[2]]);
  }
  return sum;
}

bool MeshTree::box_holds(const Vec3& point) const { return boxes_->model.getBV(0).bv.contain(point); }

void MeshTree::touching(const Capsule& capsule, std::vector<int>& triangles) const {
  const fcl::Capsuled shape(capsule.widest(), (capsule.b - capsule.a).norm());
  // Yes or no for each triangle: depths and normals of this pair are those of whichever edge came last.
  const fcl::CollisionRequestd request(triangles_.size(), false);
  fcl::CollisionResultd result;
  // What fcl::collide does, less its copy of the whole model at each call, which is there for models that are not
  // posed by the identity.
  using Solver = fcl::detail::GJKSolver_libccd<double>;
  const Solver solver;
  fcl::detail::MeshShapeCollisionTraversalNode<fcl::AABBd, fcl::Capsuled, Solver> pair;
  fcl::Transform3d identity = fcl::Transform3d::Identity();
  fcl::detail::initialize(pair, boxes_->model, identity, shape, pose_of(capsule), &solver, request, result);
  fcl::detail::collide(&pair);
  const auto first = static_cast<std::ptrdiff_t>(triangles.size());
  for (std::size_t i = 0; i < result.numContacts(); ++i) triangles.push_back(static_cast<int>(result.getContact(i).b1));
  std::sort(triangles.begin() + first, triangles.end());
  if (capsule.taper == 0.0) return;
  // FCL was asked for the capsule around the cone, having none.
  const auto misses = [&](int triangle) {
    const auto& [p, q, r] = triangles_[triangle];
    return triangle_contact(positions_[p], positions_[q], positions_[r], capsule, Vec3::Zero()).distance > 0.0;
  };
  triangles.erase(std::remove_if(triangles.begin() + first, triangles.end(), misses), triangles.end());
}

} // namespace tutu::proxies
