// What comes back from a reader is believed value by value or not at all, whatever bytes they are.
#include "rig/error.h"
#include "rig/import/detail/isolated.h"
#include "tests/rig/import/other_process.h"
#include "tests/rig/import/tiny_collada.h"
#include "tests/rig/import/tiny_glb.h"

#include <cstring>
#include <gmock/gmock.h>
#include <limits>
#include <random>
#include <sys/resource.h>

using namespace tutu;
using namespace tutu::rig;
using namespace tutu::rig::import_detail;
using namespace tutu::test;
using ::testing::HasSubstr;

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr float k_nan_float = std::numeric_limits<float>::quiet_NaN();

template <typename T> std::string packed(T value) {
  return answer_of([&](Packer& packer) { pass(packer, value); });
}

/// With joints, a clip, parts and a note.
Import sound_import() {
  Import import = import_character(write_text("tiny.glb", tiny_glb()));
  import.report.notes = {"a note"};
  import.clips.at(0).joints.at(0).rotation = {
      {0.0, 1.0}, {Quat(0.6, 0, 0.8, 0).coeffs(), Quat::Identity().coeffs()}, {Law::linear, Law::step}, {}, {}};
  return import;
}
TriangleSurface sound_surface() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}}; }

/// What stands behind the importer does with it.
void use(const Import& import) {
  const Character& c = import.character;
  skinned(c, rest_model(c.skeleton));
  std::vector<Transform> local(c.skeleton.rest_local);
  for (const ChannelClip& clip : import.clips)
    for (const double time : {-1.0, 0.0, 0.3, 9.0}) sample(clip, time, local);
  for (const MeshPart& part : c.mesh.parts)
    for (std::uint32_t t = 0; t < part.triangle_count; ++t) ASSERT_LT(t + part.first_triangle, c.mesh.triangles.size());
}
void use(const TriangleSurface& surface) {
  for (const Triangle& t : surface.triangles)
    ASSERT_GE(triangle_area(surface.positions[t[0]], surface.positions[t[1]], surface.positions[t[2]]), 0.0);
}

enum class Verdict { believed, refused };

template <typename Unpack> Verdict verdict_of(const std::string& bytes, Unpack unpack) {
  try {
    use(unpack(bytes, "file"));
    return Verdict::believed;
  } catch (const InputError&) {
  } catch (const std::runtime_error&) {
  }
  return Verdict::refused;
}

TEST(ImportAnswer, ComesBackAsItWent) {
  const Import before = sound_import(), after = unpack_import(packed(before), "file.glb");
  EXPECT_EQ(after.character.file, "file.glb");
  EXPECT_EQ(after.character.skeleton.names, before.character.skeleton.names);
  EXPECT_EQ(after.character.mesh.positions, before.character.mesh.positions);
  EXPECT_EQ(after.character.mesh.triangles, before.character.mesh.triangles);
  EXPECT_EQ(after.character.skin.weights, before.character.skin.weights);
  ASSERT_EQ(after.clips.size(), 1u);
  EXPECT_EQ(after.clips[0].file, "file.glb");
  ASSERT_EQ(after.clips[0].joints.size(), before.clips[0].joints.size());
  EXPECT_EQ(after.clips[0].joints[0].rotation.values, before.clips[0].joints[0].rotation.values);
  EXPECT_EQ(after.clips[0].joints[0].rotation.laws, before.clips[0].joints[0].rotation.laws);
  EXPECT_EQ(after.report.notes, before.report.notes);
  const TriangleSurface surface = unpack_surface(packed(sound_surface()), "file.stl");
  EXPECT_EQ(surface.positions, sound_surface().positions);
  EXPECT_EQ(surface.triangles, sound_surface().triangles);
}

TEST(ImportAnswer, NoValueThatCannotBeIsBelieved) {
  const Import sound = sound_import();
  const auto message = [&](const std::function<void(Import&)>& spoil) {
    Import import = sound;
    spoil(import);
    try {
      unpack_import(packed(import), "file");
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(message([](Import&) {}), "");
  EXPECT_EQ(message([](Import& i) { i.character.mesh.positions[0].x() = k_nan_float; }),
            "file: positions: found a file that leads its reader astray, expected a rigged character");
  using Spoil = void (*)(Import&);
  const Spoil spoils[] = {
      [](Import& i) { i.character.skeleton = {}; },
      [](Import& i) { i.character.skeleton.names[1] = i.character.skeleton.names[0]; },
      [](Import& i) { i.character.skeleton.names[0] = "a\nb"; },
      [](Import& i) { i.character.skeleton.names[0] = "\xff"; },
      [](Import& i) { i.character.skeleton.names[0] = std::string(100'000, 'x'); },
      [](Import& i) { i.character.skeleton.parents[1] = 1; },
      [](Import& i) { i.character.skeleton.parents[0] = -2; },
      [](Import& i) { i.character.skeleton.parents.pop_back(); },
      [](Import& i) { i.character.skeleton.rest_local.pop_back(); },
      [](Import& i) { i.character.skeleton.rest_local[0].rotation.w() = 2; },
      [](Import& i) { i.character.skeleton.rest_local[0].rotation.w() = k_nan; },
      [](Import& i) { i.character.skeleton.rest_local[0].translation.x() = 1e10; },
      [](Import& i) { i.character.mesh.positions[0].x() = 2e9f; },
      [](Import& i) { i.character.mesh.positions.pop_back(); },
      [](Import& i) { i.character.mesh.normals[0] *= 2.0f; },
      [](Import& i) { i.character.mesh.normals[0].x() = k_nan_float; },
      [](Import& i) { i.character.mesh.normals.pop_back(); },
      [](Import& i) { i.character.mesh.triangles[0][1] = 3; },
      [](Import& i) {
        i.character.mesh.triangles.push_back({0, 1, 2});
      },
      [](Import& i) { i.character.mesh.parts.clear(); },
      [](Import& i) { i.character.mesh.parts[0].first_triangle = 1; },
      [](Import& i) { i.character.mesh.parts[0].triangle_count = ~0u; },
      [](Import& i) { i.character.mesh.parts[0].name = "\x7f"; },
      [](Import& i) { i.character.mesh.parts[0].colour[1] = k_nan_float; },
      [](Import& i) { i.character.skin.influences = 5; },
      [](Import& i) { i.character.skin.influences = 8; },
      [](Import& i) { i.character.skin.slot_joint[0] = 2; },
      [](Import& i) { i.character.skin.slot_joint[0] = -1; },
      [](Import& i) { i.character.skin.inverse_bind[0](0, 0) = k_nan; },
      [](Import& i) { i.character.skin.inverse_bind.pop_back(); },
      [](Import& i) { i.character.skin.slots[0] = 2; },
      [](Import& i) { i.character.skin.slots.pop_back(); },
      [](Import& i) { i.character.skin.weights[0] = k_nan_float; },
      [](Import& i) { i.character.skin.weights[0] = 0.5f; },
      [](Import& i) { i.character.skin.weights[0] += 0.25f, i.character.skin.weights[1] -= 0.25f; },
      [](Import& i) { i.clips[0].name = "\x1b[2J"; },
      [](Import& i) { i.clips[0].joints.clear(); },
      [](Import& i) { i.clips[0].still.pop_back(); },
      [](Import& i) { i.clips[0].still[0].translation.x() = k_nan; },
      [](Import& i) { i.clips[0].still[0].rotation = Quat(2, 0, 0, 0); },
      [](Import& i) { i.clips[0].start = k_nan; },
      [](Import& i) { i.clips[0].end = i.clips[0].start - 1.0; },
      [](Import& i) { i.clips[0].joints[0].joint = 1000; },
      [](Import& i) { i.clips[0].joints[0].joint = -1; },
      [](Import& i) { i.clips[0].joints[0].rotation.times[0] = k_nan; },
      [](Import& i) { i.clips[0].joints[0].rotation.times[0] = 1e3; },
      [](Import& i) { i.clips[0].joints[0].rotation.laws[0] = Law::cubic; },
      [](Import& i) { i.clips[0].joints[0].rotation.laws.pop_back(); },
      [](Import& i) { i.clips[0].joints[0].rotation.values[0] *= 2.0; },
      [](Import& i) { i.clips[0].joints[0].rotation.values.pop_back(); },
      [](Import& i) { i.clips[0].joints[0].rotation.values[0].x() = k_nan; },
      [](Import& i) { i.report.format = "\r"; },
      [](Import& i) { i.report.up_axis = "\t"; },
      [](Import& i) { i.report.height = k_nan; },
      [](Import& i) { i.report.metres_per_unit = -1; },
      [](Import& i) { i.report.largest_cut = std::numeric_limits<double>::infinity(); },
      [](Import& i) { i.report.file_vertices = -1; },
      [](Import& i) { i.report.notes[0] = "a\nb"; },
  };
  for (const Spoil& spoil : spoils) EXPECT_NE(message(spoil), "") << &spoil - spoils;
}

TEST(ImportAnswer, NoSurfaceThatCannotBeIsBelieved) {
  using Spoil = void (*)(TriangleSurface&);
  const Spoil spoils[] = {
      [](TriangleSurface& s) { s.positions[0].x() = k_nan; }, [](TriangleSurface& s) { s.positions[0].x() = -1.1e9; },
      [](TriangleSurface& s) { s.positions.pop_back(); }, [](TriangleSurface& s) { s.triangles.clear(); },
      [](TriangleSurface& s) { s.triangles[0][0] = 4; }};
  for (const Spoil& spoil : spoils) {
    TriangleSurface surface = sound_surface();
    spoil(surface);
    EXPECT_THROW(unpack_surface(packed(surface), "file"), InputError) << &spoil - spoils;
  }
  EXPECT_THROW(unpack_surface(packed(sound_surface()) + "x", "file"), std::runtime_error);
}

TEST(ImportAnswer, ABoolIsOneOfTwo) {
  for (int byte = 0; byte < 256; ++byte) {
    const char bytes[] = {static_cast<char>(byte)};
    const auto read = [&] {
      Unpacker unpacker(std::string_view(bytes, 1));
      bool value = false;
      pass(unpacker, value);
      return value;
    };
    if (byte > 1) {
      EXPECT_THROW(read(), std::runtime_error) << byte;
    } else {
      EXPECT_EQ(read(), byte == 1);
    }
  }
}

TEST(ImportAnswer, ErrorsComeAcrossInPlainText) {
  const std::string answer =
      answer_of([](Packer&) { throw InputError("file", "mesh a\nb", "name \x1b[2J\xff", "a\tcharacter"); });
  try {
    unpack_import(answer, "file");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "file: mesh a_b: found name _[2J_, expected a_character");
  }
  EXPECT_THROW(unpack_import(answer_of([](Packer&) { throw std::bad_alloc(); }), "file"), InputError);
  EXPECT_THROW(unpack_import(answer_of([](Packer&) { throw std::length_error("long"); }), "file"), std::runtime_error);
}

TEST(ImportAnswer, AClaimTakesNoMemory) {
  const std::string whole = packed(sound_import());
  const std::string message = message_in_process([&] {
    if (!k_sanitized) {
      const rlimit little = {std::uintmax_t{1} << 30, std::uintmax_t{1} << 30};
      ::setrlimit(RLIMIT_AS, &little);
    }
    for (std::size_t at = 1; at < whole.size(); ++at) // one of these is each count
      for (const std::uint64_t claim : {std::uint64_t{1} << 20, std::uint64_t{1} << 32, ~std::uint64_t{0}}) {
        std::string bytes = whole;
        std::memcpy(bytes.data() + at, &claim, std::min(sizeof claim, bytes.size() - at));
        bytes.resize(bytes.size() + (2 << 20)); // so that the smallest claim is possible
        if (verdict_of(bytes, unpack_import) != Verdict::refused) throw std::runtime_error("believed");
      }
  });
  EXPECT_EQ(message, "");
}

TEST(ImportAnswer, FlippedBits) {
  std::mt19937_64 random(13);
  const auto count_believed = [&](const std::string& whole, auto unpack) {
    int believed = 0;
    for (int i = 0; i < 10'000; ++i) {
      std::string bytes = whole;
      for (int flips = 1 + i % 3; flips > 0; --flips) {
        char& byte = bytes[random() % bytes.size()];
        byte = static_cast<char>(byte ^ (1 << random() % 8));
      }
      believed += verdict_of(bytes, unpack) == Verdict::believed;
    }
    return believed;
  };
  const int import = count_believed(packed(sound_import()), unpack_import);
  EXPECT_GT(import, 1'000);
  EXPECT_LT(import, 9'000);
  const int surface = count_believed(packed(sound_surface()), unpack_surface);
  EXPECT_GT(surface, 1'000);
  EXPECT_LT(surface, 9'000);
}

TEST(ImportAnswer, BytesOfChance) {
  std::mt19937_64 random(14);
  const auto count_believed = [&](const std::string& whole, auto unpack) {
    int believed = 0;
    for (int i = 0; i < 10'000; ++i) {
      std::string bytes = whole.substr(0, random() % whole.size());
      for (std::size_t more = random() % 64; more > 0; --more)
        bytes += static_cast<char>(random() % 3 ? random() : 0); // zeros make small counts
      believed += verdict_of(bytes, unpack) == Verdict::believed;
    }
    return believed;
  };
  EXPECT_EQ(count_believed(packed(sound_import()), unpack_import), 0);
  EXPECT_LT(count_believed(packed(sound_surface()), unpack_surface), 1'000);
  for (const char first : {'d', 'i', 'o', 'm', 'x'})
    for (std::size_t size = 0; size < 64; ++size) {
      std::string bytes(size, '\0');
      if (size > 0) bytes[0] = first;
      EXPECT_EQ(verdict_of(bytes, unpack_import), Verdict::refused);
      EXPECT_EQ(verdict_of(bytes, unpack_surface), Verdict::refused);
    }
}

} // namespace
