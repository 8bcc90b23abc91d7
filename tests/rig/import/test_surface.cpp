// Surfaces without joints, and files that are none.
#include "rig/error.h"
#include "rig/import/surface.h"
#include "rig/io/file_io.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>
#include <random>

using namespace tutu;
using namespace tutu::rig;

namespace {

const char* const k_models[] = {"OBJ/box.obj", "PLY/cube.ply", "PLY/cube_binary.ply", "STL/Spider_ascii.stl",
                                "STL/Spider_binary.stl"};

TEST(Surface, IsWhatTheFileSays) {
  const auto folder = test::scratch_folder();
  write_file(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const TriangleSurface surface = import_surface(folder / "a.obj");
  ASSERT_EQ(surface.positions.size(), 3u);
  EXPECT_EQ(surface.positions[1], Vec3(1, 0, 0));
  ASSERT_EQ(surface.triangles.size(), 1u);
  EXPECT_EQ(surface.triangles[0], (Triangle{0, 1, 2}));
  std::filesystem::remove_all(folder);
}

TEST(Surface, NoTwoPositionsAreTheSame) {
  for (const char* model : k_models) {
    const auto file = test::assimp_model(model);
    if (!std::filesystem::exists(file)) continue;
    const TriangleSurface surface = import_surface(file);
    const auto less = [](const Vec3& a, const Vec3& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    };
    std::vector<Vec3> sorted = surface.positions;
    std::sort(sorted.begin(), sorted.end(), less);
    EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end()) << model;
    for (const Triangle& t : surface.triangles) EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
  }
}

TEST(Surface, APointOutOfTheWorldIsNamed) {
  const auto folder = test::scratch_folder();
  const auto message = [&](const std::string& name, const std::string& text) {
    write_file(folder / name, text);
    try {
      import_surface(folder / name);
      return std::string();
    } catch (const InputError& error) {
      EXPECT_EQ(error.file(), (folder / name).string());
      return error.place() + ": " + error.found();
    }
  };
  const auto stl = [](const std::string& number) {
    return "solid sheet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
           "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 " +
           number + " 0\nvertex 0 1 1\nendloop\nendfacet\nendsolid sheet\n";
  };
  const auto ply = [](const std::string& number) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 " +
           number + "\n3 0 1 2\n";
  };
  const auto obj = [](const std::string& number) { return "v 0 0 0\nv 1 0 0\nv 0 1 " + number + "\nf 1 2 3\n"; };
  EXPECT_EQ(message("a.stl", stl("1e30")), "mesh sheet, vertex 4: the point 0 1.00000002e+30 0");
  EXPECT_EQ(message("a.stl", stl("1e39")), "mesh sheet: a non-finite position of vertex 4");
  EXPECT_EQ(message("a.ply", ply("-1.1e9")), "mesh mesh 1, vertex 2: the point 0 1 -1.1e+09");
  EXPECT_EQ(message("a.obj", obj("2e9")), "mesh defaultobject, vertex 2: the point 0 1 2e+09");
  EXPECT_EQ(message("a.stl", stl("1e9")), "");
  EXPECT_EQ(message("a.ply", ply("-1e9")), "");
  EXPECT_EQ(message("a.obj", obj("1e9")), "");
  for (const char* none : {"nan", "-inf", "1e999"}) EXPECT_NE(message("a.ply", ply(none)), "") << none;
  std::filesystem::remove_all(folder);
}

TEST(Surface, DamagedFilesAreReadOrRefusedButNeverCrash_slow) {
  const auto folder = test::scratch_folder();
  std::mt19937 random(1);
  int read = 0, refused = 0;
  for (const char* model : k_models) {
    const auto file = test::assimp_model(model);
    if (!std::filesystem::exists(file)) continue;
    const std::string whole = read_file(file);
    for (int trial = 0; trial < 12; ++trial) { // few bytes in most, so that some are read, and many in the others
      std::string damaged = whole;
      if (trial == 0)
        damaged.resize(random() % whole.size() + 1); // one: assimp never ends a PLY cut short; its box does
      const int flips = trial < 8 ? 1 + trial / 2 : 1 + 3 * trial;
      for (int k = 0; k < flips; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
      const auto copy = folder / ("damaged" + file.extension().string());
      write_file(copy, damaged);
      try {
        const TriangleSurface surface = import_surface(copy);
        ++read;
        for (const Triangle& t : surface.triangles)
          for (const std::uint32_t v : t) ASSERT_LT(v, surface.positions.size());
        for (const Vec3& p : surface.positions) ASSERT_TRUE(p.allFinite());
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  if (read + refused == 0) GTEST_SKIP() << "no models (Debian's assimp-testmodels)";
  EXPECT_GT(read, 5);
  EXPECT_GT(refused, 5);
  std::filesystem::remove_all(folder);
}

} // namespace
