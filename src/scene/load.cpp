#include "src/scene/load.h"

#include "cloth/garment/garment_file.h"
#include "cloth/garment/garment_memory.h"
#include "proxies/proxy_file.h"
#include "rig/error.h"
#include "rig/import/import.h"
#include "rig/io/memory_limit.h"

#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tutu::app {
namespace {

namespace fs = std::filesystem;

/// Refuses keys whose poses would take too much memory. A key may name a few joints, its pose has all of them.
void check_poses(std::size_t keys, const rig::Skeleton& skeleton, const std::string& file) {
  const auto joints = static_cast<std::size_t>(skeleton.joint_count());
  const double bytes_a_joint = sizeof(Transform) + sizeof(rig::Clip::Velocity);
  check_memory(static_cast<double>(keys) * static_cast<double>(joints) * bytes_a_joint, file, "",
               fmt::format("{} poses of {} joints", with_commas(keys), with_commas(joints)));
}

rig::Clip build(const rig::RawClip& raw, const rig::Skeleton& skeleton) {
  check_poses(raw.keys.size(), skeleton, raw.file);
  return rig::build_clip(raw, skeleton);
}

/// A clip made for `source` on the character; what found no joint there becomes a note.
rig::Clip retargeted(const rig::Clip& clip, const rig::Skeleton& source, const rig::Skeleton& skeleton,
                     const fs::path& file, std::vector<std::string>& notes) {
  check_poses(clip.times.size(), skeleton, file.string());
  std::vector<std::string> unmatched;
  rig::Clip result = rig::retarget(clip, source, skeleton, &unmatched);
  if (!unmatched.empty())
    notes.push_back(fmt::format("{}: no joint here for {}", file.filename().string(), fmt::join(unmatched, ", ")));
  return result;
}

/// Puts the clip on the character, by way of the skeleton it was made for when that is another one.
rig::Clip clip_for(const ClipMotion& motion, const rig::Skeleton& skeleton, std::vector<std::string>& notes) {
  const rig::RawClip raw = rig::read_clip(motion.clip, &notes);
  if (!motion.retarget_from) return build(raw, skeleton);
  const rig::Skeleton source = rig::import_character(*motion.retarget_from).character.skeleton;
  return retargeted(build(raw, source), source, skeleton, motion.clip, notes);
}

rig::Clip clip_for(const MocapMotion& motion, const rig::Skeleton& skeleton, std::vector<std::string>& notes) {
  rig::Mocap take = rig::read_bvh(motion.bvh, motion.options);
  rig::rename_joints(take.skeleton, motion.joints, motion.bvh.string());
  for (const std::string& note : take.notes) notes.push_back(motion.bvh.filename().string() + ": " + note);
  return retargeted(take.clip, take.skeleton, skeleton, motion.bvh, notes);
}

const rig::ChannelClip& own_animation(const OwnMotion& motion, const rig::Import& import,
                                      const std::string& scene_file) {
  const auto& clips = import.clips;
  const auto fail = [&](const std::string& found) {
    std::string names;
    for (const rig::ChannelClip& clip : clips) names += (names.empty() ? "" : ", ") + clip.name;
    const std::string expected =
        clips.empty() ? "a character with animations" : fmt::format("0 to {}, or one of: {}", clips.size() - 1, names);
    throw InputError(scene_file, "/motion/animation", found, expected);
  };
  if (const auto* index = std::get_if<int>(&motion.animation)) {
    if (*index >= static_cast<int>(clips.size())) fail(std::to_string(*index));
    return clips[*index];
  }
  const std::string& name = std::get<std::string>(motion.animation);
  for (const rig::ChannelClip& clip : clips)
    if (clip.name == name) return clip;
  fail('"' + name + '"');
  return clips.front(); // not reached: fail() throws
}

rig::Motion load_motion(const SceneDescription& description, const rig::Import& import,
                        std::vector<std::string>& notes) {
  const rig::Skeleton& skeleton = import.character.skeleton;
  if (const auto* own = std::get_if<OwnMotion>(&description.motion))
    return own_animation(*own, import, description.file.string());
  if (const auto* texts = std::get_if<rig::ThreeTexts>(&description.motion))
    return build(rig::read_three_texts(*texts, skeleton, &notes), skeleton);
  if (const auto* mocap = std::get_if<MocapMotion>(&description.motion)) return clip_for(*mocap, skeleton, notes);
  return clip_for(std::get<ClipMotion>(description.motion), skeleton, notes);
}

/// What the motion is read from, for messages.
std::string motion_file(const SceneDescription& description) {
  if (const auto* clip = std::get_if<ClipMotion>(&description.motion)) return clip->clip.string();
  if (const auto* mocap = std::get_if<MocapMotion>(&description.motion)) return mocap->bvh.string();
  if (const auto* texts = std::get_if<rig::ThreeTexts>(&description.motion)) return texts->translations.string();
  return description.character.string();
}

/// The scene's garments as their files have them, which are read. Refuses those that would take too much memory, each
/// for itself or all together, before any is built.
std::vector<cloth::GarmentDescription> read_garments(const SceneDescription& description, std::size_t proxies) {
  std::vector<cloth::GarmentDescription> garments;
  double bytes = 0.0;
  std::uint64_t particles = 0;
  const std::string file = description.file.string();
  for (const GarmentEntry& entry : description.garments) {
    const std::string place = "/garments/" + std::to_string(garments.size());
    const cloth::GarmentDescription& own =
        garments.emplace_back(within_memory(entry.file.string(), [&] { return cloth::read_garment(entry.file); }));
    const cloth::GarmentDescription garment = cloth::resampled(own, entry.resolution);
    if (cloth::memory_of(garment) > memory_limit()) cloth::check_garment_memory(own);
    const std::uint64_t count = cloth::particles_of(garment);
    check_memory(cloth::memory_of(garment), file, place + "/resolution",
                 fmt::format("a garment of {} particles", with_commas(count)));
    check_memory(cloth::memory_of(garment, proxies), file, "/proxies",
                 fmt::format("{} of them beside {} particles", with_commas(proxies), with_commas(count)));
    bytes += cloth::memory_of(garment, proxies);
    particles += count;
    check_memory(bytes, file, place,
                 fmt::format("{} garments of {} particles up to here", garments.size(), with_commas(particles)));
  }
  return garments;
}

cloth::GarmentDescription as_entered(const GarmentEntry& entry, cloth::GarmentDescription garment) {
  return cloth::fitted(cloth::resampled(std::move(garment), entry.resolution), entry.scale, entry.offset);
}

/// The description's settings, where the garments honour what is said of them.
void apply_settings(const SceneDescription& description, LoadedScene& scene) {
  const RunSettings changed = description.changed_settings();
  for (const SettingRow* row : description.stated) {
    if (const auto wrong = unhonoured(*row, description.settings, scene.garments))
      throw InputError(scene.file, fmt::format("/{}/{}", row->section, row->key), wrong->found, wrong->expected);
    if (row->get(changed) != row->get(description.settings)) continue;
    if (const auto useless = unhonoured(*row, changed, scene.garments))
      scene.notes.push_back(
          fmt::format("{} of the scene does not count: expected {}", useless->found, useless->expected));
  }
  for (const SettingChange& change : description.changes)
    if (const auto wrong = unhonoured(*change.row, changed, scene.garments))
      throw InputError("", change.by, wrong->found, wrong->expected);
  scene.settings = changed;
}

} // namespace

WornGarment put_on(const GarmentEntry& entry, const rig::Character& character) {
  return wear(as_entered(entry, cloth::read_garment(entry.file)), character);
}

LoadedScene load_scene(const SceneDescription& description) {
  LoadedScene scene;
  scene.file = description.file.string();
  scene.files = description;
  scene.ground_height = description.ground_height;
  rig::Import import = within_memory(description.character.string(),
                                     [&] { return rig::import_character(description.character, description.import); });
  for (const std::string& note : import.report.notes)
    scene.notes.push_back(description.character.filename().string() + ": " + note);
  scene.motion = within_memory(motion_file(description), [&] { return load_motion(description, import, scene.notes); });
  scene.character = std::move(import.character);
  if (description.interpolation) {
    check_poses(rig::key_times(scene.motion).size(), scene.character.skeleton, motion_file(description));
    rig::set_interpolation(scene.motion, scene.character.skeleton, *description.interpolation);
  }
  rig::set_skinning(scene.character.skin, scene.character.mesh, description.skinning, description.character.string());

  if (description.proxies)
    scene.proxies = within_memory(description.proxies->string(), [&] {
      return proxies::read_proxies(*description.proxies, scene.character.skeleton);
    });
  std::vector<cloth::GarmentDescription> garments = read_garments(description, scene.proxies.size());
  for (std::size_t g = 0; g < garments.size(); ++g) {
    const GarmentEntry& entry = description.garments[g];
    within_memory(entry.file.string(), [&] { scene.put_on(as_entered(entry, std::move(garments[g]))); });
  }
  if (!description.wind.is_still() && !scene.has_air())
    throw InputError(scene.file, "/wind", "wind, and no garment whose fabric has air",
                     "\"air\" in the fabric of one, or no wind");
  scene.wind = description.wind;
  apply_settings(description, scene);
  for (const cloth::Garment& garment : scene.garments)
    if (scene.collides_with_body() && garment.met.which != cloth::MetColliders::Which::all)
      scene.notes.push_back(garment.name + ": meets all of the true body, whatever proxies it ignores");
  return scene;
}

fs::path assets_folder() {
  if (const char* chosen = std::getenv("TUTU_ASSETS")) {
    if (!fs::is_directory(chosen)) throw InputError("$TUTU_ASSETS", "", chosen, "a folder");
    return chosen;
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (const char* relative : {"../share/tutu/assets", "../../assets"}) {
    const fs::path folder = (program.parent_path() / relative).lexically_normal();
    if (fs::is_directory(folder, error)) return folder;
  }
  throw InputError("", "assets", "none beside " + program.string(),
                   "an installed program, a checkout, or $TUTU_ASSETS");
}

} // namespace tutu::app
