// What a mesh is found to be, and which meshes are refused, in which words.
#include "proxies/body/body_mesh.h"
#include "rig/character.h"
#include "rig/import/import.h"
#include "rig/mannequin/mannequin.h"
#include "tests/support/paths.h"
#include "tests/support/solids.h"

#include <gmock/gmock.h>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

using namespace tutu;
using namespace tutu::proxies;
using namespace tutu::test;
using ::testing::HasSubstr;

namespace {

MeshCensus census_of(const Surface& surface) { return BodyMesh(surface.positions, surface.triangles).census(); }

std::string refusal_of(const Surface& surface) {
  try {
    BodyMesh(surface.positions, surface.triangles);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(MeshCensus, AClosedSurface) {
  const MeshCensus census = census_of(box_surface({0.5f, 1.0f, 2.0f}));
  EXPECT_EQ(census.vertices, 8);
  EXPECT_EQ(census.welded_vertices, 8);
  EXPECT_EQ(census.triangles, 12);
  EXPECT_EQ(census.shells, 1);
  EXPECT_EQ(census.open_edges + census.nonmanifold_edges + census.turned_triangles + census.flat_triangles, 0);
  EXPECT_NEAR(census.area, 2.0 * (2.0 + 8.0 + 4.0), 1e-12);
  EXPECT_NEAR(census.volume, 8.0, 1e-12);
  EXPECT_EQ(census.rule, SideRule::pseudonormal);
  EXPECT_EQ(census.reason, "one closed shell, all of its triangles the same way round");
}

TEST(MeshCensus, ASeamIsNoOpening) {
  const Surface whole = sphere_surface(0.3, 3);
  Surface cut = whole; // every triangle has corners of its own
  cut.positions.clear();
  for (rig::Triangle& t : cut.triangles)
    for (std::uint32_t& v : t) {
      cut.positions.push_back(whole.positions[v]);
      v = static_cast<std::uint32_t>(cut.positions.size() - 1);
    }
  const MeshCensus census = census_of(cut);
  EXPECT_EQ(census.vertices, 3 * census.triangles);
  EXPECT_EQ(census.welded_vertices, static_cast<int>(whole.positions.size()));
  EXPECT_EQ(census.open_edges, 0);
  EXPECT_EQ(census.rule, SideRule::pseudonormal);
  const BodyMesh a(cut.positions, cut.triangles), b(whole.positions, whole.triangles);
  for (const Vec3& vertex : whole.points()) // pseudonormals go across the seams
    EXPECT_EQ(a.signed_distance(1.001 * vertex).distance, b.signed_distance(1.001 * vertex).distance);
}

TEST(MeshCensus, OpenOverlappingAndSeveralShellsGoToTheWindingNumber) {
  Surface open = sphere_surface(0.3, 2);
  open.triangles.pop_back();
  EXPECT_EQ(census_of(open).rule, SideRule::winding_number);
  EXPECT_EQ(census_of(open).reason, "3 open edges");

  Surface nested = sphere_surface(0.3, 3);
  append(nested, sphere_surface(0.1, 1));
  EXPECT_EQ(census_of(nested).inner_shells, 1);
  EXPECT_EQ(census_of(nested).reason, "2 shells, 1 of them inside the others");
  const BodyMesh body(nested.positions, nested.triangles);
  EXPECT_NEAR(body.winding_number(Vec3::Zero()), 2.0, 1e-12);
  EXPECT_NEAR(body.signed_distance({0.11, 0, 0}).distance, -0.19, 0.01) << "measured to the outer shell";

  Surface apart = sphere_surface(0.3, 2);
  append(apart, sphere_surface(0.1, 1, {1.0f, 0.0f, 0.0f}));
  EXPECT_EQ(census_of(apart).reason, "2 shells");
}

TEST(MeshCensus, AShellThatPassesThroughItselfGoesToTheWindingNumber) {
  Surface limb = torus_surface(0.5, 0.2, 48, 24);
  for (Vec3f& p : limb.positions) // a ring, flattened until its near and far side overlap
    p.x() = p.x() > 0.0f ? p.x() - 0.4f : p.x() + 0.4f;
  const BodyMesh body(limb.positions, limb.triangles);
  EXPECT_EQ(body.census().rule, SideRule::winding_number);
  EXPECT_THAT(body.census().reason, HasSubstr("one closed shell that passes through itself ("));
  EXPECT_NEAR(body.winding_number({0.0, 0.01, 0.02}), 2.0, 1e-9);
  EXPECT_TRUE(body.is_inside({0.0, 0.01, 0.02}));
}

TEST(MeshCensus, ACavityIsNoInvertedShell) {
  Surface hollow = sphere_surface(0.3, 3);
  append(hollow, inside_out(sphere_surface(0.1, 2)));
  const BodyMesh body(hollow.positions, hollow.triangles);
  EXPECT_EQ(body.census().inverted_shells, 0);
  EXPECT_FALSE(body.is_inside(Vec3::Zero()));
  EXPECT_TRUE(body.is_inside({0.2, 0, 0}));
}

TEST(MeshCensus, NonManifoldEdgesGoToTheWindingNumber) {
  Surface pair = box_surface(Vec3f::Ones()); // two boxes that share an edge
  Surface other = box_surface(Vec3f::Ones());
  for (Vec3f& p : other.positions) p += Vec3f(2.0f, 2.0f, 0.0f);
  append(pair, other);
  const BodyMesh body(pair.positions, pair.triangles);
  EXPECT_EQ(body.census().nonmanifold_edges, 1);
  EXPECT_EQ(body.census().open_edges, 0);
  EXPECT_EQ(body.census().turned_triangles, 0);
  EXPECT_EQ(body.census().rule, SideRule::winding_number);
  EXPECT_THAT(body.census().reason, HasSubstr("1 edge of more than two triangles"));
  for (const double h : {1e-3, 1e-6}) {
    EXPECT_TRUE(body.is_inside({1 - h, 1 - h, 0}));
    EXPECT_TRUE(body.is_inside({1 + h, 1 + h, 0}));
    EXPECT_FALSE(body.is_inside({1 + h, 1 - h, 0}));
    EXPECT_FALSE(body.is_inside({1 - h, 1 + h, 0}));
  }
}

TEST(MeshCensus, APinchedVertexGoesToTheWindingNumber) {
  Surface pair = box_surface(Vec3f::Ones()); // two boxes that share a corner
  Surface other = box_surface(Vec3f::Ones());
  for (Vec3f& p : other.positions) p += Vec3f::Constant(2.0f);
  append(pair, other);
  EXPECT_EQ(census_of(pair).pinched_vertices, 1);
  EXPECT_EQ(census_of(pair).shells, 2);
  EXPECT_EQ(census_of(pair).rule, SideRule::winding_number);
}

TEST(MeshCensus, AFlatTriangleGoesToTheWindingNumber) {
  Surface box = box_surface(Vec3f::Ones());
  // Vertex 8 in the middle of the edge 1-3: (1, 2, 3) keeps it whole, (1, 8, 3) is what fills the gap, and no more.
  box.positions.emplace_back(1.0f, 0.0f, -1.0f);
  std::erase(box.triangles, rig::Triangle{1, 3, 5});
  for (const rig::Triangle& t : {rig::Triangle{1, 8, 5}, {8, 3, 5}, {1, 3, 8}}) box.triangles.push_back(t);
  const BodyMesh body(box.positions, box.triangles);
  EXPECT_EQ(body.census().flat_triangles, 1);
  EXPECT_EQ(body.census().open_edges, 0);
  EXPECT_EQ(body.census().rule, SideRule::winding_number);
  for (const double y : {-0.5, 0.0, 0.5}) {
    EXPECT_TRUE(body.is_inside({0.999, y, -0.999}));
    EXPECT_FALSE(body.is_inside({1.001, y, -1.001}));
  }
}

/// Turns over so many triangles, spread over the surface; returns which.
std::vector<std::size_t> turn_over(Surface& surface, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::size_t> chosen(surface.triangles.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  std::ranges::shuffle(chosen, random);
  chosen.resize(count);
  for (const std::size_t t : chosen) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
  return chosen;
}

/// The same cycle, whichever corner is the first.
bool same_way_round(const rig::Triangle& a, const rig::Triangle& b) {
  for (std::size_t c = 0; c < 3; ++c)
    if (a == rig::Triangle{b[c], b[(c + 1) % 3], b[(c + 2) % 3]}) return true;
  return false;
}

void expect_all_as(const BodyMesh& mended, const Surface& right) {
  std::size_t wrong = 0;
  for (std::size_t t = 0; t < right.triangles.size(); ++t)
    wrong += !same_way_round(mended.triangles()[t], right.triangles[t]);
  EXPECT_EQ(wrong, 0u);
}

TEST(MeshCensus, TrianglesTurnedOverAreMended) {
  const Surface right = sphere_surface(0.3, 4);
  const BodyMesh as_meant(right.positions, right.triangles);
  EXPECT_FALSE(note_of(as_meant.census()));
  // Some, most of them, and so many that neither is the many.
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{22}, right.triangles.size() / 2, right.triangles.size() - 5}) {
    Surface turned = right;
    turn_over(turned, count, 7 + count);
    const BodyMesh body(turned.positions, turned.triangles);
    expect_all_as(body, right);
    const MeshCensus& census = body.census();
    EXPECT_EQ(census.mended_triangles, static_cast<int>(count));
    EXPECT_EQ(census.turned_triangles, 0);
    EXPECT_EQ(census.rule, SideRule::pseudonormal);
    EXPECT_NEAR(census.volume, as_meant.census().volume, 1e-12);
    EXPECT_EQ(note_of(census),
              std::to_string(count) + (count == 1 ? " triangle was" : " triangles were") + " turned over: mended");
    for (const Vec3& p : {Vec3(0.1, 0.2, 0.05), Vec3(0.25, 0.2, -0.2), Vec3(0, 0.299, 0)})
      EXPECT_EQ(body.signed_distance(p).distance, as_meant.signed_distance(p).distance);
  }
}

TEST(MeshCensus, MendingKeepsCavitiesAndSeams) {
  Surface right = sphere_surface(0.3, 3);
  append(right, inside_out(sphere_surface(0.1, 2)));
  Surface cut{{}, right.triangles}; // every triangle has corners of its own
  for (rig::Triangle& t : cut.triangles)
    for (std::uint32_t& v : t) {
      cut.positions.push_back(right.positions[v]);
      v = static_cast<std::uint32_t>(cut.positions.size() - 1);
    }
  Surface turned = cut;
  turn_over(turned, 40, 3);
  const BodyMesh body(turned.positions, turned.triangles);
  expect_all_as(body, cut);
  EXPECT_EQ(body.census().mended_triangles, 40);
  EXPECT_FALSE(body.is_inside(Vec3::Zero()));
  EXPECT_TRUE(body.is_inside({0.2, 0, 0}));
}

TEST(MeshCensus, OfAnOpenShellOnlyFewTrianglesAreMended) {
  Surface right = sphere_surface(0.3, 4);
  right.triangles.resize(right.triangles.size() - 40);
  Surface few = right, many = right;
  turn_over(few, right.triangles.size() / 20, 1);
  turn_over(many, right.triangles.size() / 5, 2);
  const BodyMesh body(few.positions, few.triangles);
  expect_all_as(body, right);
  EXPECT_EQ(body.census().mended_triangles, static_cast<int>(right.triangles.size() / 20));
  EXPECT_THAT(refusal_of(many), HasSubstr("% of the surface turned over against its neighbours"));
  EXPECT_THAT(refusal_of(many), HasSubstr("recalculate its normals to the outside"));
}

TEST(MeshCensus, TheDancerWithTrianglesTurnedOverIsMended) {
  const rig::Mesh dancer = rig::make_mannequin().surface;
  const Surface right{dancer.positions, dancer.triangles};
  Surface turned = right;
  turn_over(turned, 74, 74);
  const BodyMesh body(turned.positions, turned.triangles);
  expect_all_as(body, right);
  EXPECT_EQ(body.census().mended_triangles, 74);
  EXPECT_EQ(body.census().reason, census_of(right).reason);
}

TEST(MeshCensus, MeshesWithoutSidesAreRefused) {
  const Surface box = box_surface(Vec3f::Ones());
  EXPECT_EQ(refusal_of({box.positions, {}}), "body mesh: found no triangle, expected a surface");

  Surface broken = box;
  broken.positions[3].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal_of(broken), "body mesh: found vertex 3 at no finite place, expected finite positions");
  broken = box;
  broken.triangles[5][1] = 8;
  EXPECT_EQ(refusal_of(broken), "body mesh: found vertex 8 in triangle 5, expected indices below 8");

  EXPECT_EQ(refusal_of({{Vec3f::Zero(), Vec3f::UnitX(), 2 * Vec3f::UnitX()}, {{0, 1, 2}}}),
            "body mesh: found no triangle with an area, expected a surface");
  EXPECT_EQ(
      refusal_of({{Vec3f::Zero(), Vec3f::UnitX(), Vec3f::UnitY()}, {{0, 1, 2}}}),
      "body mesh: found a surface that encloses nothing, expected a body: give it thickness, or delete the one of "
      "doubled triangles");
  Surface both_sides = box;
  append(both_sides, inside_out(box));
  EXPECT_EQ(
      refusal_of(both_sides),
      "body mesh: found a surface that encloses nothing, expected a body: give it thickness, or delete the one of "
      "doubled triangles");

  EXPECT_EQ(
      refusal_of(inside_out(sphere_surface(1.0, 3))),
      "body mesh: found a body turned inside out, expected triangles that run counter-clockwise seen from outside: "
      "recalculate its normals to the outside where it was modelled");
  Surface open = sphere_surface(1.0, 3);
  open.triangles.resize(open.triangles.size() - 60);
  EXPECT_THAT(refusal_of(inside_out(open)), HasSubstr("a body turned inside out"));

  Surface limb = sphere_surface(1.0, 3);
  append(limb, inside_out(sphere_surface(0.4, 2, {2.0f, 0.0f, 0.0f})));
  EXPECT_THAT(refusal_of(limb), HasSubstr("1 shell with 5."));
  EXPECT_THAT(refusal_of(limb), HasSubstr("% of the volume turned inside out"));

  Surface half = open; // of which nobody knows which half is right
  for (rig::Triangle& t : half.triangles)
    if (half.positions[t[0]].y() > 0.5f) std::swap(t[1], t[2]);
  EXPECT_THAT(refusal_of(half), HasSubstr("% of the surface turned over against its neighbours"));

  // A Moebius band, as thick as nothing.
  Surface band;
  for (int i = 0; i < 40; ++i) {
    const double u = 2.0 * M_PI * i / 40;
    for (const double v : {-0.2, 0.2})
      band.positions.push_back(Vec3((1 + v * std::cos(0.5 * u)) * std::cos(u), v * std::sin(0.5 * u),
                                    (1 + v * std::cos(0.5 * u)) * std::sin(u))
                                   .cast<float>());
    const auto at = [&](int k, int side) { return static_cast<std::uint32_t>(k < 40 ? 2 * k + side : 1 - side); };
    band.triangles.push_back({at(i, 0), at(i, 1), at(i + 1, 0)});
    band.triangles.push_back({at(i + 1, 0), at(i, 1), at(i + 1, 1)});
  }
  EXPECT_THAT(refusal_of(band), HasSubstr("body mesh: found a one-sided surface, expected a body: take out"));
}

TEST(MeshCensus, APoseMustFit) {
  const Surface box = box_surface(Vec3f::Ones());
  BodyMesh body(box.positions, box.triangles);
  std::vector<Vec3> positions = box.points();
  positions.pop_back();
  EXPECT_THROW(body.pose(positions), std::invalid_argument);
  positions.emplace_back(0.0, std::numeric_limits<double>::infinity(), 0.0);
  EXPECT_THROW(body.pose(positions), std::invalid_argument);
  EXPECT_THROW(body.nearest({0.0, std::nan(""), 0.0}, 1.0), std::invalid_argument);
}

TEST(MeshCensus, RealCharacters) {
  const auto census = [](const std::filesystem::path& file) {
    const rig::Mesh mesh = rig::import_character(file).character.mesh;
    return BodyMesh(mesh.positions, mesh.triangles).census();
  };
  const MeshCensus open = census(assimp_model("X/BCN_Epileptic.X"));
  EXPECT_EQ(open.rule, SideRule::winding_number);
  EXPECT_EQ(open.reason, "6 shells, 130 open edges"); // torso, head and legs; eyes and the like are shells too
  const MeshCensus wuson = census(assimp_model("X/Testwuson.X"));
  EXPECT_LT(wuson.welded_vertices, wuson.vertices);
  EXPECT_EQ(wuson.shells, 54);
}

} // namespace
