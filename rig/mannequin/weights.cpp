#include "rig/mannequin/detail/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

namespace tutu::rig {
namespace {

constexpr int k_influences = 4;
constexpr int k_smoothing_rounds = 6;
constexpr int k_weight_steps = 100000; ///< weights are multiples of 1 / k_weight_steps, so that they are short to write

/// 0 below -1, 1 above 1, smooth between.
double step(double s) {
  const double t = std::clamp(0.5 * (s + 1.0), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Where weight passes from a joint's parent to the joint: across a plane through the joint, within `width` to either
/// side.
struct Cut {
  Vec3 joint, normal;
  double width;

  double beyond(const Vec3& p) const { return step((p - joint).dot(normal) / width); }
};

/// Weights of one vertex on all joints.
class Weigher {
public:
  explicit Weigher(const Skeleton& skeleton) : rest_(rest_model(skeleton)) {
    for (int j = 0; j < skeleton.joint_count(); ++j) joints_.emplace(bare_joint_name(skeleton.names[j]), j);
  }

  /// Of a point of the left half.
  std::vector<double> operator()(const Vec3& p) const {
    std::vector<double> weights(rest_.size(), 0.0);
    std::array<double, k_chain_count> d;
    for (int i = 0; i < k_chain_count; ++i) d[i] = chain_distance(static_cast<BodyChain>(i), p);
    const auto of = [&](BodyChain limb) { return d[static_cast<int>(limb)]; };

    double fingers = of(BodyChain::thumb);
    for (int i = static_cast<int>(BodyChain::thumb); i < k_chain_count; ++i) fingers = std::min(fingers, d[i]);
    const double arm = std::min(of(BodyChain::arm), fingers), trunk = of(BodyChain::trunk);

    // Soft where the volumes blend into each other, none where the limb is merely near.
    const double on_arm = 1.0 - step(2.0 * (arm - trunk) / 0.030 - 1.0);
    const double on_leg =
        (1.0 - step(2.0 * (of(BodyChain::leg) - trunk) / 0.060 - 1.0)) * (trunk < arm ? 1.0 : 1.0 - on_arm);

    const double raised = on_arm * cut("LeftArm", {0.93, -0.36, 0.0}, 0.068).beyond(p);
    // The legs share only the crotch; below it the thighs are close, but apart.
    const double left = step(p.x() / (0.001 + 0.024 * step((p.y() - 0.810) / 0.035)));
    // Between them the skin belongs to the pelvis, or it would be drawn along when both knees open.
    const double between = 0.75 * step((p.y() - 0.780) / 0.020) * (1.0 - step((p.x() - 0.024) / 0.024));
    const double off_trunk = (1.0 - raised) * on_leg * (1.0 - between);
    const Vec3 q(-p.x(), p.y(), p.z());
    const Cut hip = cut("LeftUpLeg", {0.45, -0.89, 0.0}, 0.070);
    const double left_leg = off_trunk * left * hip.beyond(p);
    const double right_leg = off_trunk * (1.0 - left) * hip.beyond(q);

    weigh_arm(p, raised, d, weights);
    weigh_leg(p, left_leg, "Left", weights);
    weigh_leg(q, right_leg, "Right", weights);
    weigh_trunk(p, 1.0 - raised - left_leg - right_leg, weights);
    return weights;
  }

private:
  int joint(std::string_view name) const { return joints_.find(name)->second; }
  Vec3 place(std::string_view name) const { return rest_[joint(name)].translation; }
  Cut cut(std::string_view name, const Vec3& normal, double width) const {
    return {place(name), normal.normalized(), width};
  }
  /// Across the bone that ends in `name` and the one that goes on to `next`, halfway between their directions.
  Cut bend(std::string_view parent, std::string_view name, std::string_view next, double width) const {
    const Vec3 in = (place(name) - place(parent)).normalized(), out = (place(next) - place(name)).normalized();
    return cut(name, in + out, width);
  }

  void weigh_trunk(const Vec3& p, double share, std::vector<double>& weights) const {
    const Vec3 up = Vec3::UnitY();
    const double spine = cut("Spine", up, 0.060).beyond(p), spine1 = cut("Spine1", up, 0.060).beyond(p);
    const double spine2 = cut("Spine2", up, 0.060).beyond(p), neck = cut("Neck", {0.0, 1.0, 0.25}, 0.040).beyond(p);
    const double head = cut("Head", {0.0, 0.85, 0.50}, 0.028).beyond(p);
    const double shoulder = 0.85 * step((p.x() - 0.085) / 0.060) * step((p.y() - 1.325) / 0.060) * (1.0 - neck);
    weights[joint("Hips")] += share * (1.0 - spine);
    weights[joint("Spine")] += share * spine * (1.0 - spine1);
    weights[joint("Spine1")] += share * spine * spine1 * (1.0 - spine2);
    const double chest = share * spine * spine1 * spine2;
    weights[joint("LeftShoulder")] += chest * shoulder;
    weights[joint("Spine2")] += chest * (1.0 - shoulder) * (1.0 - neck);
    weights[joint("Neck")] += chest * (1.0 - shoulder) * neck * (1.0 - head);
    weights[joint("Head")] += chest * (1.0 - shoulder) * neck * head;
  }

  /// `p` mirrored to the left half.
  void weigh_leg(const Vec3& p, double share, const std::string& side, std::vector<double>& weights) const {
    const double shin = bend("LeftUpLeg", "LeftLeg", "LeftFoot", 0.055).beyond(p);
    const double foot = cut("LeftFoot", {0.0, -1.0, 0.25}, 0.032).beyond(p);
    const double toes = cut("LeftToeBase", {0.0, 0.0, 1.0}, 0.022).beyond(p);
    weights[joint(side + "UpLeg")] += share * (1.0 - shin);
    weights[joint(side + "Leg")] += share * shin * (1.0 - foot);
    weights[joint(side + "Foot")] += share * shin * foot * (1.0 - toes);
    weights[joint(side + "ToeBase")] += share * shin * foot * toes;
  }

  void weigh_arm(const Vec3& p, double share, const std::array<double, k_chain_count>& d,
                 std::vector<double>& weights) const {
    const double forearm = bend("LeftArm", "LeftForeArm", "LeftHand", 0.042).beyond(p);
    const double hand = bend("LeftForeArm", "LeftHand", "LeftHandMiddle1", 0.026).beyond(p);
    weights[joint("LeftArm")] += share * (1.0 - forearm);
    weights[joint("LeftForeArm")] += share * forearm * (1.0 - hand);
    double palm = share * forearm * hand;
    const double held = palm;

    constexpr std::array<std::string_view, 5> k_names = {"Thumb", "Index", "Middle", "Ring", "Pinky"};
    const int first = static_cast<int>(BodyChain::thumb);
    for (int f = 0; f < 5; ++f) {
      double others = 1.0;
      for (int g = 0; g < 5; ++g)
        if (g != f) others = std::min(others, d[first + g]);
      const double mine = step((others - d[first + f]) / 0.004);
      if (mine == 0.0) continue;
      const double of_finger = 1.0 - step(2.0 * (d[first + f] - d[static_cast<int>(BodyChain::arm)]) / 0.010 - 1.0);
      const std::string name = "LeftHand" + std::string(k_names[f]);
      const double w1 = bend("LeftHand", name + "1", name + "2", f == 0 ? 0.014 : 0.010).beyond(p);
      const double w2 = bend(name + "1", name + "2", name + "3", 0.008).beyond(p);
      const double w3 = cut(name + "3", place(name + "3") - place(name + "2"), 0.007).beyond(p);
      const double all = held * mine * of_finger * w1;
      weights[joint(name + "1")] += all * (1.0 - w2);
      weights[joint(name + "2")] += all * w2 * (1.0 - w3);
      weights[joint(name + "3")] += all * w2 * w3;
      palm -= all;
    }
    weights[joint("LeftHand")] += std::max(palm, 0.0);
  }

  std::map<std::string, int, std::less<>> joints_; ///< by bare name
  std::vector<Transform> rest_;
};

std::vector<int> other_side(const Skeleton& skeleton) {
  std::vector<int> other(skeleton.joint_count());
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    std::string name(bare_joint_name(skeleton.names[j]));
    if (name.starts_with("Left")) name = "Right" + name.substr(4);
    else if (name.starts_with("Right")) name = "Left" + name.substr(5);
    other[j] = *skeleton.find(name);
  }
  return other;
}

using Rows = std::vector<std::vector<double>>; ///< [vertex][joint]

/// Every vertex halfway to the mean of its neighbours, along the surface: nothing crosses from finger to finger.
void smooth(Rows& rows, const std::vector<Triangle>& triangles) {
  Rows sums(rows.size(), std::vector<double>(rows[0].size(), 0.0));
  std::vector<double> counts(rows.size(), 0.0);
  for (const Triangle& t : triangles) {
    for (int c = 0; c < 3; ++c) { // a closed surface has each edge twice, once in each direction
      const auto from = t[c], to = t[(c + 1) % 3];
      counts[to] += 1.0;
      for (std::size_t j = 0; j < rows[from].size(); ++j) sums[to][j] += rows[from][j];
    }
  }
  for (std::size_t v = 0; v < rows.size(); ++v)
    for (std::size_t j = 0; j < rows[v].size(); ++j) rows[v][j] = 0.5 * rows[v][j] + 0.5 * sums[v][j] / counts[v];
}

/// The largest few, as multiples of 1 / k_weight_steps that sum to 1.
void keep_largest(const std::vector<double>& row, std::uint16_t* slots, float* weights) {
  constexpr double k_least = 0.005; // less cannot be seen, and costs as much as more
  std::vector<int> order(row.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return row[a] > row[b]; });
  double sum = 0.0;
  int count = 0;
  while (count < k_influences && row[order[count]] > k_least) sum += row[order[count++]];
  std::array<std::pair<int, int>, k_influences> kept = {}; // steps, joint
  int left = k_weight_steps;
  for (int k = 1; k < count; ++k) {
    kept[k] = {static_cast<int>(row[order[k]] / sum * k_weight_steps + 0.5), order[k]};
    left -= kept[k].first;
  }
  kept[0] = {left, order[0]};
  std::stable_sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (int k = 0; k < k_influences; ++k) {
    slots[k] = static_cast<std::uint16_t>(kept[k].second);
    weights[k] = static_cast<float>(kept[k].first / static_cast<double>(k_weight_steps));
  }
}

} // namespace

Skin mannequin_skin(const Skeleton& skeleton, const Mesh& surface, const std::vector<std::uint32_t>& mirrored) {
  const Weigher weigh(skeleton);
  const std::vector<int> other = other_side(skeleton);
  const auto swapped = [&](const std::vector<double>& row) {
    std::vector<double> result(row.size());
    for (std::size_t j = 0; j < row.size(); ++j) result[other[j]] = row[j];
    return result;
  };

  Rows rows(surface.positions.size());
  for (std::size_t v = 0; v < rows.size(); ++v) {
    const Vec3 p = surface.positions[v].cast<double>();
    rows[v] = p.x() >= 0.0 ? weigh(p) : swapped(weigh({-p.x(), p.y(), p.z()}));
  }
  for (int round = 0; round < k_smoothing_rounds; ++round) smooth(rows, surface.triangles);
  for (std::size_t v = 0; v < rows.size(); ++v) { // sums in another order differ in their last bits
    const std::size_t m = mirrored[v];
    if (m > v) rows[m] = swapped(rows[v]);
    if (m != v) continue;
    const std::vector<double> mirror = swapped(rows[v]);
    for (std::size_t j = 0; j < mirror.size(); ++j) rows[v][j] = 0.5 * (rows[v][j] + mirror[j]);
  }

  Skin skin;
  skin.influences = k_influences;
  for (int j = 0; j < skeleton.joint_count(); ++j) skin.slot_joint.push_back(j);
  for (const Transform& joint : rest_model(skeleton))
    skin.inverse_bind.emplace_back(Eigen::Translation3d(-joint.translation));
  skin.slots.resize(rows.size() * k_influences);
  skin.weights.resize(rows.size() * k_influences);
  for (std::size_t v = 0; v < rows.size(); ++v)
    keep_largest(rows[v], &skin.slots[v * k_influences], &skin.weights[v * k_influences]);
  return skin;
}

} // namespace tutu::rig
