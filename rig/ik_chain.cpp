#include "rig/detail/ik_chain.h"

#include <cassert>
#include <cmath>
#include <vector>

namespace tutu::rig {
namespace {

using ik_detail::apply_limit;
using ik_detail::turn_in_model;

class Chain {
public:
  Chain(const Skeleton& skeleton, std::span<Transform> local, std::span<const int> joints,
        std::span<const JointLimit> limits)
      : skeleton_(skeleton), local_(local), joints_(joints), limits_(limits), points_(joints.size()) {
    read_points();
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) lengths_.push_back((points_[i + 1] - points_[i]).norm());
  }

  double reach() const {
    double sum = 0.0;
    for (const double length : lengths_) sum += length;
    return sum;
  }
  const Vec3& root() const { return points_.front(); }
  double error(const Vec3& target) const { return (points_.back() - target).norm(); }

  /// Is every joint on the line from root to target? Then no pass of FABRIK would ever leave it.
  bool is_straight_towards(const Vec3& target) const {
    constexpr double k_least_offset = 1e-6; // of the chain's length
    const Vec3 along = (target - root()).normalized();
    for (const Vec3& point : points_)
      if ((point - root()).cross(along).norm() > k_least_offset * reach()) return false;
    return true;
  }

  /// Moves the inner points off the line, alternately not: one bow.
  void bow(const Vec3& along, const Vec3& bend) {
    constexpr double k_bow = 0.1; // of the chain's length: anything that is clearly a side will do
    Vec3 side = bend - bend.dot(along) * along;
    side = side.norm() > 1e-6 * bend.norm() ? Vec3(side.normalized()) : Vec3(along.unitOrthogonal());
    const double last = static_cast<double>(points_.size() - 1);
    for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
      const double u = static_cast<double>(i) / last;
      points_[i] += side * (4.0 * u * (1.0 - u) * k_bow * reach());
    }
    turn_to_points();
  }

  void stretch(const Vec3& along) {
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) points_[i + 1] = points_[i] + lengths_[i] * along;
    turn_to_points();
  }

  void iterate(const Vec3& target) {
    points_.back() = target;
    for (std::size_t i = points_.size() - 1; i-- > 0;)
      points_[i] = points_[i + 1] + lengths_[i] * direction(points_[i + 1], points_[i]);
    turn_to_points();
  }

  /// From the end up, each joint turns so that the end comes as near to the target as this joint alone can bring it.
  void descend(const Vec3& target) {
    for (std::size_t i = joints_.size() - 1; i-- > 0;) {
      const Vec3 start = model_of_joint(skeleton_, local_, joints_[i]).translation;
      const Vec3 end = model_of_joint(skeleton_, local_, joints_.back()).translation;
      turn_in_model(skeleton_, local_, joints_[i], rotation_between(end - start, target - start));
      apply_limit(skeleton_, local_, joints_[i], limits_);
    }
    read_points();
  }

private:
  static Vec3 direction(const Vec3& from, const Vec3& to) {
    const double length = (to - from).norm();
    return length > 0.0 ? Vec3((to - from) / length) : Vec3(Vec3::UnitY());
  }

  /// The forward pass: from the root on, each bone is turned towards where its lower end should be, and ends where its
  /// length and its limits let it.
  void turn_to_points() {
    for (std::size_t i = 0; i + 1 < joints_.size(); ++i) {
      const Vec3 start = model_of_joint(skeleton_, local_, joints_[i]).translation;
      const Vec3 end = model_of_joint(skeleton_, local_, joints_[i + 1]).translation;
      turn_in_model(skeleton_, local_, joints_[i], rotation_between(end - start, points_[i + 1] - start));
      apply_limit(skeleton_, local_, joints_[i], limits_);
    }
    read_points();
  }

  void read_points() {
    for (std::size_t i = 0; i < joints_.size(); ++i)
      points_[i] = model_of_joint(skeleton_, local_, joints_[i]).translation;
  }

  const Skeleton& skeleton_;
  std::span<Transform> local_;
  std::span<const int> joints_;
  std::span<const JointLimit> limits_;
  std::vector<Vec3> points_; ///< model space, root to end
  std::vector<double> lengths_;
};

} // namespace

double solve_chain(const Skeleton& skeleton, std::span<Transform> local, std::span<const int> joints,
                   const Vec3& target, std::span<const JointLimit> limits, const ChainOptions& options) {
  assert(joints.size() >= 2);
  Chain chain(skeleton, local, joints, limits);
  double best = chain.error(target);
  if (best <= options.tolerance) return best;
  const Vec3 way = target - chain.root();
  if (!(way.norm() > 0.0) && joints.size() == 2) return best; // one bone cannot come back to its root

  std::vector<Quat> rotations(joints.size());
  const auto keep = [&] {
    for (std::size_t i = 0; i < joints.size(); ++i) rotations[i] = local[joints[i]].rotation;
  };
  keep();
  const bool out_of_reach = way.norm() >= chain.reach();
  const Vec3 along = way.norm() > 0.0 ? Vec3(way.normalized()) : Vec3(Vec3::UnitY());
  if (!out_of_reach && chain.is_straight_towards(target)) chain.bow(along, options.bend);
  for (int iteration = 0; iteration < options.most_iterations && best > options.tolerance; ++iteration) {
    if (out_of_reach && iteration == 0) chain.stretch(along);
    else if (out_of_reach && limits.empty()) break;
    else if (limits.empty()) chain.iterate(target);
    else chain.descend(target);
    if (const double error = chain.error(target); error < best) {
      best = error;
      keep();
    }
  }
  for (std::size_t i = 0; i < joints.size(); ++i) local[joints[i]].rotation = rotations[i];
  return best;
}

} // namespace tutu::rig
