#include "tests/fuzz/target.h"

#include "rig/error.h"
#include "tests/support/capsule_body.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <unistd.h>

namespace tutu::fuzz {
namespace fs = std::filesystem;
namespace {

struct Scratch {
  fs::path folder = fs::temp_directory_path() / ("tutu-fuzz-" + std::to_string(::getpid()));
  Scratch() {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

rig::Character make_character() {
  rig::Character character;
  character.file = "body";
  const auto joint = [&](const char* name, int parent, const Vec3& place, double turn = 0.0) {
    character.skeleton.names.emplace_back(name);
    character.skeleton.parents.push_back(parent);
    character.skeleton.rest_local.push_back({Quat(Eigen::AngleAxisd(turn, Vec3(0.48, 0.6, 0.64))), place});
  };
  joint("mixamorig:Hips", rig::k_no_parent, {0, 1, 0});
  joint("mixamorig:Spine", 0, {0, 0.2, 0}, 0.3);
  joint("mixamorig:Head", 1, {0, 0.3, 0});
  joint("mixamorig:LeftUpLeg", 0, {0.1, 0, 0});
  joint("mixamorig:LeftLeg", 3, {0, -0.4, 0.01}, -2.0);
  joint("mixamorig:LeftFoot", 4, {0, -0.4, 0});

  test::CapsuleBody body;
  body.add({{0, 0.8, 0}, {0, 1.4, 0}, 0.12}, 8, 2, 2);
  character.mesh.positions = body.positions;
  character.mesh.triangles = body.triangles;
  character.mesh.normals = rig::angle_weighted_normals(body.positions, body.triangles);
  character.mesh.parts = {{"body", 0, static_cast<std::uint32_t>(body.triangles.size())}};
  const std::vector<Transform> rest = rig::rest_model(character.skeleton);
  for (int j = 0; j < 2; ++j) {
    character.skin.slot_joint.push_back(j);
    const Transform inverse = rest[j].inverse();
    character.skin.inverse_bind.emplace_back(Eigen::Translation3d(inverse.translation) * inverse.rotation);
  }
  for (std::size_t v = 0; v < body.positions.size(); ++v) {
    character.skin.slots.insert(character.skin.slots.end(), {0, 1, 0, 0});
    character.skin.weights.insert(character.skin.weights.end(), {0.75f, 0.25f, 0.0f, 0.0f});
  }
  return character;
}

} // namespace

const fs::path& scratch() {
  static const Scratch folder;
  return folder.folder;
}

fs::path write_input(std::string_view bytes, const std::string& name) {
  const fs::path file = scratch() / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "a promise is broken: %s\n", promise);
  std::abort();
}

void require_poses(std::span<const Transform> transforms, const char* promise) {
  for (const Transform& t : transforms) require(is_finite(t) && std::abs(t.rotation.norm() - 1.0) < 1e-6, promise);
}

void require_motion(const rig::import_detail::FileAnimation& animation, int nodes) {
  require(animation.start <= animation.end, "a clip ends behind its start");
  int last = -1;
  for (const rig::import_detail::NodeMotion& motion : animation.nodes) {
    require(motion.node > last && motion.node < nodes, "each node moves once");
    last = motion.node;
    try {
      rig::check(motion.translation, "", "");
      rig::check(motion.rotation, "", "");
      rig::check(motion.scale, "", "");
    } catch (const InputError&) {
      require(false, "what is read holds");
    }
    for (const double time : {animation.start, 0.5 * (animation.start + animation.end), animation.end}) {
      if (!motion.translation.empty())
        require(rig::value_at(motion.translation, time).allFinite(), "a translation is one");
      if (!motion.scale.empty()) require(rig::value_at(motion.scale, time).allFinite(), "a scale is one");
      if (!motion.rotation.empty())
        require(std::abs(rig::value_at(motion.rotation, time).norm() - 1.0) < 1e-6, "a rotation is one");
    }
  }
}

const rig::Character& small_character() {
  static const rig::Character character = make_character();
  return character;
}

} // namespace tutu::fuzz
