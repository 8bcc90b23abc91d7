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

TEST(Surface, DamagedFilesAreReadOrRefusedButNeverCrash_slow) {
  const auto folder = test::scratch_folder();
  std::mt19937 random(8);
  int read = 0, refused = 0;
  for (const char* model : k_models) {
    const auto file = test::assimp_model(model);
    if (!std::filesystem::exists(file)) continue;
    const std::string whole = read_file(file);
    for (int trial = 0; trial < 8; ++trial) {
      std::string damaged = whole;
      if (trial % 4 == 0) damaged.resize(random() % whole.size() + 1);
      for (int k = 0; k < 1 + 3 * trial; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
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
