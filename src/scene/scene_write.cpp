#include "src/scene/scene_write.h"

#include "rig/io/file_io.h"
#include "src/base/json_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// As the scene's folder sees it.
class Paths {
public:
  explicit Paths(const fs::path& scene) : folder_(fs::absolute(scene).parent_path()) {}
  std::string operator()(const fs::path& file) const {
    return fs::absolute(file).lexically_normal().lexically_proximate(folder_.lexically_normal()).generic_string();
  }

private:
  fs::path folder_;
};

ordered_json character_json(const SceneFiles& files, const Paths& paths) {
  const rig::ImportOptions standard;
  const rig::ImportOptions& import = files.import;
  ordered_json json = {{"file", paths(files.character)}};
  if (import.max_influences != standard.max_influences) json["max_influences"] = import.max_influences;
  if (import.height) json["height"] = *import.height;
  if (import.metres_per_unit) json["unit"] = *import.metres_per_unit;
  if (import.rest != standard.rest) json["rest"] = rig::k_rest_pose_names[static_cast<std::size_t>(import.rest)];
  return json.size() == 1 ? json["file"] : json;
}

ordered_json motion_json(const MotionSource& motion, const Paths& paths) {
  if (const auto* own = std::get_if<OwnMotion>(&motion)) {
    ordered_json json;
    std::visit([&](const auto& which) { json["animation"] = which; }, own->animation);
    return json;
  }
  if (const auto* texts = std::get_if<rig::ThreeTexts>(&motion)) {
    ordered_json json = {{"translations", paths(texts->translations)},
                         {"rotations", paths(texts->rotations)},
                         {"times", paths(texts->times)}};
    if (texts->joints) json["joints"] = paths(*texts->joints);
    return {{"texts", std::move(json)}};
  }
  if (const auto* take = std::get_if<MocapMotion>(&motion)) {
    ordered_json json = {{"bvh", paths(take->bvh)}};
    if (take->options.rest_frame) json["rest_frame"] = *take->options.rest_frame;
    json["from"] = take->options.from;
    if (take->options.to) json["to"] = *take->options.to;
    for (const auto& [name, joint] : take->joints)
      json["joints"][name] = joint ? ordered_json(*joint) : ordered_json(false);
    return json;
  }
  const auto& clip = std::get<ClipMotion>(motion);
  if (!clip.retarget_from) return paths(clip.clip);
  return {{"clip", paths(clip.clip)}, {"retarget_from", paths(*clip.retarget_from)}};
}

ordered_json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

ordered_json garment_json(const GarmentEntry& entry, const Paths& paths) {
  ordered_json json = {{"file", paths(entry.file)}};
  if (entry.scale != Vec3::Ones()) json["scale"] = numbers(entry.scale);
  if (entry.offset != Vec3::Zero()) json["offset"] = numbers(entry.offset);
  if (entry.resolution != 1.0) json["resolution"] = entry.resolution;
  return json.size() == 1 ? json["file"] : json;
}

ordered_json wind_json(const cloth::Wind& wind) {
  ordered_json json = {{"velocity", numbers(wind.velocity)}};
  if (wind.gusts)
    json["gusts"] = {{"speed", wind.gusts->speed}, {"period", wind.gusts->period}, {"seed", wind.gusts->seed}};
  return json;
}

} // namespace

void write_scene(const SceneDescription& d, const fs::path& file, const std::string& comment) {
  const Paths paths(file);
  ordered_json json;
  if (!comment.empty()) json["comment"] = comment;
  json["character"] = character_json(d, paths);
  json["motion"] = motion_json(d.motion, paths);
  if (d.interpolation) json["interpolation"] = rig::k_interpolation_names[static_cast<std::size_t>(*d.interpolation)];
  json["skinning"] = rig::k_skinning_names[static_cast<std::size_t>(d.skinning)];
  if (d.proxies) json["proxies"] = paths(*d.proxies);
  json["garments"] = ordered_json::array();
  for (const GarmentEntry& entry : d.garments) json["garments"].push_back(garment_json(entry, paths));
  if (!d.ground_height) json["ground"] = false;
  else json["ground"] = {{"height", *d.ground_height}};
  if (!d.wind.is_still()) json["wind"] = wind_json(d.wind);
  // What is left out is the standard; what the file would say of no use is refused when it is read.
  for (const SettingRow& row : settings_table()) {
    const double value = row.get(d.settings);
    if (value == row.standard() && std::find(d.stated.begin(), d.stated.end(), &row) == d.stated.end()) continue;
    if (row.is_choice()) json[row.section][row.key] = row.names[static_cast<std::size_t>(value)];
    else if (row.is_switch()) json[row.section][row.key] = value != 0.0;
    else if (value == std::floor(value)) json[row.section][row.key] = static_cast<int>(value);
    else json[row.section][row.key] = value;
  }
  json["drape"] = paths(d.drape);
  write_file(file, json_text(json));
}

} // namespace tutu::app
