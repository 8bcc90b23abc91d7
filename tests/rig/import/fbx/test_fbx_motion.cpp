// Motion as FBX files say it, against plain evaluation of what is known of them.
#include "rig/import/fbx/fbx.h"
#include "tests/rig/import/fbx/fbx_bytes.h"

#include <gmock/gmock.h>
#include <numbers>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::rig::import_detail;
using namespace tutu::test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace {

constexpr double k_degree = std::numbers::pi / 180.0;
constexpr std::int32_t k_constant = 0x2, k_linear = 0x4, k_cubic = 0x8, k_next = 0x100, k_auto = 0x100, k_tcb = 0x200,
                       k_user = 0x400, k_broken = 0x800, k_level = 0x1000, k_time_independent = 0x2000,
                       k_clamp = 0x4000, k_weighted = 0x3000000;

const std::vector<FileNode> k_nodes = {{.name = "RootNode"}, {.name = "Joint", .parent = 0}};

/// The only take of a file with one model, Joint, whose property is driven by curves.
FileAnimation take_of(const std::vector<FbxTestElement>& properties, const std::string& property,
                      const std::array<const FbxTestCurve*, 3>& curves, const FbxForm& form = {}) {
  FbxTestFile file;
  const std::int64_t joint = file.model("Joint", 0, properties);
  file.move(file.layer(file.take("Take")), joint, property, curves);
  const FbxMotion motion = fbx_motion(file.bytes(form), k_nodes);
  EXPECT_EQ(motion.unread, "");
  EXPECT_EQ(motion.animations.size(), 1u);
  return motion.animations.empty() ? FileAnimation{} : motion.animations[0];
}

/// Of X of the translation, driven by the curve alone.
double x_at(const FileAnimation& take, double time) { return value_at(take.nodes.at(0).translation, time).x(); }
FileAnimation take_of_x(const FbxTestCurve& curve, const FbxForm& form = {}) {
  return take_of({}, "Lcl Translation", {&curve, nullptr, nullptr}, form);
}

/// The Bezier with these control points, where its time is `time`: by bisection.
double bezier_at(const std::array<double, 4>& t, const std::array<double, 4>& v, double time) {
  const auto at = [](const std::array<double, 4>& p, double s) {
    const double r = 1 - s;
    return r * r * r * p[0] + 3 * r * r * s * p[1] + 3 * r * s * s * p[2] + s * s * s * p[3];
  };
  double low = 0, high = 1;
  for (int i = 0; i < 100; ++i) {
    const double s = 0.5 * (low + high);
    (at(t, s) > time ? high : low) = s;
  }
  return at(v, low);
}
/// From (0, a) to (h, b) with slopes and weights.
double cubic_at(double h, double a, double b, double leaving, double arriving, double time, double w1 = 1.0 / 3.0,
                double w2 = 1.0 / 3.0) {
  return bezier_at({0, w1 * h, h - w2 * h, h}, {a, a + w1 * h * leaving, b - w2 * h * arriving, b}, time);
}

class FbxForms : public ::testing::TestWithParam<FbxForm> {};

TEST_P(FbxForms, SayTheSameLaws) {
  const std::uint32_t weights = 2500u | 9000u << 16; // ten thousandths: leaving, and arriving at the next
  const FbxTestCurve curve = {{0, 1, 2, 3, 4, 6, 8},
                              {1, 5, 2, 2.5f, 7, -3, 4},
                              {k_constant, k_constant | k_next, k_linear, k_cubic | k_user | k_broken,
                               k_cubic | k_user | k_broken | k_weighted, k_cubic | k_user | k_broken, k_linear},
                              {{0, 0, 0, 0},
                               {0, 0, 0, 0},
                               {0, 0, 0, 0},
                               {as_word(2), as_word(-3), 0, 0},
                               {as_word(4), as_word(1.5), weights, 0},
                               {as_word(-1), as_word(6), 0, 0},
                               {0, 0, 0, 0}}};
  const FileAnimation take = take_of_x(curve, GetParam());
  EXPECT_EQ(take.name, "Take");
  EXPECT_THAT(take.notes, IsEmpty());
  EXPECT_EQ(take.start, 0.0);
  EXPECT_EQ(take.end, 8.0);
  for (double time = 0.003; time < 8; time += 0.01) {
    const double expected = time < 1   ? 1
                            : time < 2 ? 2 // the next key's
                            : time < 3 ? 2 + 0.5 * (time - 2)
                            : time < 4 ? cubic_at(1, 2.5, 7, 2, -3, time - 3)
                            : time < 6 ? cubic_at(2, 7, -3, 4, 1.5, time - 4, 0.25, 0.9)
                                       : cubic_at(2, -3, 4, -1, 6, time - 6);
    EXPECT_NEAR(x_at(take, time), expected, time >= 4 && time < 6 ? 2e-4 : 1e-6) << time;
  }
  EXPECT_EQ(x_at(take, 9), 4);
  EXPECT_LT(take.nodes[0].translation.times.size(), 60u); // but one stretch is kept as it is
}

std::string form_name(const ::testing::TestParamInfo<FbxForm>& info) {
  const FbxForm& form = info.param;
  return (form.is_text ? "Text" : form.deflates ? "Deflated" : "Binary") + std::to_string(form.version);
}
INSTANTIATE_TEST_SUITE_P(All, FbxForms, ::testing::ValuesIn(k_fbx_forms), form_name);

TEST(FbxMotion, SlopesThatTheFileLeavesToItsReader) {
  // By the formula of the neighbours' chord; at an extremum and near a neighbour's value kept from overshooting.
  const auto slope_at_one = [](std::int32_t flags, float value, std::uint32_t bias = 0) {
    const std::array<std::uint32_t, 4> data = {bias, 0, 0, 0};
    const FileAnimation take =
        take_of_x({{0, 1, 3}, {0, value, 3}, {k_linear, k_cubic | flags, k_linear}, {{}, data, {}}});
    return (x_at(take, 1 + 1e-6) - x_at(take, 1)) * 1e6;
  };
  EXPECT_NEAR(slope_at_one(k_auto | k_time_independent, 2), 1, 1e-4);
  EXPECT_NEAR(slope_at_one(k_auto | k_time_independent | k_clamp, 2), 1, 1e-4);
  EXPECT_NEAR(slope_at_one(k_auto | k_time_independent | k_clamp, 5), 0, 1e-4);
  EXPECT_NEAR(slope_at_one(k_auto | k_time_independent | k_clamp, 2.9f), 0.15, 1e-4); // 0.1 on a third of 2 s
  EXPECT_NEAR(slope_at_one(k_auto, 2), 0.5 * (1 + (2.0 / 3 * 2 + 1.0 / 3 * 0.5)), 1e-4);
  EXPECT_NEAR(slope_at_one(k_auto, 2, as_word(100)), 0.5, 1e-4);
  EXPECT_NEAR(slope_at_one(k_auto, 2, as_word(50)), 0.5 * 0.5 + 0.5 * 1.25, 1e-4);
  EXPECT_NEAR(slope_at_one(k_tcb, 2), 0.5 * (2 + 0.5), 1e-4);
  EXPECT_NEAR(slope_at_one(k_tcb, 2, as_word(0.5)), 0.25 * (2 + 0.5), 1e-4); // tension
  EXPECT_NEAR(slope_at_one(k_user, 2, as_word(7)), 7, 1e-3);
  EXPECT_NEAR(slope_at_one(k_user | k_level, 2, as_word(7)), 7, 1e-3);
  EXPECT_NEAR(slope_at_one(k_user | k_level, 3, as_word(7)), 0, 1e-3); // the next key's value
}

TEST(FbxMotion, EndsOfWhatIsLeftToItsReader) {
  const auto quarter = [](std::int32_t flags) {
    return x_at(take_of_x({{0, 1, 2}, {0, 4, 8}, {k_cubic | flags, k_cubic | flags, k_cubic | flags}}), 0.25);
  };
  EXPECT_NEAR(quarter(k_auto | k_time_independent), 1, 1e-6);
  EXPECT_NEAR(quarter(k_auto | k_time_independent | k_clamp), cubic_at(1, 0, 4, 0, 4, 0.25), 1e-6);
  EXPECT_NEAR(quarter(k_tcb), 1, 1e-6);
}

Eigen::Matrix4d turned(const Vec3& degrees, const std::string& order) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  for (const char axis : order) {
    Eigen::Matrix4d one = Eigen::Matrix4d::Identity();
    one.topLeftCorner<3, 3>() =
        Eigen::AngleAxisd(degrees[axis - 'X'] * k_degree, Vec3::Unit(axis - 'X')).toRotationMatrix();
    m = one * m;
  }
  return m;
}
Eigen::Matrix4d moved(const Vec3& by) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topRightCorner<3, 1>() = by;
  return m;
}
Eigen::Matrix4d scaled(const Vec3& by) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.diagonal().head<3>() = by;
  return m;
}

TEST(FbxMotion, PivotsOrdersAndRotationsBeforeAndBehind) {
  const Vec3 pre(10, 20, 30), post(-40, 15, 5), t(1, 2, 3), s(1, 2, 0.5), r_offset(0.1, 0.2, 0.3), r_pivot(1, -1, 2),
      s_offset(0.5, 0, -0.5), s_pivot(2, 1, 0);
  const auto numbers = [](const Vec3& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
  const char* const k_orders[] = {"XYZ", "XZY", "YZX", "YXZ", "ZXY", "ZYX", "XYZ"};
  const FbxTestCurve x = {{0, 2}, {0, 180}, {k_linear, k_linear}},
                     y = {{0, 1, 2}, {0, 90, 30}, {k_linear, k_linear, 4}},
                     z = {{0, 2}, {40, -400}, {k_linear, k_linear}};
  for (std::int64_t order = 0; order < 7; ++order)
    for (const std::int64_t active : {1, 0}) {
      const FileAnimation take =
          take_of({fbx_property("RotationOrder", order), fbx_property("RotationActive", active),
                   fbx_property("PreRotation", numbers(pre)), fbx_property("PostRotation", numbers(post)),
                   fbx_property("Lcl Translation", numbers(t)), fbx_property("Lcl Scaling", numbers(s)),
                   fbx_property("RotationOffset", numbers(r_offset)), fbx_property("RotationPivot", numbers(r_pivot)),
                   fbx_property("ScalingOffset", numbers(s_offset)), fbx_property("ScalingPivot", numbers(s_pivot))},
                  "Lcl Rotation", {&x, &y, &z});
      const NodeMotion& motion = take.nodes.at(0);
      EXPECT_TRUE(motion.scale.empty());
      for (double time = 0.001; time < 2; time += 0.007) {
        const Vec3 angles(90 * time, time < 1 ? 90 * time : 90 - 60 * (time - 1), 40 - 220 * time);
        const Eigen::Matrix4d rotation =
            active == 1
                ? Eigen::Matrix4d(turned(pre, "XYZ") * turned(angles, k_orders[order]) * turned(post, "XYZ").inverse())
                : turned(angles, "XYZ");
        const Eigen::Matrix4d expected = moved(t) * moved(r_offset) * moved(r_pivot) * rotation * moved(-r_pivot) *
                                         moved(s_offset) * moved(s_pivot) * scaled(s) * moved(-s_pivot);
        Eigen::Matrix4d found = moved(value_at(motion.translation, time));
        found.topLeftCorner<3, 3>() = value_at(motion.rotation, time).toRotationMatrix();
        found = found * scaled(s);
        EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 2e-4) << "order " << order << " at " << time;
      }
    }
}

TEST(FbxMotion, HowModelsStand) {
  FbxTestFile file;
  file.model("Joint", 0,
             {fbx_property("RotationActive", 1), fbx_property("RotationOrder", 4),
              fbx_property("PreRotation", {10, 20, 30}), fbx_property("PostRotation", {-40, 15, 5}),
              fbx_property("Lcl Translation", {1, 2, 3}), fbx_property("Lcl Rotation", {50, -60, 70}),
              fbx_property("Lcl Scaling", {1, 2, -3}), fbx_property("RotationPivot", {1, -1, 2}),
              fbx_property("ScalingPivot", {2, 1, 0})});
  const FbxMotion motion = fbx_motion(file.bytes(), k_nodes);
  EXPECT_TRUE(motion.animations.empty());
  ASSERT_EQ(motion.locals.size(), 1u) << motion.unread;
  const Vec3 pivot(1, -1, 2), scaling_pivot(2, 1, 0);
  const Eigen::Matrix4d expected = moved({1, 2, 3}) * moved(pivot) * turned({10, 20, 30}, "XYZ") *
                                   turned({50, -60, 70}, "ZXY") * turned({-40, 15, 5}, "XYZ").inverse() *
                                   moved(-pivot) * moved(scaling_pivot) * scaled({1, 2, -3}) * moved(-scaling_pivot);
  EXPECT_LT((motion.locals.at(1).matrix() - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(FbxMotion, AScaleAndATranslationAreKeptAsTheyAre) {
  const FbxTestCurve linear = {{0, 1, 2}, {1, 2, 0}, {k_linear, k_linear, k_linear}};
  const FbxTestCurve cubic = {{0, 2}, {3, 5}, {k_cubic | k_user, k_cubic | k_user}, {{as_word(9), 0, 0, 0}, {}}};
  FileAnimation take = take_of({fbx_property("Lcl Scaling", {2, 3, 4})}, "Lcl Scaling", {&linear, nullptr, nullptr});
  EXPECT_EQ(take.nodes.at(0).scale.times.size(), 3u);
  EXPECT_EQ(value_at(take.nodes[0].scale, 0.5), Vec3(1.5, 3, 4));
  EXPECT_TRUE(take.nodes[0].rotation.empty());
  EXPECT_TRUE(take.nodes[0].translation.empty());
  take = take_of({fbx_property("RotationOffset", {1, 1, 1}), fbx_property("Lcl Rotation", {0, 50, 0})},
                 "Lcl Translation", {&linear, &cubic, nullptr});
  EXPECT_EQ(take.nodes.at(0).translation.times.size(), 3u);
  EXPECT_NEAR(value_at(take.nodes[0].translation, 1.5).x(), 2, 1e-12);
  EXPECT_NEAR(value_at(take.nodes[0].translation, 1.5).y(), 1 + cubic_at(2, 3, 5, 9, 0, 1.5), 1e-6);
}

TEST(FbxMotion, ATakeMayPutAModelElsewhereWithoutAnyKey) {
  FbxTestFile file;
  const std::int64_t joint = file.model("Joint", 0, {fbx_property("Lcl Translation", {1, 2, 3})});
  const std::int64_t layer = file.layer(file.take("Take"));
  file.move(layer, joint, "Lcl Translation", {nullptr, nullptr, nullptr});
  file.objects.back().children.push_back({"Properties70", {}, {fbx_property("d|X", {1}), fbx_property("d|Y", {7})}});
  const FbxMotion motion = fbx_motion(file.bytes(), k_nodes);
  ASSERT_EQ(motion.animations.size(), 1u) << motion.unread;
  EXPECT_EQ(value_at(motion.animations[0].nodes.at(0).translation, 5), Vec3(1, 7, 3));
  EXPECT_TRUE(motion.animations[0].nodes[0].rotation.empty());
}

TEST(FbxMotion, ModelsAreFoundByTheirPlace) {
  FbxTestFile file;
  const std::int64_t hips = file.model("Hips", 0, {}), left = file.model("Arm", hips, {});
  const std::int64_t right = file.model("Arm", hips, {}), prop = file.model("Prop", 0, {}, "Null");
  const std::int64_t below = file.model("Arm", prop, {}), lost = file.model("Lost", 0, {});
  const std::int64_t layer = file.layer(file.take("Take"));
  const FbxTestCurve one = {{0, 1}, {0, 1}, {k_linear, k_linear}}, two = {{0, 1}, {0, 2}, {k_linear, k_linear}},
                     three = {{0, 1}, {0, 3}, {k_linear, k_linear}};
  file.move(layer, left, "Lcl Translation", {&one, nullptr, nullptr});
  file.move(layer, right, "Lcl Translation", {&two, nullptr, nullptr});
  file.move(layer, below, "Lcl Translation", {&three, nullptr, nullptr});
  file.move(layer, lost, "Lcl Translation", {&three, nullptr, nullptr});
  const std::vector<FileNode> nodes = {{.name = "RootNode"},          {.name = "Hips", .parent = 0},
                                       {.name = "Arm", .parent = 1},  {.name = "Arm001", .parent = 1},
                                       {.name = "Prop", .parent = 0}, {.name = "Arm002", .parent = 4}};
  const FbxMotion motion = fbx_motion(file.bytes(), nodes);
  ASSERT_EQ(motion.animations.size(), 1u) << motion.unread;
  const auto& moving = motion.animations[0].nodes;
  ASSERT_EQ(moving.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(moving[i].node, (std::array{2, 3, 5}[i]));
    EXPECT_EQ(value_at(moving[i].translation, 1).x(), static_cast<double>(i + 1));
  }
  EXPECT_THAT(motion.animations[0].notes, ElementsAre("1 model without a node, whose motion is left out: Lost"));
}

TEST(FbxMotion, TakesAndTheirTimeLines) {
  FbxTestFile file;
  const std::int64_t joint = file.model("Joint", 0, {fbx_property("QuaternionInterpolate", 1)});
  const FbxTestCurve curve = {{1.25, 3}, {0, 1}, {k_linear, k_linear}}, early = {{-2, 3}, {0, 1}, {k_linear, k_linear}};
  const auto take = [&](const std::string& name, std::vector<FbxTestElement> properties, const FbxTestCurve& moved_by) {
    file.move(file.layer(file.take(name, std::move(properties))), joint, "Lcl Rotation", {&moved_by, nullptr, nullptr});
  };
  take("keys", {}, curve);
  take("early", {}, early);
  take("given", {fbx_property("LocalStart", k_ticks / 2), fbx_property("LocalStop", 4 * k_ticks)}, curve);
  take("stop", {fbx_property("LocalStop", 2 * k_ticks)}, curve);
  take("wrong", {fbx_property("LocalStart", k_ticks), fbx_property("LocalStop", k_ticks)}, curve);
  file.take("empty");
  file.layer(file.take("still"));
  const FbxMotion motion = fbx_motion(file.bytes(), k_nodes);
  std::vector<std::string> found;
  for (const FileAnimation& animation : motion.animations) {
    char line[80];
    std::snprintf(line, sizeof line, "%s %g %g", animation.name.c_str(), animation.start, animation.end);
    found.emplace_back(line);
    EXPECT_THAT(animation.notes, ElementsAre(HasSubstr("blended as quaternions")));
  }
  EXPECT_THAT(found, ElementsAre("keys 0 3", "early -2 3", "given 0.5 4", "stop 0 2", "wrong 0 3"));
}

TEST(FbxMotion, TheUnitOfTimeIsWhatTheFileSays) {
  FbxTestFile file;
  const std::int64_t joint = file.model("Joint", 0, {});
  const double share = 141120000.0 / static_cast<double>(k_ticks);
  const FbxTestCurve curve = {{0, 2 * share}, {0, 1}, {k_linear, k_linear}};
  file.move(file.layer(file.take("Take")), joint, "Lcl Rotation", {&curve, nullptr, nullptr});
  for (const auto& [definition, end] : {std::pair(0, 2.0), std::pair(127, 2 * share)})
    for (const bool is_text : {true, false}) {
      const FbxTestElement header = {
          "FBXHeaderExtension",
          {},
          {{"FBXVersion", {std::int64_t{7700}}}, {"OtherFlags", {}, {{"TCDefinition", {std::int64_t{definition}}}}}}};
      const std::string bytes = fbx_bytes(
          {header, {"Objects", {}, file.objects}, {"Connections", {}, file.connections}}, {is_text, 7700, false});
      const FbxMotion motion = fbx_motion(is_text ? bytes.substr(bytes.find("; Objects")) : bytes, k_nodes);
      ASSERT_EQ(motion.animations.size(), 1u) << motion.unread;
      EXPECT_NEAR(motion.animations[0].end, end, 1e-6);
    }
}

TEST(FbxMotion, WhatIsLeftOutIsNoted) {
  FbxTestFile file;
  const std::int64_t parent = file.model("Parent", 0, {fbx_property("Lcl Scaling", {2, 2, 2})});
  const std::int64_t joint = file.model("Joint", parent, {fbx_property("InheritType", 2)});
  const std::int64_t take = file.take("Take"), base = file.layer(take), second = file.layer(take);
  const FbxTestCurve curve = {{0, 1}, {0, 1}, {k_linear, k_linear}};
  file.move(base, joint, "Lcl Rotation", {&curve, nullptr, nullptr});
  file.move(second, joint, "Lcl Rotation", {nullptr, &curve, nullptr});
  for (FbxTestElement& object : file.objects)
    if (object.name == "AnimationCurve") {
      object.children.push_back({"Post-Extrapolation", {}, {{"Type", {std::string("R")}}}});
      break;
    }
  const std::vector<FileNode> nodes = {
      {.name = "RootNode"}, {.name = "Parent", .parent = 0}, {.name = "Joint", .parent = 1}};
  const FbxMotion motion = fbx_motion(file.bytes(), nodes);
  ASSERT_EQ(motion.animations.size(), 1u) << motion.unread;
  EXPECT_THAT(motion.animations[0].notes,
              ElementsAre("layer Base left out: only the base layer is read", HasSubstr("go on beyond their keys"),
                          HasSubstr("do not inherit the scale of their parent")));
}

} // namespace
