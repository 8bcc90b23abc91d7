// Scenes: read, written, and read again.
#include "src/scene/scene_file.h"
#include "src/scene/scene_write.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {

void fuzz_scene(std::string_view input) {
  // Files that a scene may name: all that is asked of them is that they are there.
  for (static bool first = true; first; first = false)
    for (const char* name : {"body.dae", "motion.json", "proxies.json", "sheet.json", "take.bvh", "translations.txt",
                             "rotations.txt", "times.txt", "joints.txt"})
      write_input("", name);
  const app::SceneDescription scene = app::read_scene(write_input(input, "scene.json"));
  app::write_scene(scene, scratch() / "first.json");
  app::write_scene(app::read_scene(scratch() / "first.json"), scratch() / "second.json");
  require(text_of(scratch() / "first.json") == text_of(scratch() / "second.json"), "a scene reads back as written");
}

} // namespace tutu::fuzz
