// Every way of storing one body, and the models of a folder.
#pragma once

#include "tests/rig/import/gltf/gltf_body.h"

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <vector>

namespace tutu::test {

struct GltfKind {
  const char* name;
  BodyOptions options;
  double loss = 1e-6; ///< m, at most, to the same body in plain floats
  bool meshopt = false;
};
inline void PrintTo(const GltfKind& kind, std::ostream* out) { *out << kind.name; }

inline constexpr Stored k_byte{.component = k_int8, .normalized = true},
    k_short{.component = k_int16, .normalized = true};

inline const std::vector<GltfKind> k_gltf_kinds = {
    {"plain", {}},
    {"rotations_byte", {.rotations = k_byte}, 0.02},
    {"rotations_short", {.rotations = k_short}, 1e-4},
    {"weights_byte", {.weights = {.component = k_uint8, .normalized = true}}, 0.005},
    {"weights_short", {.weights = {.component = k_uint16, .normalized = true}}, 1e-4},
    {"joints_short_indices_int", {.joints = k_uint16, .indices = k_uint32}},
    {"indices_byte", {.indices = k_uint8}},
    {"interleaved", {.positions = {.gap = 8}, .weights = {.gap = 4}}},
    {"sparse", {.positions = {.is_sparse = true}, .rotations = {.is_sparse = true}}},
    {"quantized_short", {.positions = {.component = k_int16, .normalized = true, .gap = 2}, .quantized = true}, 1e-4},
    {"quantized_whole", {.positions = {.component = k_int16, .gap = 2}, .quantized = true}, 1e-3},
    {"quantized_byte", {.positions = {.component = k_int8, .normalized = true, .gap = 1}, .quantized = true}, 0.03},
    {"step", {.law = "STEP"}, 3.0},
    {"cubic", {.law = "CUBICSPLINE"}, 3.0},
    {"no_indices", {.has_indices = false}},
    {"strip", {.mode = 5}, 3.0},
    {"fan", {.mode = 6}, 3.0},
    {"strip_without_indices", {.has_indices = false, .mode = 5}, 3.0},
    {"two_sets", {.second_set = true}},
    {"children_first", {.children_first = true}},
    {"matrices", {.matrices = true}},
    {"morph", {.morph = 0.75}, 0.2},
    {"morph_sparse_without_bytes", {.morph = 1.0, .sparse_morph = true}, 0.25},
    {"no_inverse_binds", {.has_inverse_binds = false}, 3.0},
    {"draco_sequential", {.draco = draco::MESH_SEQUENTIAL_ENCODING}},
    {"draco_edgebreaker", {.draco = draco::MESH_EDGEBREAKER_ENCODING}},
    {"draco_weights_byte",
     {.weights = {.component = k_uint8, .normalized = true}, .draco = draco::MESH_SEQUENTIAL_ENCODING},
     0.005},
    {"meshopt", {}, 1e-6, true},
    {"meshopt_quantized",
     {.positions = {.component = k_int16, .normalized = true, .gap = 2},
      .weights = {.component = k_uint8, .normalized = true},
      .quantized = true},
     0.005,
     true},
    {"meshopt_filters",
     {.normals = {.component = k_int16, .normalized = true, .filter = "OCTAHEDRAL"},
      .rotations = {.component = k_int16, .normalized = true, .filter = "QUATERNION"},
      .translations = {.filter = "EXPONENTIAL"}},
     1e-4,
     true},
    {"meshopt_strip", {.indices = k_uint32, .mode = 5}, 3.0, true},
    {"meshopt_sparse", {.positions = {.is_sparse = true}}, 1e-6, true},
};

/// Every model of these folders that has a skin, or draws anything at all.
inline std::vector<std::filesystem::path> gltf_models_in(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

} // namespace tutu::test
