// What the importer's box answers, spoilt: believed only where all of it can be. The input is how a sound answer is
// spoilt, not the answer itself, whose layout is one build's own: which of the two kinds there are, how much is cut off
// (of 255), then triples of a place (low byte, high byte, from there on) and what stands there instead.
#include "rig/error.h"
#include "rig/import/detail/isolated.h"
#include "tests/fuzz/target.h"

#include <stdexcept>

namespace tutu::fuzz {
namespace {

template <typename T> std::string packed(T value) {
  return rig::import_detail::answer_of([&](rig::import_detail::Packer& packer) { pass(packer, value); });
}

const std::string& sound_import() {
  static const std::string bytes = [] {
    rig::Import import;
    import.character = small_character();
    rig::ChannelClip& clip = import.clips.emplace_back();
    clip.name = "walk";
    clip.end = 0.5;
    clip.still = import.character.skeleton.rest_local;
    rig::ChannelClip::Joint& joint = clip.joints.emplace_back();
    joint.joint = 1;
    joint.translation = {{0.0, 0.5},
                         {Vec3::Zero(), Vec3::UnitX()},
                         {rig::Law::cubic, rig::Law::step},
                         {Vec3::Zero(), Vec3::Zero()},
                         {Vec3::Zero(), Vec3::Zero()}};
    joint.rotation = {{0.0}, {Quat(0.6, 0, 0.8, 0).coeffs()}, {rig::Law::linear}, {}, {}};
    return packed(std::move(import));
  }();
  return bytes;
}

const std::string& sound_surface() {
  static const std::string bytes =
      packed(rig::TriangleSurface{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}});
  return bytes;
}

std::string spoilt(std::string bytes, std::string_view how) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(how[k]); };
  if (!how.empty()) bytes = bytes.substr(0, bytes.size() * (255u - byte(0)) / 255u);
  std::size_t at = 0;
  for (std::size_t k = 1; k + 2 < how.size() && !bytes.empty(); k += 3) {
    at = (at + byte(k) + 256u * byte(k + 1)) % bytes.size();
    bytes[at] = how[k + 2];
  }
  return bytes;
}

} // namespace

void fuzz_answer(std::string_view input) {
  const bool surface = !input.empty() && (input[0] & 1);
  const std::string bytes = spoilt(surface ? sound_surface() : sound_import(), input.substr(!input.empty()));
  try {
    if (surface) {
      const rig::TriangleSurface read = rig::import_detail::unpack_surface(bytes, "file");
      for (const auto& triangle : read.triangles)
        for (const std::uint32_t corner : triangle) require(corner < read.positions.size(), "corners are there");
      return;
    }
    const rig::Import read = rig::import_detail::unpack_import(bytes, "file");
    const std::vector<Transform> rest = rig::rest_model(read.character.skeleton);
    require_poses(rest, "the rest pose is one");
    std::vector<rig::SkinMatrix> palette(read.character.skin.slot_count());
    std::vector<Vec3f> positions(read.character.mesh.positions.size()), normals(positions.size());
    rig::skinning_palette(read.character.skin, rest, palette);
    rig::skin_vertices(read.character.mesh, read.character.skin, palette, positions, normals);
    for (const rig::ChannelClip& clip : read.clips)
      for (const double time : {clip.start, 0.5 * (clip.start + clip.end), clip.end + 1.0}) {
        std::vector<Transform> local(clip.still.size());
        rig::sample(clip, time, local);
        require_poses(local, "a clip has poses");
      }
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& cut_off) { // the box died: who asked says so
    throw InputError("answer", "", cut_off.what(), "a whole answer");
  }
}

} // namespace tutu::fuzz
