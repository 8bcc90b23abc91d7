#include "src/scene/scene_file.h"

#include "cloth/garment/garment_file.h"
#include "rig/io/json_file.h"

#include <fmt/format.h>
#include <limits>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

/// A path of the scene, from the scene's folder.
fs::path path_in(const JsonValue& json) {
  const std::string text = json.string();
  if (text.empty() || text.find('\0') != std::string::npos) throw json.error("a path");
  return (fs::path(json.file()).parent_path() / text).lexically_normal();
}

/// The same for a file that is read.
fs::path existing_in(const JsonValue& json) {
  const fs::path path = path_in(json);
  std::error_code error; // a name that is too long, a loop of links
  if (!fs::is_regular_file(path, error))
    throw json.error((error && error != std::errc::no_such_file_or_directory ? error.message() + ": " : "") +
                         "no file " + path.string(),
                     "the path of a file, from the scene's folder");
  return path;
}

MocapMotion read_mocap(const JsonValue& json) {
  json.only_keys({"bvh", "rest_frame", "from", "to", "joints"});
  MocapMotion motion{existing_in(json.at("bvh")), {}, {}};
  if (const auto rest = json.find("rest_frame")) motion.options.rest_frame = rest->integer_in(0, 10'000'000);
  if (const auto from = json.find("from")) motion.options.from = from->non_negative();
  if (const auto to = json.find("to")) motion.options.to = to->number_in(motion.options.from, k_largest_number);
  if (const auto joints = json.find("joints"))
    for (const auto& [name, other] : joints->members()) {
      if (other.is_boolean() && !other.boolean()) motion.joints[name] = std::nullopt;
      else if (other.is_string()) motion.joints[name] = other.string();
      else throw other.error("the character's joint, or false for none");
    }
  return motion;
}

MotionSource read_motion(const JsonValue& json) {
  if (json.is_string()) return ClipMotion{existing_in(json), std::nullopt};
  if (!json.is_object()) throw json.error("a clip's path, or an object with clip, animation, texts or bvh");
  if (json.has("bvh")) return read_mocap(json);
  json.only_keys({"clip", "retarget_from", "animation", "texts"});
  const auto clip = json.find("clip"), animation = json.find("animation"), texts = json.find("texts");
  if (int{clip.has_value()} + int{animation.has_value()} + int{texts.has_value()} != 1)
    throw json.error("exactly one of: clip, animation, texts, bvh");
  if (const auto from = json.find("retarget_from"); from && !clip) throw from->error("it beside a clip only");

  if (clip) {
    ClipMotion motion{existing_in(*clip), std::nullopt};
    if (const auto from = json.find("retarget_from")) motion.retarget_from = existing_in(*from);
    return motion;
  }
  if (animation) {
    if (animation->is_string()) return OwnMotion{animation->string()};
    return OwnMotion{animation->integer_in(0, 1 << 20)};
  }
  texts->only_keys({"translations", "rotations", "times", "joints"});
  rig::ThreeTexts files{
      existing_in(texts->at("translations")), existing_in(texts->at("rotations")), existing_in(texts->at("times")), {}};
  if (const auto joints = texts->find("joints")) files.joints = existing_in(*joints);
  return files;
}

GarmentEntry read_garment_entry(const JsonValue& json) {
  if (json.is_string()) return {existing_in(json)};
  if (!json.is_object()) throw json.error("a garment's path, or an object with file, scale, offset and resolution");
  json.only_keys({"file", "scale", "offset", "resolution"});
  GarmentEntry entry{existing_in(json.at("file"))};
  if (const auto scale = json.find("scale")) {
    entry.scale = scale->is_number() ? Vec3(Vec3::Constant(scale->positive())) : scale->vec3();
    if (!(entry.scale.minCoeff() > 0.0)) throw scale->error("factors above 0");
  }
  if (const auto offset = json.find("offset")) entry.offset = offset->vec3();
  if (const auto resolution = json.find("resolution")) entry.resolution = resolution->number_in(0.01, 100.0);
  return entry;
}

/// A name, a number of metres, or a number of metres as text.
double read_unit(const JsonValue& value) {
  if (value.is_number()) return value.positive();
  const std::optional<double> metres = rig::metres_in(value.string());
  if (!metres) throw value.error(rig::k_expected_unit);
  return *metres;
}

void read_character(const JsonValue& value, SceneFiles& scene) {
  if (!value.is_object()) {
    scene.character = existing_in(value);
    return;
  }
  value.only_keys({"file", "max_influences", "height", "unit", "rest"});
  scene.character = existing_in(value.at("file"));
  rig::ImportOptions& import = scene.import;
  if (const auto most = value.find("max_influences")) {
    import.max_influences = most->integer_in(4, 8);
    if (import.max_influences != 4 && import.max_influences != 8) throw most->error("4 or 8");
  }
  if (const auto height = value.find("height")) import.height = height->positive();
  if (const auto unit = value.find("unit")) {
    if (import.height) throw unit->error("no unit beside a height: either says how large the body is");
    import.metres_per_unit = read_unit(*unit);
  }
  if (const auto rest = value.find("rest"))
    import.rest = rig::rest_pose_named(rest->string_among(rig::k_rest_pose_names));
}

cloth::Wind read_wind(const JsonValue& json) {
  json.only_keys({"velocity", "gusts"});
  cloth::Wind wind;
  const JsonValue velocity = json.at("velocity");
  wind.velocity = velocity.vec3();
  if (!(wind.velocity.norm() <= cloth::k_fastest_wind))
    throw velocity.error(fmt::format("{:g} m/s", wind.velocity.norm()),
                         fmt::format("a wind of at most {:g} m/s", cloth::k_fastest_wind));
  if (const auto gusts = json.find("gusts")) {
    gusts->only_keys({"speed", "period", "seed"});
    wind.gusts = cloth::Gusts{gusts->at("speed").number_in(0.0, cloth::k_fastest_wind),
                              gusts->at("period").number_in(cloth::k_shortest_gust, 1e6)};
    if (const auto seed = gusts->find("seed"))
      wind.gusts->seed = static_cast<std::uint64_t>(seed->integer_in(0, std::numeric_limits<int>::max()));
  }
  return wind;
}

} // namespace

std::vector<fs::path> inputs_of(const SceneFiles& files) {
  std::vector<fs::path> inputs = {files.file, files.character};
  const auto add = [&](const std::optional<fs::path>& file) {
    if (file) inputs.push_back(*file);
  };
  if (const auto* clip = std::get_if<ClipMotion>(&files.motion)) {
    add(clip->clip);
    add(clip->retarget_from);
  } else if (const auto* texts = std::get_if<rig::ThreeTexts>(&files.motion)) {
    for (const fs::path& text : {texts->translations, texts->rotations, texts->times}) add(text);
    add(texts->joints);
  } else if (const auto* take = std::get_if<MocapMotion>(&files.motion)) {
    add(take->bvh);
  }
  add(files.proxies);
  for (const GarmentEntry& entry : files.garments) {
    add(entry.file);
    for (const fs::path& named : cloth::files_named_by_garment(entry.file)) add(named);
  }
  return inputs;
}

RunSettings SceneDescription::changed_settings() const {
  RunSettings changed = settings;
  for (const SettingChange& change : changes) change.row->set(changed, change.value);
  return changed;
}

SceneDescription read_scene(const fs::path& file) {
  const JsonValue json = JsonValue::read(file);
  json.only_keys({"character", "motion", "interpolation", "skinning", "proxies", "garments", "ground", "wind", "solver",
                  "collision", "drape"});
  SceneDescription scene;
  scene.file = file;
  read_character(json.at("character"), scene);
  scene.motion = read_motion(json.at("motion"));
  if (const auto interpolation = json.find("interpolation"))
    scene.interpolation = rig::interpolation_named(interpolation->string_among(rig::k_interpolation_names));
  if (const auto skinning = json.find("skinning"))
    scene.skinning = rig::skinning_named(skinning->string_among(rig::k_skinning_names));
  if (const auto proxies = json.find("proxies")) scene.proxies = existing_in(*proxies);
  if (const auto garments = json.find("garments"))
    for (const JsonValue& garment : garments->items()) scene.garments.push_back(read_garment_entry(garment));

  if (const auto ground = json.find("ground")) {
    if (ground->is_boolean()) {
      if (!ground->boolean()) scene.ground_height.reset();
    } else {
      if (!ground->is_object()) throw ground->error("true, false, or an object with height");
      ground->only_keys({"height"});
      scene.ground_height = ground->at("height").number();
    }
  }
  if (const auto wind = json.find("wind")) scene.wind = read_wind(*wind);
  for (const char* section : {"solver", "collision"})
    if (const auto settings = json.find(section)) read_section(*settings, section, scene.settings, scene.stated);
  if (const auto drape = json.find("drape")) scene.drape = path_in(*drape);
  else scene.drape = fs::path(file).replace_extension(".drape.json");
  return scene;
}

} // namespace tutu::app
