// All that an engine needs: load, loop, read.   consumer SCENE.json [FRAMES]
// Anything may stand in the place of the clip: joints are world_from_joint transforms, one a joint of the skeleton.
#include "src/run/drape.h"
#include "src/run/runtime.h"
#include "src/scene/load.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  using namespace tutu;
  using namespace tutu::app;
  const int frames = argc > 2 ? std::atoi(argv[2]) : 240;
  const double seconds = 1.0 / 60.0;
  try {
    // Load. (Without files: fill in a Wearer, and put_on() its garments.)
    const LoadedScene scene = load_scene(read_scene(argc > 1 ? argv[1] : "scene.json"));
    std::vector<Transform> local(scene.character.skeleton.joint_count()), joints(local.size());
    const auto pose_at = [&](double time) { // here: your animation
      rig::pose_at(scene.motion, scene.character.skeleton, time, local, joints);
    };
    // Let the garments fall into place, once; keep what comes out of it.
    const DrapeResult draped = drape(scene, 4.0, [](int, int) { return true; });
    Runtime runtime(scene);
    pose_at(0.0);
    runtime.start(joints, draped.positions);

    std::vector<std::vector<Vec3>> normals;
    for (const cloth::Garment& garment : scene.garments) normals.emplace_back(garment.particle_count());
    std::vector<double> ms;
    for (int frame = 0; frame < frames && !runtime.failure(); ++frame) {
      const auto began = std::chrono::steady_clock::now();
      pose_at(runtime.time() + seconds);
      runtime.step(joints, seconds);
      ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count());
      // Read. These go to the screen, with garment.triangles.
      for (std::size_t g = 0; g < normals.size(); ++g) {
        [[maybe_unused]] const std::span<const Vec3> positions = runtime.positions(static_cast<int>(g));
        runtime.normals(static_cast<int>(g), normals[g]);
      }
    }
    if (runtime.failure()) std::fprintf(stderr, "%s\n", runtime.failure()->message().c_str());
    std::sort(ms.begin(), ms.end());
    std::printf("%d frames, median %.3f ms\nstate hash %016llx\n", runtime.frame(),
                ms.empty() ? 0.0 : ms[ms.size() / 2], static_cast<unsigned long long>(runtime.state_hash()));
    return runtime.failure() ? 1 : 0;
  } catch (const std::exception& error) { // InputError: file, place, found, expected
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
