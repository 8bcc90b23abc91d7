// A scene that is run in a moment: a sheet, held along one edge, that lies on the end of a capsule.
#pragma once

#include "rig/io/file_io.h"
#include "tests/support/capsule_character.h"

#include <filesystem>
#include <fmt/format.h>
#include <string>

namespace tutu::test {

inline const proxies::Capsule k_small_trunk{{0, 0.3, 0}, {0, 0.7, 0}, 0.12};

/// Writes body.dae, motion.json, proxies.json, sheet.json and NAME.json into the folder; returns the scene's path.
/// `turn` is how far the body turns about its axis in 0.2 s, rad.
inline std::string write_small_scene(const std::filesystem::path& folder, const std::string& name = "small",
                                     double turn = 0.4) {
  const auto file = [&](const std::string& called, const std::string& text) { write_file(folder / called, text); };
  CapsuleBody body;
  body.add(k_small_trunk, 24, 6, 6);
  write_capsule_character(folder / "body.dae", body, {0, 0.5, 0});
  const std::string motion = name + "-motion.json";
  file(motion, fmt::format(R"({{"keys": [{{"time": 0, "joints": {{}}}},
      {{"time": 0.2, "joints": {{"Hips": {{"rotation": [0, {}, 0, {}]}}}}}}]}})",
                           std::sin(0.5 * turn), std::cos(0.5 * turn)));
  file("proxies.json", proxies_json({k_small_trunk}));
  file("sheet.json", R"({"name": "sheet", "shape": {"grid": {"rows": 9, "columns": 9, "corner": [-0.2, 0.84, -0.2],
      "across": [0.4, 0, 0], "down": [0, 0, 0.4]}},
      "fabric": {"density": 0.2, "stretch": 300, "shear": 10, "drag": 1, "thickness": 0.004, "clearance": 0.004},
      "attachments": [{"joint": "Hips", "rows": 0}]})");
  file(name + ".json", R"({"character": "body.dae", "motion": ")" + motion +
                           R"(", "proxies": "proxies.json", "garments": ["sheet.json"],
      "solver": {"name": "xpbd", "substeps": 8}})");
  return (folder / (name + ".json")).string();
}

} // namespace tutu::test
