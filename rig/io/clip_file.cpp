// Clips as JSON. The three texts are in three_texts.cpp.
#include "rig/io/clip_file.h"

#include "rig/io/detail/unit_rotations.h"
#include "rig/io/file_io.h"
#include "rig/io/json_file.h"

#include <array>

namespace tutu::rig {
namespace {

using nlohmann::json;

JointKey read_joint(const JsonValue& value, UnitRotations& rotations) {
  value.only_keys({"translation", "rotation"});
  JointKey joint;
  if (const auto translation = value.find("translation")) joint.translation = translation->vec3();
  if (const auto rotation = value.find("rotation")) {
    const std::vector<double> v = rotation->numbers(4);
    joint.rotation = rotations.normalised(Quat(v[3], v[0], v[1], v[2]));
    if (!joint.rotation) throw rotation->error(UnitRotations::k_expected);
  }
  return joint;
}

RawClip::Key read_key(const JsonValue& value, UnitRotations& rotations) {
  value.only_keys({"time", "name", "airborne", "joints"});
  RawClip::Key key;
  key.time = value.at("time").number();
  if (const auto name = value.find("name")) key.name = name->string();
  if (const auto airborne = value.find("airborne")) key.airborne = airborne->boolean();
  if (const auto joints = value.find("joints"))
    for (const auto& [name, joint] : joints->members()) key.joints[name] = read_joint(joint, rotations);
  return key;
}

/// A string or number as JSON: numbers in a short decimal form that reads back to the same bits.
std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

std::string text_of(const JointKey& joint) {
  std::string text;
  if (joint.translation) {
    const Vec3& t = *joint.translation;
    text += "\"translation\": [" + text_of(t.x()) + ", " + text_of(t.y()) + ", " + text_of(t.z()) + "]";
  }
  if (joint.rotation) {
    const Quat& q = *joint.rotation;
    text += text.empty() ? "" : ", ";
    text += "\"rotation\": [" + text_of(q.x()) + ", " + text_of(q.y()) + ", " + text_of(q.z()) + ", " + text_of(q.w()) +
            "]";
  }
  return "{" + text + "}";
}

std::string text_of(const RawClip::Key& key) {
  std::string text = "{\"time\": " + text_of(key.time);
  if (!key.name.empty()) text += ", \"name\": " + text_of(key.name);
  if (key.airborne) text += ", \"airborne\": true";
  text += ", \"joints\": {";
  const char* separator = "\n";
  for (const auto& [name, joint] : key.joints) {
    text += separator + ("      " + text_of(name)) + ": " + text_of(joint);
    separator = ",\n";
  }
  return text + "\n    }}";
}

} // namespace

RawClip read_clip(const std::filesystem::path& file, std::vector<std::string>* notes) {
  const JsonValue root = JsonValue::read(file);
  root.only_keys({"name", "extrapolation", "interpolation", "keys"});
  RawClip clip;
  clip.file = file.string();
  const auto name = root.find("name");
  clip.name = name ? name->string() : file.stem().string();
  if (const auto extrapolation = root.find("extrapolation"))
    clip.extrapolation = extrapolation->string_among(std::array<std::string_view, 2>{"loop", "clamp"}) == "clamp"
                             ? Extrapolation::clamp
                             : Extrapolation::loop;
  if (const auto interpolation = root.find("interpolation"))
    clip.interpolation = interpolation_named(interpolation->string_among(k_interpolation_names));

  UnitRotations rotations;
  const JsonValue keys = root.at("keys");
  for (const JsonValue& value : keys.items()) {
    RawClip::Key key = read_key(value, rotations);
    if (!clip.keys.empty() && !(key.time > clip.keys.back().time))
      throw value.at("time").error(text_of(key.time) + " s after " + text_of(clip.keys.back().time) + " s of key " +
                                       std::to_string(clip.keys.size() - 1),
                                   "strictly rising times");
    clip.keys.push_back(std::move(key));
  }
  if (clip.keys.empty()) throw keys.error("no keys", "at least one key");
  if (const auto note = rotations.note(); note && notes) notes->push_back(clip.file + ": " + *note);
  return clip;
}

void write_clip(const RawClip& clip, const std::filesystem::path& file) {
  check(clip);
  std::string text = "{\n  \"name\": " + text_of(clip.name) + ",\n";
  text +=
      std::string("  \"extrapolation\": ") + (clip.extrapolation == Extrapolation::clamp ? "\"clamp\"" : "\"loop\"");
  text += ",\n  \"interpolation\": ";
  text += text_of(k_interpolation_names[static_cast<std::size_t>(clip.interpolation)]);
  text += ",\n  \"keys\": [";
  const char* separator = "\n    ";
  for (const RawClip::Key& key : clip.keys) {
    text += separator + text_of(key);
    separator = ",\n    ";
  }
  text += "\n  ]\n}\n";
  write_file(file, text);
}

} // namespace tutu::rig
