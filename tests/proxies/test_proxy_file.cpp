#include "proxies/proxy_file.h"

#include "rig/error.h"
#include "rig/io/file_io.h"
#include "rig/io/json_file.h"
#include "tests/support/collider_scenes.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::proxies;
using ::testing::HasSubstr;

namespace {

/// Hips - LeftUpLeg - LeftLeg, and Head on the hips, with turned rests so that frames matter.
rig::Skeleton small_skeleton() {
  const auto turned = [](double angle, const Vec3& axis, const Vec3& place) {
    return Transform{Quat(Eigen::AngleAxisd(angle, axis)), place};
  };
  rig::Skeleton skeleton;
  skeleton.names = {"mixamorig:Hips", "mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:Head"};
  skeleton.parents = {rig::k_no_parent, 0, 1, 0};
  skeleton.rest_local = {turned(0.3, Vec3::UnitY(), {0, 1, 0}), turned(3.0, Vec3::UnitX(), {0.1, -0.05, 0}),
                         turned(-0.2, Vec3::UnitZ(), {0, 0.42, 0}), turned(0.7, Vec3::UnitZ(), {0, 0.6, 0.02})};
  return skeleton;
}

std::vector<Proxy> read_text(const std::string& text, const rig::Skeleton& skeleton = small_skeleton()) {
  const auto file = test::scratch_folder() / "proxies.json";
  write_file(file, text);
  return read_proxies(file, skeleton);
}

std::vector<Proxy> read_one(const std::string& proxy) { return read_text("{\"proxies\": [" + proxy + "]}"); }

TEST(ProxyFile, ReadsTheDocumentedExample) {
  const rig::Skeleton skeleton = small_skeleton();
  const std::vector<Proxy> proxies = read_text(R"({ "proxies": [ // a comment
     { "name": "head", "sphere": { "joint": "Head", "center": [0, 0.09, 0.01], "radius": 0.095 } },
     { "capsule": { "joint": "LeftUpLeg", "a": [0,0,0], "b": [0,-0.4,0], "radius": 0.07 }, "friction": 0.5, "enabled": false },
     { "capsule": { "a": { "between": ["LeftUpLeg", "LeftLeg"], "at": 0.25 },
                    "b": { "point": [0.1, 0.9, 0], "joints": [["Hips", 0.7], ["LeftUpLeg", 2.1]] }, "radius": 0.07 } },
     { "capsule": { "joint": "mixamorig_LeftLeg", "a": [0,0.1,0], "b": { "joint": "hips", "at": [0,0,0.2] }, "radius": [0.05, 0.08] } }
     ] })");
  ASSERT_EQ(proxies.size(), 4u);

  EXPECT_EQ(proxies[0].name, "head");
  EXPECT_EQ(proxies[0].kind, ProxyKind::sphere);
  EXPECT_EQ(proxies[0].a.joints[0], 3);
  EXPECT_EQ(proxies[0].b.points[0], Vec3(0, 0.09, 0.01));
  EXPECT_EQ(proxies[0].friction, 0.3);
  EXPECT_TRUE(proxies[0].enabled);

  EXPECT_EQ(proxies[1].name, "mixamorig:LeftUpLeg 1");
  EXPECT_EQ(proxies[1].friction, 0.5);
  EXPECT_FALSE(proxies[1].enabled);
  EXPECT_EQ(proxies[1].radius, 0.07);

  // At rest a blend of two origins lies between them, and a skinned point where it was said to be.
  const std::vector<Transform> rest = rig::rest_model(skeleton);
  const Vec3 expected = 0.75 * rest[1].translation + 0.25 * rest[2].translation;
  EXPECT_LE((proxies[2].a.place(rest) - expected).norm(), 1e-15);
  EXPECT_LE((proxies[2].b.place(rest) - Vec3(0.1, 0.9, 0)).norm(), 1e-15);
  EXPECT_NEAR(proxies[2].b.weights[0], 0.25, 1e-15);

  EXPECT_EQ(proxies[3].a.joints[0], 2);
  EXPECT_EQ(proxies[3].b.joints[0], 0);
  EXPECT_EQ(proxies[3].radius, 0.05);
  EXPECT_EQ(proxies[3].taper, 0.08 - 0.05);
  EXPECT_EQ(proxies[1].taper, 0.0);
}

TEST(ProxyFile, ASkinnedEndFollowsItsJoints) {
  const rig::Skeleton skeleton = small_skeleton();
  const std::vector<Proxy> proxies = read_one(
      R"({"sphere": {"center": {"point": [0.1, 0.9, 0.05], "joints": [["Hips", 1], ["LeftLeg", 3]]}, "radius": 0.1}})");
  const std::vector<Transform> rest = rig::rest_model(skeleton);
  std::vector<Transform> now = rest;
  now[2] = Transform{Quat(Eigen::AngleAxisd(0.5, Vec3::UnitX())), Vec3(0, 0.1, 0)} * rest[2];
  const Vec3 point(0.1, 0.9, 0.05);
  const Vec3 expected = 0.25 * point + 0.75 * (Quat(Eigen::AngleAxisd(0.5, Vec3::UnitX())) * point + Vec3(0, 0.1, 0));
  EXPECT_LE((proxies[0].a.place(now) - expected).norm(), 1e-15);
}

TEST(ProxyFile, ErrorsNamePlaceFoundAndExpected) {
  const auto expect_error = [](const std::string& proxy, const std::string& place, const std::string& part) {
    try {
      read_one(proxy);
      ADD_FAILURE() << "accepted: " << proxy;
    } catch (const InputError& error) {
      EXPECT_EQ(error.place(), place) << proxy;
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  };
  const std::string ball = R"({"sphere": {"joint": "Head", "center": [0,0,0], "radius": 0.1}})";
  const auto sphere = [](const std::string& inside) { return "{\"sphere\": {" + inside + "}}"; };
  const auto capsule = [](const std::string& b) {
    return R"({"capsule": {"joint": "Head", "a": [0,0,0], "radius": 0.1, "b": )" + b + "}}";
  };
  const std::string s = "/proxies/0/sphere", b = "/proxies/0/capsule/b";

  expect_error(sphere(R"("joint": "LeftUpLg", "center": [0,0,0], "radius": 1)"), s + "/joint",
               "such as mixamorig:LeftUpLeg, mixamorig:LeftLeg");
  expect_error(sphere(R"("joint": "Head", "center": [0,0,0], "radius": -0.1)"), s + "/radius", "above 0");
  expect_error(sphere(R"("joint": "Head", "center": [0,0,0], "radius": 0)"), s + "/radius", "above 0");
  expect_error(sphere(R"("joint": "Head", "center": [0,0,0], "radius": "big")"), s + "/radius", "above 0");
  expect_error(sphere(R"("joint": "Head", "center": [0,0,0])"), s, "radius");
  expect_error(sphere(R"("joint": "Head", "center": [0,0,0], "radius": [1, 2])"), s + "/radius", "above 0");
  for (const char* radii : {"[0.1, -0.1]", "[0, 0.1]", "[0.1]", "[0.1, 0.2, 0.3]", "[0.1, \"x\"]"}) {
    const std::string shape = R"("joint": "Head", "a": [0,0,0], "b": [0,1,0], "radius": )" + std::string(radii);
    EXPECT_THROW(read_one("{\"capsule\": {" + shape + "}}"), InputError) << radii;
  }
  expect_error(R"({"capsule": {"joint": "Head", "a": [0,0,0], "b": [0,1,0], "radius": [0.1, -0.1]}})",
               "/proxies/0/capsule/radius", "or two: [at a, at b]");
  expect_error(R"({"capsule": {"joint": "Head", "a": [0,0,0], "b": [0,1,0], "radius": [1e9, 1e-9]}})",
               "/proxies/0/capsule/radius", "told from 0 beside each other");
  expect_error(sphere(R"("center": {"point": [0,0,0], "joints": [["Head", 1e9], ["Hips", 1e-320]]}, "radius": 1)"),
               s + "/center/joints", "told from 0 beside each other");
  expect_error(sphere(R"("joint": "Head", "center": [0,0], "radius": 1)"), s + "/center", "3 numbers");
  expect_error(sphere(R"("joint": "Head", "center": 5, "radius": 1)"), s + "/center", "[x, y, z]");
  expect_error(sphere(R"("joint": "Head", "center": [0,0,0], "radius": 1, "raduis": 1)"), s + "/raduis", "unknown key");
  expect_error(sphere(R"("center": [0,0,0], "radius": 1)"), s, "joint");
  expect_error(sphere(R"("joint": "Head", "center": {"joint": "Hips", "at": [0,0,0]}, "radius": 1)"), s + "/joint",
               "no \"joint\"");

  expect_error(R"({"name": "x"})", "/proxies/0", "neither");
  expect_error(R"({"sphere": {}, "capsule": {}})", "/proxies/0", "both");
  expect_error(R"({"sphere": {"joint": "Head", "center": [0,0,0], "radius": 1}, "shape": 1})", "/proxies/0/shape",
               "unknown key");
  expect_error(R"({"name": "", "sphere": {"joint": "Head", "center": [0,0,0], "radius": 1}})", "/proxies/0/name",
               "not empty");
  expect_error(R"({"friction": -1, "sphere": {"joint": "Head", "center": [0,0,0], "radius": 1}})",
               "/proxies/0/friction", "0 or above");
  expect_error(R"({"enabled": 1, "sphere": {"joint": "Head", "center": [0,0,0], "radius": 1}})", "/proxies/0/enabled",
               "true or false");

  expect_error(capsule("[0,0,0]"), "/proxies/0/capsule", "or a \"sphere\"");
  expect_error(capsule(R"({"between": ["Hips", "Head"], "at": 1.5})"), b + "/at", "from 0");
  expect_error(capsule(R"({"between": ["Hips", "Head"], "at": -0.1})"), b + "/at", "from 0");
  expect_error(capsule(R"({"between": ["Hips", "Head"]})"), b, "\"at\"");
  expect_error(capsule(R"({"between": ["Hips"], "at": 0.5})"), b + "/between", "two joints");
  expect_error(capsule(R"({"between": ["Hips", "mixamorig:Hips"], "at": 0.5})"), b + "/between",
               "two different joints");
  expect_error(capsule(R"({"between": ["Hips", "Tail"], "at": 0.5})"), b + "/between/1", "Tail");
  expect_error(capsule(R"({"bone": "Hips"})"), b + "/bone", "unknown key");
  expect_error(capsule(R"({"point": [0,0,0], "joints": []})"), b + "/joints", "1 to 4");
  expect_error(capsule(R"({"point": [0,0,0], "joints": [["Hips",1],["Hips",1],["Hips",1],["Hips",1],["Hips",1]]})"),
               b + "/joints", "1 to 4");
  expect_error(capsule(R"({"point": [0,0,0], "joints": [["Hips",1],["Hips",1]]})"), b + "/joints/1/0", "once");
  expect_error(capsule(R"({"point": [0,0,0], "joints": [["Hips",0]]})"), b + "/joints/0/1", "above 0");
  expect_error(capsule(R"({"point": [0,0,0], "joints": [["Hips"]]})"), b + "/joints/0", "weight");
  expect_error(capsule(R"({"point": [0,0,0], "joints": [["Hips",1e308],["Head",1e308]]})"), b + "/joints/0/1",
               "finite");

  expect_error(R"({"name": "x", )" + ball.substr(1) + R"(, {"name": "x", )" + ball.substr(1), "/proxies/1",
               "second time");
  EXPECT_THROW(read_one(sphere(R"("joint": "Head", "center": [1e999,0,0], "radius": 1)")), InputError);
  EXPECT_THROW(read_one(sphere(R"("joint": "Head", "center": [NaN,0,0], "radius": 1)")), InputError);
  EXPECT_THROW(read_text("[]"), InputError);
  EXPECT_THROW(read_text("{}"), InputError);
  EXPECT_THROW(read_text(R"({"proxies": {}})"), InputError);
  EXPECT_THROW(read_proxies("no/such/file.json", small_skeleton()), InputError);
  EXPECT_TRUE(read_text(R"({"proxies": []})").empty());
  EXPECT_THROW(read_one(ball).at(1), std::out_of_range); // the ball itself is good
}

void expect_same(const Anchor& p, const Anchor& q) {
  ASSERT_EQ(p.count, q.count);
  for (int k = 0; k < p.count; ++k) {
    EXPECT_EQ(p.joints[k], q.joints[k]);
    EXPECT_NEAR(p.weights[k], q.weights[k], 1e-15);
    EXPECT_LE((p.points[k] - q.points[k]).lpNorm<Eigen::Infinity>(), 1e-15);
  }
}

TEST(ProxyFile, RoundTripIsExact) {
  const rig::Skeleton skeleton = small_skeleton();
  const std::vector<Transform> rest = rig::rest_model(skeleton);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.01, 1.0);
  const auto anchor = [&](int form) {
    Anchor result;
    const Vec3 point = test::random_point(random, 0.5);
    result.count = form == 0 ? 1 : form == 1 ? 2 : 4;
    double sum = 0.0;
    for (int k = 0; k < result.count; ++k) {
      result.joints[k] = (k + 2) % 4;
      result.weights[k] = uniform(random);
      sum += result.weights[k];
      result.points[k] = form == 1 ? Vec3(Vec3::Zero()) : rest[result.joints[k]].inverse() * point;
    }
    for (int k = 0; k < result.count; ++k) result.weights[k] /= sum;
    return result;
  };
  std::vector<Proxy> written;
  for (int i = 0; i < 60; ++i) {
    Proxy proxy;
    proxy.name = "proxy \"" + std::to_string(i) + "\"";
    proxy.kind = i % 2 ? ProxyKind::capsule : ProxyKind::sphere;
    proxy.a = anchor(i % 3);
    proxy.b = i % 2 ? anchor(i / 3 % 3) : proxy.a;
    proxy.radius = uniform(random);
    if (i % 4 == 1) proxy.taper = uniform(random) - proxy.radius;
    if (i % 4 == 3) proxy.radius = 0.001 * (1 + i), proxy.taper = 0.08321 - proxy.radius; // decimals stay decimals
    proxy.friction = uniform(random);
    proxy.enabled = i % 7 != 0;
    written.push_back(proxy);
  }
  const auto folder = test::scratch_folder();
  write_proxies(folder / "first.json", written, skeleton);
  const std::vector<Proxy> read = read_proxies(folder / "first.json", skeleton);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].name, written[i].name);
    EXPECT_EQ(read[i].kind, written[i].kind);
    EXPECT_EQ(read[i].radius, written[i].radius);
    EXPECT_NEAR(read[i].taper, written[i].taper, 1e-15);
    if (i % 4 == 3) {
      EXPECT_EQ(read[i].taper, written[i].taper);
    }
    EXPECT_EQ(read[i].friction, written[i].friction);
    EXPECT_EQ(read[i].enabled, written[i].enabled);
    expect_same(read[i].a, written[i].a);
    expect_same(read[i].b, written[i].b);
  }
  EXPECT_THAT(read_file(folder / "first.json"), HasSubstr(",0.08321]"));
  write_proxies(folder / "none.json", {}, skeleton);
  EXPECT_TRUE(read_proxies(folder / "none.json", skeleton).empty());
}

TEST(ProxyFile, WhatAFileCannotSayIsNotWritten) {
  const rig::Skeleton skeleton = small_skeleton();
  const Proxy good =
      read_one(R"({"name": "x", "capsule": {"joint": "Head", "a": [0,0,0], "b": [0,1,0], "radius": 1}})")[0];
  const auto file = test::scratch_folder() / "refused.json";
  const auto expect_refused = [&](const std::vector<Proxy>& proxies) {
    EXPECT_THROW(write_proxies(file, proxies, skeleton), std::invalid_argument);
  };
  Proxy bad = good;
  bad.radius = -1.0;
  expect_refused({bad});
  bad = good;
  bad.taper = -1.0; // no radius is left at b
  expect_refused({bad});
  bad = good;
  bad.b = bad.a;
  expect_refused({bad});
  bad = good;
  bad.a.joints[0] = 17;
  expect_refused({bad});
  bad = good;
  bad.a.points[0].x() = std::numeric_limits<double>::quiet_NaN();
  expect_refused({bad});
  bad = good;
  bad.a.count = 2; // two joints that see different points
  bad.a.joints = {0, 1};
  bad.a.weights = {0.5, 0.5};
  bad.a.points = {Vec3(0, 0, 1), Vec3(0, 0, 2)};
  expect_refused({bad});
  bad.a.points = {Vec3::Zero(), Vec3::Zero()}; // a blend of origins, but of what weights
  bad.a.weights = {0.5, 0.6};
  expect_refused({bad});
  bad.a.weights = {1.5, -0.5};
  expect_refused({bad});
  bad.a.weights = {0.5, 0.5};
  bad.a.joints = {1, 1};
  expect_refused({bad});
  expect_refused({good, good}); // one name twice
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(ProxyFile, SchemaKnowsTheKeysOfTheReader) {
  const JsonValue schema = JsonValue::read(test::source_file("assets/schema/proxies.schema.json"));
  EXPECT_EQ(schema.at("$schema").string(), "http://json-schema.org/draft-07/schema#");
  const auto keys = [&](const char* name) {
    std::vector<std::string> found;
    for (const auto& [key, value] : schema.at("definitions").at(name).at("properties").members()) found.push_back(key);
    return found;
  };
  using ::testing::UnorderedElementsAre;
  EXPECT_THAT(keys("proxy"),
              UnorderedElementsAre("$schema", "comment", "name", "sphere", "capsule", "friction", "enabled"));
  EXPECT_THAT(keys("sphere"), UnorderedElementsAre("$schema", "comment", "joint", "center", "radius"));
  EXPECT_THAT(keys("capsule"), UnorderedElementsAre("$schema", "comment", "joint", "a", "b", "radius"));
}

} // namespace
