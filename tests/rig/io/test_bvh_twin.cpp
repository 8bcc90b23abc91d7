// The twin of read_bvh(): forward kinematics of BVH straight from the format's description, by 4x4 matrices in double:
// the product of a joint's channels from left to right, a position in the place of the offset's component.
#include "rig/io/bvh.h"
#include "rig/io/file_io.h"
#include "tests/support/paths.h"

#include <array>
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

using namespace tutu;
using namespace tutu::rig;

namespace {

struct Joint {
  int parent;
  Vec3 offset;
  std::vector<int> channels; ///< 0 to 2 positions along x y z, 3 to 5 rotations about them, degrees
  std::optional<Vec3> end;
};

struct Take {
  std::vector<Joint> joints; ///< in the order of the file: depth first
  std::vector<std::vector<double>> frames;
};

Vec3 random_vector(std::mt19937_64& random, double most) {
  std::uniform_real_distribution<double> any(-most, most);
  return {any(random), any(random), any(random)};
}

/// A skeleton of no body's shape, in a unit of any size: chains, branches, joints without channels, with any rotations
/// in any order (one axis twice, too), and with some or all positions.
Take random_take(std::mt19937_64& random) {
  Take take;
  const double unit = std::pow(10.0, std::uniform_real_distribution<double>(-2.0, 3.0)(random));
  const int joints = std::uniform_int_distribution<int>(2, 25)(random);
  for (int j = 0; j < joints; ++j) {
    Joint joint;
    // The parent is among the joints that are still open: the last and those above it.
    joint.parent = j - 1;
    while (joint.parent > 0 && random() % 3 == 0) joint.parent = take.joints[joint.parent].parent;
    joint.offset = random_vector(random, unit) + Vec3(0, unit, 0);
    std::vector<int> channels;
    if (j == 0 || random() % 3 == 0)
      for (int axis = 0; axis < 3; ++axis)
        if (j == 0 || random() % 4 != 0) channels.push_back(axis);
    std::vector<int> turns = {3, 4, 5};
    std::ranges::shuffle(turns, random);
    if (random() % 5 == 0) turns[2] = turns[0];
    turns.resize(j > 0 && random() % 4 == 0 ? random() % 3 : 3);
    channels.insert(channels.end(), turns.begin(), turns.end());
    if (random() % 4 == 0) std::ranges::shuffle(channels, random); // positions between the rotations
    joint.channels = channels;
    if (random() % 2) joint.end = random_vector(random, unit);
    take.joints.push_back(joint);
  }
  for (int k = 0; k < 12; ++k) {
    auto& frame = take.frames.emplace_back();
    for (const Joint& joint : take.joints)
      for (const int channel : joint.channels)
        frame.push_back(std::uniform_real_distribution<double>(-1, 1)(random) * (channel < 3 ? 5 * unit : 400.0));
  }
  return take;
}

std::string number(double value) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.17g ", value);
  return text.data();
}

std::string text_of(const Take& take) {
  static constexpr const char* k_names[] = {"Xposition", "Yposition", "Zposition",
                                            "Xrotation", "Yrotation", "Zrotation"};
  std::string text = "HIERARCHY\n";
  std::vector<int> open;
  for (int j = 0; j < static_cast<int>(take.joints.size()); ++j) {
    const Joint& joint = take.joints[j];
    for (; !open.empty() && open.back() != joint.parent; open.pop_back()) text += "}\n";
    text += (j == 0 ? "ROOT j" : "JOINT j") + std::to_string(j) + "\n{\nOFFSET ";
    for (const double x : joint.offset) text += number(x);
    text += "\nCHANNELS " + std::to_string(joint.channels.size());
    for (const int channel : joint.channels) text += std::string(" ") + k_names[channel];
    text += "\n";
    if (joint.end) {
      text += "End Site\n{\nOFFSET ";
      for (const double x : *joint.end) text += number(x);
      text += "\n}\n";
    }
    open.push_back(j);
  }
  for (; !open.empty(); open.pop_back()) text += "}\n";
  text += "MOTION\nFrames: " + std::to_string(take.frames.size()) + "\nFrame Time: 0.033333\n";
  for (const auto& frame : take.frames) {
    for (const double value : frame) text += number(value);
    text += "\n";
  }
  return text;
}

/// world_from_joint of a frame, by the description and nothing else.
std::vector<Eigen::Matrix4d> twin(const Take& take, int k) {
  std::vector<Eigen::Matrix4d> world;
  std::size_t next = 0;
  for (const Joint& joint : take.joints) {
    Eigen::Matrix4d translation = Eigen::Matrix4d::Identity(), rotation = Eigen::Matrix4d::Identity();
    translation.topRightCorner<3, 1>() = joint.offset;
    for (const int channel : joint.channels) {
      const double value = take.frames[k][next++];
      if (channel < 3) {
        translation(channel, 3) = value;
        continue;
      }
      const double a = value * std::numbers::pi / 180.0, c = std::cos(a), s = std::sin(a);
      const int u = (channel - 3 + 1) % 3, v = (channel - 3 + 2) % 3;
      Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
      turn(u, u) = c;
      turn(u, v) = -s;
      turn(v, u) = s;
      turn(v, v) = c;
      rotation *= turn;
    }
    const Eigen::Matrix4d local = translation * rotation;
    world.push_back(joint.parent < 0 ? local : Eigen::Matrix4d(world[joint.parent] * local));
  }
  return world;
}

TEST(BvhTwin, EveryJointIsWhereTheDescriptionPutsIt) {
  std::mt19937_64 random(15);
  const std::filesystem::path folder = test::scratch_folder(), file = folder / "take.bvh";
  double worst = 0.0;
  int compared = 0;
  for (int round = 0; round < 60; ++round) {
    const Take take = random_take(random);
    write_file(file, text_of(take));
    const Mocap mocap = read_bvh(file, {.rest_frame = 3, .from = 0.0, .to = {}});
    ASSERT_TRUE(mocap.notes.empty());
    ASSERT_EQ(mocap.clip.times.size(), take.frames.size());
    // The unit: by the height of the frame that is the rest pose, ends included.
    double lowest = 1e300, highest = -1e300;
    const auto rest = twin(take, 3);
    for (std::size_t j = 0; j < take.joints.size(); ++j) {
      const Vec3 end = take.joints[j].end.value_or(Vec3::Zero());
      for (const Vec3& point : {Vec3(Vec3::Zero()), end}) {
        const double y = (rest[j] * point.homogeneous())(1);
        lowest = std::min(lowest, y);
        highest = std::max(highest, y);
      }
    }
    const double metres = k_bvh_stature / (highest - lowest);
    std::vector<Transform> model(take.joints.size());
    for (int k = 0; k < static_cast<int>(take.frames.size()); ++k) {
      const auto expected = twin(take, k);
      model_from_local(mocap.skeleton, mocap.clip.key(k), model);
      for (std::size_t j = 0; j < model.size(); ++j) {
        const Vec3 place = metres * expected[j].topRightCorner<3, 1>();
        // Far from the origin (a flat skeleton that travels) the digits are those of the way.
        const double scale = std::max(k_bvh_stature, place.norm());
        worst = std::max(worst, (model[j].translation - place).norm() / scale);
        worst = std::max(worst, (model[j].rotation.toRotationMatrix() - expected[j].topLeftCorner<3, 3>()).norm());
        ++compared;
      }
    }
  }
  std::filesystem::remove_all(folder);
  std::printf("%d joints in frames, none farther than %.1e of the height from the twin's\n", compared, worst);
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(compared, 5000);
}

} // namespace
