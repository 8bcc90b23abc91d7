// What a reader hands over: told by it, then believed or not.
#include "rig/error.h"
#include "rig/import/detail/isolated.h"
#include "rig/text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tutu::rig::import_detail {
namespace {

/// What became of the work: the first byte of an answer.
enum class Outcome : char { done = 'd', input_error = 'i', no_memory = 'm', other_error = 'o' };

constexpr std::size_t k_longest_text = 16'384; ///< bytes; names in assimp end at 1,023, a note lists six of them

/// Equal to one, of what was made equal to one in double and in single precision.
constexpr double k_unit_rotation = 1e-6, k_unit_float = 1e-3;

class Checker {
public:
  Checker(const std::string& file, const char* expected) : file_(file), expected_(expected) {}

  /// `what` is what has to hold, in a word or two.
  void require(bool sound, const char* what) const {
    if (!sound) throw InputError(file_, what, "a file that leads its reader astray", expected_);
  }
  void require_text(const std::string& text, const char* what) const {
    require(text.size() <= k_longest_text && is_plain_text(text), what);
  }

private:
  const std::string& file_;
  const char* expected_;
};

bool is_sound(double length) { return length >= 0.0 && length <= k_largest_number; }
bool is_unit(const Quat& q) { return std::abs(q.norm() - 1.0) <= k_unit_rotation; }

bool are_in_range(const Triangle& triangle, std::size_t vertices) {
  return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) { return v < vertices; });
}

void check_skeleton(const Skeleton& skeleton, const Checker& checker, const std::string& file) {
  const std::size_t joints = skeleton.names.size();
  checker.require(joints > 0 && skeleton.parents.size() == joints && skeleton.rest_local.size() == joints, "joints");
  for (const std::string& name : skeleton.names) checker.require_text(name, "joint names");
  for (const Transform& rest : skeleton.rest_local)
    checker.require(is_unit(rest.rotation) && is_in_bounds(rest.translation), "rest pose");
  skeleton.check(file);
}

void check_mesh(const Mesh& mesh, const Checker& checker) {
  checker.require(mesh.positions.size() <= std::numeric_limits<int>::max() / 8, "vertices"); // times influences: an int
  checker.require(mesh.normals.size() == mesh.positions.size(), "normals");
  for (const Vec3f& p : mesh.positions) checker.require(is_in_bounds(p.cast<double>()), "positions");
  for (const Vec3f& n : mesh.normals)
    checker.require(std::abs(n.cast<double>().norm() - 1.0) <= k_unit_float, "normals");
  for (const Triangle& triangle : mesh.triangles)
    checker.require(are_in_range(triangle, mesh.positions.size()), "triangles");
  std::size_t triangles = 0;
  for (const MeshPart& part : mesh.parts) {
    checker.require_text(part.name, "part names");
    checker.require(part.first_triangle == triangles, "parts");
    triangles += part.triangle_count;
    for (const float c : part.colour) checker.require(c >= 0.0f && c <= 1.0f, "colours");
  }
  checker.require(triangles == mesh.triangles.size() && triangles > 0, "parts");
}

void check_skin(const Skin& skin, std::size_t vertices, int joints, const Checker& checker) {
  checker.require(skin.influences == 4 || skin.influences == 8, "influences");
  const auto influences = static_cast<std::size_t>(skin.influences);
  checker.require(skin.inverse_bind.size() == skin.slot_joint.size(), "inverse binds");
  for (const int joint : skin.slot_joint) checker.require(joint >= 0 && joint < joints, "bound joints");
  for (const Eigen::Affine3d& bind : skin.inverse_bind) checker.require(bind.matrix().allFinite(), "inverse binds");
  checker.require(skin.slots.size() == vertices * influences && skin.weights.size() == skin.slots.size(), "weights");
  for (const std::uint16_t slot : skin.slots) checker.require(slot < skin.slot_joint.size(), "slots");
  for (std::size_t v = 0; v < vertices; ++v) {
    double sum = 0.0;
    for (std::size_t i = v * influences; i < (v + 1) * influences; ++i) {
      checker.require(skin.weights[i] >= 0.0f, "weights");
      sum += static_cast<double>(skin.weights[i]);
    }
    checker.require(std::abs(sum - 1.0) <= k_unit_float, "weights");
  }
}

void check_clips(const std::vector<ChannelClip>& clips, const Skeleton& skeleton, const Checker& checker) {
  for (const ChannelClip& clip : clips) {
    checker.require_text(clip.name, "clip names");
    checker.require(clip.still.size() == skeleton.names.size() && !clip.joints.empty(), "joints of clips");
    for (const Transform& still : clip.still)
      checker.require(is_unit(still.rotation) && is_in_bounds(still.translation), "poses of clips");
    rig::check(clip);
  }
}

void check_report(const ImportReport& report, const Checker& checker) {
  for (const int count : {report.file_meshes, report.file_skeletons, report.file_vertices, report.joints_without_weight,
                          report.largest_influences, report.cut_vertices})
    checker.require(count >= 0, "counts of the report");
  for (const double number : {report.metres_per_unit, report.height, report.largest_cut})
    checker.require(is_sound(number), "numbers of the report");
  checker.require_text(report.format, "format");
  checker.require_text(report.up_axis, "up axis");
  for (const std::string& note : report.notes) checker.require_text(note, "notes");
}

/// Throws what the answer says was thrown; else hands over what was packed.
Unpacker packed_in(std::string_view answer, const std::string& file, const char* expected) {
  Unpacker unpacker(answer);
  char outcome = 0;
  pass(unpacker, outcome);
  switch (Outcome{outcome}) {
  case Outcome::done: return unpacker;
  case Outcome::no_memory: throw InputError(file, "", "a file that takes more memory to read than there is", expected);
  case Outcome::input_error: {
    std::string parts[4];
    for (std::string& part : parts) {
      pass(unpacker, part);
      // Names of the file's, in whatever bytes it has.
      if (part != file) part = plain_text(std::string_view(part).substr(0, k_longest_text));
    }
    throw InputError(parts[0], parts[1], parts[2], parts[3]);
  }
  case Outcome::other_error: {
    std::string what;
    pass(unpacker, what);
    throw std::runtime_error(plain_text(std::string_view(what).substr(0, k_longest_text)));
  }
  }
  throw std::runtime_error("the reader's answer is no answer");
}

template <typename T> T unpack(std::string_view answer, const std::string& file, const char* expected) {
  Unpacker unpacker = packed_in(answer, file, expected);
  T value;
  pass(unpacker, value);
  if (!unpacker.at_end()) throw std::runtime_error("the reader's answer does not end");
  return value;
}

} // namespace

std::string answer_of(const std::function<void(Packer&)>& work) {
  Packer packer;
  const auto begin = [&](Outcome outcome) {
    packer = Packer();
    packer.raw(&outcome, sizeof outcome);
  };
  try {
    begin(Outcome::done);
    work(packer);
  } catch (const InputError& error) {
    begin(Outcome::input_error);
    for (std::string part : {error.file(), error.place(), error.found(), error.expected()}) pass(packer, part);
  } catch (const std::bad_alloc&) {
    begin(Outcome::no_memory);
  } catch (const std::exception& error) {
    begin(Outcome::other_error);
    std::string what = error.what();
    pass(packer, what);
  }
  return packer.take();
}

Import unpack_import(std::string_view answer, const std::string& file) {
  auto import = unpack<Import>(answer, file, k_expected_character);
  import.character.file = file;
  for (ChannelClip& clip : import.clips) clip.file = file;
  const Character& character = import.character;
  const Checker checker(file, k_expected_character);
  check_skeleton(character.skeleton, checker, file);
  check_mesh(character.mesh, checker);
  check_skin(character.skin, character.mesh.positions.size(), character.skeleton.joint_count(), checker);
  check_clips(import.clips, character.skeleton, checker);
  check_report(import.report, checker);
  return import;
}

TriangleSurface unpack_surface(std::string_view answer, const std::string& file) {
  auto surface = unpack<TriangleSurface>(answer, file, k_expected_surface);
  const Checker checker(file, k_expected_surface);
  checker.require(!surface.triangles.empty(), "triangles");
  for (const Vec3& p : surface.positions) checker.require(is_in_bounds(p), "positions");
  for (const Triangle& triangle : surface.triangles)
    checker.require(are_in_range(triangle, surface.positions.size()), "triangles");
  return surface;
}

} // namespace tutu::rig::import_detail
