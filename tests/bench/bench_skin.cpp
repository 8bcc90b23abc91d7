// Skinning a body of 25 000 vertices, on every SIMD target this processor has.
#include "rig/detail/skin_kernel.h"
#include "rig/skin.h"

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

using namespace tutu;
using namespace tutu::rig;

namespace {

constexpr int k_vertices = 25'000;

struct Body {
  Mesh mesh;
  Skin skin;
  std::vector<Transform> model;
};

/// Vertices in the order of a mesh: neighbours hang on much the same joints.
Body make_body(int joints, int influences) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::normal_distribution<double> gauss;
  Body body;
  body.skin.influences = influences;
  for (int j = 0; j < joints; ++j) {
    body.skin.slot_joint.push_back(j);
    body.skin.inverse_bind.push_back(Eigen::Affine3d(Eigen::Translation3d(0.0, -j * 1.7 / joints, 0.0)));
    body.model.push_back(
        {Quat(5.0, gauss(random), gauss(random), gauss(random)).normalized(), {0.0, j * 1.7 / joints, 0.0}});
  }
  for (int v = 0; v < k_vertices; ++v) {
    const float angle = 6.2831853f * uniform(random);
    body.mesh.positions.emplace_back(0.2f * std::cos(angle), 1.7f * static_cast<float>(v) / k_vertices,
                                     0.2f * std::sin(angle));
    body.mesh.normals.emplace_back(std::cos(angle), 0.0f, std::sin(angle));
    std::vector<float> weights(influences);
    float sum = 0.0f;
    for (float& w : weights) sum += w = uniform(random);
    std::sort(weights.rbegin(), weights.rend());
    for (int k = 0; k < influences; ++k) {
      const int near = static_cast<int>(static_cast<float>(v) / k_vertices * static_cast<float>(joints));
      body.skin.slots.push_back(static_cast<std::uint16_t>(std::clamp(near + k - influences / 2, 0, joints - 1)));
      body.skin.weights.push_back(weights[k] / sum);
    }
  }
  return body;
}

void report(benchmark::State& state) {
  state.counters["per vertex"] =
      benchmark::Counter(k_vertices, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void skin_body(benchmark::State& state, std::int64_t target, int joints, int influences, bool with_normals) {
  const Body body = make_body(joints, influences);
  std::vector<SkinMatrix> palette(joints);
  skinning_palette(body.skin, body.model, palette);
  std::vector<Vec3f> positions(k_vertices), normals(with_normals ? k_vertices : 0);
  hwy::SetSupportedTargetsForTest(target);
  state.SetLabel(skin_kernel_target());
  for (auto _ : state) {
    skin_vertices(body.mesh, body.skin, palette, positions, normals);
    benchmark::ClobberMemory();
  }
  hwy::SetSupportedTargetsForTest(0);
  report(state);
}

void skin_reference(benchmark::State& state) {
  const Body body = make_body(65, 4);
  std::vector<Vec3> positions(k_vertices), normals(k_vertices);
  for (auto _ : state) {
    skin_vertices_reference(body.mesh, body.skin, body.model, positions, normals);
    benchmark::ClobberMemory();
  }
  report(state);
}
BENCHMARK(skin_reference)->Unit(benchmark::kMicrosecond);

void make_palette(benchmark::State& state) {
  const Body body = make_body(65, 4);
  std::vector<SkinMatrix> palette(65);
  for (auto _ : state) {
    skinning_palette(body.skin, body.model, palette);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(make_palette)->Unit(benchmark::kMicrosecond);

// One benchmark a target, slot count and influence count; the targets are known only when running.
const bool k_registered = [] {
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  for (std::int64_t bit = 1; bit > 0 && bit <= supported; bit <<= 1) {
    if ((supported & bit) == 0) continue;
    for (const int influences : {4, 8}) {
      for (const int joints : {52, 65}) {
        for (const bool with_normals : {true, false}) {
          const std::string name = "skin/" + std::string(hwy::TargetName(bit)) +
                                   "/influences:" + std::to_string(influences) + "/slots:" + std::to_string(joints) +
                                   (with_normals ? "/normals" : "");
          benchmark::RegisterBenchmark(name.c_str(), skin_body, bit, joints, influences, with_normals)
              ->Unit(benchmark::kMicrosecond);
        }
      }
    }
  }
  return true;
}();

} // namespace
