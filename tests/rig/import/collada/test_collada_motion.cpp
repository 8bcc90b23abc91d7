// Motion as Collada files say it, against plain evaluation of what the specification says.
#include "tests/rig/import/collada/collada_text.h"

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
using Matrix4 = Eigen::Matrix4d;

Matrix4 turned(double degrees, const Vec3& axis) {
  Matrix4 m = Matrix4::Identity();
  m.topLeftCorner<3, 3>() = Eigen::AngleAxisd(degrees * k_degree, axis.normalized()).toRotationMatrix();
  return m;
}
Matrix4 moved(const Vec3& by) {
  Matrix4 m = Matrix4::Identity();
  m.topRightCorner<3, 1>() = by;
  return m;
}
Matrix4 scaled(const Vec3& by) {
  Matrix4 m = Matrix4::Identity();
  m.diagonal().head<3>() = by;
  return m;
}
std::vector<double> rows(const Matrix4& m) {
  std::vector<double> numbers;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) numbers.push_back(m(r, c));
  return numbers;
}
std::vector<double> rows(const std::vector<Matrix4>& matrices) {
  std::vector<double> numbers;
  for (const Matrix4& m : matrices) {
    const std::vector<double> one = rows(m);
    numbers.insert(numbers.end(), one.begin(), one.end());
  }
  return numbers;
}

/// parent_from_node as the motion says, what it does not move as in `rest`.
Matrix4 matrix_at(const FileAnimation& clip, double time, const Matrix4& rest = Matrix4::Identity()) {
  EXPECT_EQ(clip.nodes.size(), 1u);
  const NodeMotion& motion = clip.nodes.at(0);
  const Vec3 scale = rest.topLeftCorner<3, 3>().colwise().norm();
  Matrix4 m = rest * scaled(scale.cwiseInverse());
  if (!motion.rotation.empty()) m.topLeftCorner<3, 3>() = value_at(motion.rotation, time).toRotationMatrix();
  m = m * scaled(motion.scale.empty() ? scale : value_at(motion.scale, time));
  if (!motion.translation.empty()) m.topRightCorner<3, 1>() = value_at(motion.translation, time);
  return m;
}
double difference(const Matrix4& a, const Matrix4& b) { return (a - b).cwiseAbs().maxCoeff(); }

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

template <typename Expected>
void expect_everywhere(const FileAnimation& clip, double tolerance, Expected expected,
                       const Matrix4& rest = Matrix4::Identity()) {
  double worst = 0.0, where = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double time = clip.start + (clip.end - clip.start) * (i + 0.37) / 1001.0; // between keys too
    const double here = difference(matrix_at(clip, time, rest), expected(time));
    if (here > worst) worst = here, where = time;
  }
  EXPECT_LE(worst, tolerance) << "at " << where;
}

TEST(ColladaMotion, MatricesGoStraightAndOnAnArcOrAreHeld) {
  const Matrix4 a = moved({1, 2, 3}) * turned(20, {1, 2, 0}) * scaled({2, 2, 2});
  const Matrix4 b = moved({3, 2, -1}) * turned(100, {0, 1, 1}) * scaled({1, 2, 3});
  const std::string matrix = "<matrix sid='m'>" + listed(rows(a)) + "</matrix>";
  const auto clips = clips_of(matrix, {{"a/m", {0.5, 1.5, 4}, rows({a, b, a}), {"LINEAR", "STEP", "LINEAR"}}});
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_THAT(clips[0].notes, IsEmpty());
  EXPECT_EQ(clips[0].start, 0.0);
  EXPECT_EQ(clips[0].end, 4.0);
  const Quat qa(Eigen::Matrix3d(turned(20, {1, 2, 0}).topLeftCorner<3, 3>()));
  const Quat qb(Eigen::Matrix3d(turned(100, {0, 1, 1}).topLeftCorner<3, 3>()));
  expect_everywhere(clips[0], 1e-12, [&](double t) -> Matrix4 {
    if (t >= 1.5) return b;
    const double s = std::max(t - 0.5, 0.0);
    Matrix4 turn = Matrix4::Identity();
    turn.topLeftCorner<3, 3>() = qa.slerp(s, qb).toRotationMatrix();
    return moved({1 + 2 * s, 2, 3 - 4 * s}) * turn * scaled({2 - s, 2, 2 + s});
  });
  EXPECT_LE(difference(matrix_at(clips[0], 4), a), 1e-12);
}

TEST(ColladaMotion, AnglesAboutSeveralAxesTurnFurtherThanHalf) {
  const std::string transform = "<translate sid='t'>1 2 3</translate><rotate sid='z'>0 0 1 10</rotate>"
                                "<rotate sid='y'>0 2 0 20</rotate><rotate sid='x'>1 0 0 30</rotate>"
                                "<scale sid='s'>1 2 1</scale>";
  const auto clips = clips_of(transform, {{"a/z.ANGLE", {0, 2}, {0, 1440}}, // ends where it starts, as do its quarters
                                          {"a/x.ANGLE", {0, 1, 2}, {0, 90, -90}}});
  ASSERT_EQ(clips.size(), 1u);
  expect_everywhere(
      clips[0], 6e-5,
      [](double t) -> Matrix4 {
        return moved({1, 2, 3}) * turned(720 * t, {0, 0, 1}) * turned(20, {0, 1, 0}) *
               turned(t < 1 ? 90 * t : 90 - 180 * (t - 1), {1, 0, 0}) * scaled({1, 2, 1});
      },
      moved({1, 2, 3}) * scaled({1, 2, 1}));
  EXPECT_TRUE(clips[0].nodes[0].translation.empty());
  EXPECT_TRUE(clips[0].nodes[0].scale.empty());
}

TEST(ColladaMotion, BezierWithWeightedHandlesIsSolvedInTime) {
  const std::array<double, 4> t = {0, 1.4, 1.2, 2}, v = {0, 5, 90, 60};
  const std::vector<double> leaving = {t[1], v[1], 2.5, 60}, arriving = {-0.5, 0, t[2], v[2]};
  auto clips = clips_of("<rotate sid='r'>0 1 0 0</rotate>",
                        {{"a/r.ANGLE", {0, 2}, {v[0], v[3]}, {"BEZIER"}, leaving, arriving}});
  expect_everywhere(clips[0], 3e-5, [&](double time) { return turned(bezier_at(t, v, time), {0, 1, 0}); });
  clips = clips_of("<translate sid='t'>7 8 9</translate>",
                   {{"a/t.Y", {0, 2}, {v[0], v[3]}, {"BEZIER"}, leaving, arriving}});
  expect_everywhere(clips[0], 60 * 2e-5, [&](double time) { return moved({7, bezier_at(t, v, time), 9}); });
}

TEST(ColladaMotion, BezierWithHandlesAtThirdsIsKeptExactly) {
  for (const bool one_dimension : {true, false}) {
    std::vector<double> leaving, arriving; // of three numbers a key: values, or times and values
    const std::vector<std::array<double, 4>> v = {{0, 4, -2, 1}, {1, 1, 1, 1}, {2, 3, 5, -7}};
    const auto put = [&](std::vector<double>& handles, double time, int point) {
      for (const auto& p : v) {
        if (!one_dimension) handles.push_back(time);
        handles.push_back(p[point]);
      }
    };
    put(leaving, 2, 1);
    put(leaving, 5, 3);
    put(arriving, 0, 0);
    put(arriving, 3, 2);
    const auto clips = clips_of("<translate sid='t'>0 0 0</translate><rotate>0 0 1 30</rotate>",
                                {{"a/t", {1, 4}, {0, 1, 2, 1, 1, -7}, {"BEZIER"}, leaving, arriving}});
    const VectorCurve& curve = clips[0].nodes[0].translation;
    EXPECT_EQ(curve.times.size(), 2u);
    EXPECT_EQ(curve.laws[0], Law::cubic);
    for (int i = 0; i <= 100; ++i) {
      const double time = 1 + 0.03 * i;
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(value_at(curve, time)[axis], bezier_at({1, 2, 3, 4}, v[axis], time), 1e-12);
    }
  }
}

TEST(ColladaMotion, AxesWithKeysAndLawsOfTheirOwnAreJoinedExactly) {
  const auto clips =
      clips_of("<translate sid='t'>0 0 5</translate>", {{"a/t.X", {0, 1, 3}, {0, 2, 4}, {"STEP", "LINEAR", "STEP"}},
                                                        {"a/t.Y", {0.5, 2}, {1, 4}, {"HERMITE"}, {6, 0}, {0, -3}}});
  expect_everywhere(clips[0], 1e-12, [](double t) {
    const double x = t < 1 ? 0 : 2 + (t - 1), s = std::clamp((t - 0.5) / 1.5, 0.0, 1.0);
    const double y = (2 * s * s * s - 3 * s * s + 1) * 1 + (s * s * s - 2 * s * s + s) * 6 +
                     (3 * s * s - 2 * s * s * s) * 4 + (s * s * s - s * s) * -3; // derivatives by s
    return moved({x, y, 5});
  });
  EXPECT_LE(clips[0].nodes[0].translation.times.size(), 7u);
}

TEST(ColladaMotion, StepIsHeldAndConstantsTakeNoKeys) {
  const auto clips = clips_of("<translate sid='t'>0 0 0</translate><rotate sid='r'>1 0 0 40</rotate>",
                              {{"a/r.ANGLE", {0, 1, 2, 3}, {0, 50, 50, 70}, {"STEP"}}, {"a/t.X", {0, 3}, {0, 0}}});
  EXPECT_TRUE(clips[0].nodes[0].translation.empty());
  EXPECT_EQ(clips[0].nodes[0].rotation.times.size(), 3u);
  EXPECT_LE(difference(matrix_at(clips[0], 0.999999), turned(0, {1, 0, 0})), 1e-15);
  EXPECT_LE(difference(matrix_at(clips[0], 1), turned(50, {1, 0, 0})), 1e-15);
  EXPECT_LE(difference(matrix_at(clips[0], 9), turned(70, {1, 0, 0})), 1e-15);
}

TEST(ColladaMotion, APivotMovesTheTranslation) {
  const std::string transform = "<translate sid='t'>1 0 0</translate><translate>0 3 0</translate>"
                                "<rotate sid='r'>0 0 1 0</rotate><translate>0 -3 0</translate>";
  const auto clips = clips_of(transform, {{"a/r.ANGLE", {0, 1}, {0, 120}}, {"a/t.Z", {0, 1}, {0, 2}}});
  expect_everywhere(clips[0], 6e-5, [](double t) -> Matrix4 {
    return moved({1, 0, 2 * t}) * moved({0, 3, 0}) * turned(120 * t, {0, 0, 1}) * moved({0, -3, 0});
  });
}

TEST(ColladaMotion, ElementsOfAMatrixAndWholeAxes) {
  const auto clips = clips_of("<matrix sid='m'>1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1</matrix>",
                              {{"a/m(3)(1)", {0, 1}, {5, 9}}, {"a/m(3)", {0, 1}, {4, 0}}});
  expect_everywhere(clips[0], 1e-4, [](double t) { return moved({4 - 4 * t, 5 + 4 * t, 6}); });
  const auto axes = clips_of("<rotate sid='r'>1 0 0 90</rotate>", {{"a/r", {0, 1}, {1, 0, 0, 90, 0, 1, 0, 90}}});
  expect_everywhere(axes[0], 3e-5, [](double t) { return turned(90, {1 - t, t, 0}); });
}

TEST(ColladaMotion, LooksAndSkews) {
  const auto clips = clips_of("<lookat sid='l'>0 0 0 0 0 -1 0 1 0</lookat>",
                              {{"a/l", {0, 1}, {0, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 2, 1, 0, 2, 0, 1, 0}, {"STEP"}}});
  EXPECT_LE(difference(matrix_at(clips[0], 0.5), Matrix4::Identity()), 1e-15);
  EXPECT_LE(difference(matrix_at(clips[0], 1), moved({0, 0, 2}) * turned(-90, {0, 1, 0})), 1e-15);
  const auto skews =
      clips_of("<translate sid='t'>0 0 0</translate><skew>45 0 1 0 1 0 0</skew>", {{"a/t.X", {0, 1}, {0, 1}}});
  EXPECT_THAT(skews[0].notes, ElementsAre(HasSubstr("shear")));
}

TEST(ColladaMotion, AScaleOfNothingKeepsTheRotation) {
  const auto clips = clips_of("<rotate sid='r'>0 0 1 30</rotate><scale sid='s'>1 1 1</scale>",
                              {{"a/s", {0, 1}, {1, 1, 1, 0, 0, 0}}, {"a/r.ANGLE", {0, 1}, {30, 60}}});
  expect_everywhere(clips[0], 3e-5, [](double t) -> Matrix4 {
    return turned(30 + 30 * t, {0, 0, 1}) * scaled(Vec3::Constant(1 - t));
  });
  EXPECT_LE(
      value_at(clips[0].nodes[0].rotation, 1).angularDistance(Quat(Eigen::AngleAxisd(60 * k_degree, Vec3::UnitZ()))),
      1e-12);
}

TEST(ColladaMotion, JumpsAtOneTimeAndNegativeTimes) {
  const auto clips = clips_of("<translate sid='t'>0 0 0</translate>", {{"a/t.X", {-1, 0, 0, 1}, {0, 1, 5, 6}}});
  EXPECT_EQ(clips[0].start, -1.0);
  EXPECT_NEAR(matrix_at(clips[0], -1e-9)(0, 3), 1, 1e-8);
  EXPECT_EQ(matrix_at(clips[0], 0)(0, 3), 5);
  EXPECT_EQ(matrix_at(clips[0], 7)(0, 3), 6);
}

TEST(ColladaMotion, LawsThatAreUnknownAreNoted) {
  const auto note_of = [](std::vector<std::string> laws) {
    const auto clips = clips_of("<translate sid='t'>0 0 0</translate>", {{"a/t.X", {0, 1}, {0, 1}, std::move(laws)}});
    EXPECT_NEAR(value_at(clips[0].nodes[0].translation, 0.25).x(), 0.25, 1e-15);
    return clips[0].notes;
  };
  EXPECT_THAT(note_of({"CARDINAL"}), ElementsAre("channel a/t.X: CARDINAL read as LINEAR"));
  EXPECT_THAT(note_of({"BEZIER"}), ElementsAre("channel a/t.X: BEZIER without tangents read as LINEAR"));
  EXPECT_THAT(note_of({"LINEAR"}), IsEmpty());
  EXPECT_THAT(note_of({"LINEAR", "BSPLINE"}), IsEmpty()); // behind the last key is nothing
  EXPECT_THAT(note_of({}), IsEmpty());
}

} // namespace
