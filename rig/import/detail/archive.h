// Private to the importer: an Import as bytes, so that a child process can hand it over. One machine, one build: no
// versions. Where a file came from is not among them: who asked knows that.
#pragma once

#include "rig/character.h"
#include "rig/import/import.h"
#include "rig/import/surface.h"

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace tutu::rig::import_detail {

class Packer {
public:
  void raw(void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }
  void count(std::size_t& size, std::size_t) { raw(&size, sizeof size); }
  std::string take() { return std::move(bytes_); }

private:
  std::string bytes_;
};

/// Throws std::runtime_error when the bytes end too early. What it fills takes some 20 times the bytes at most,
/// whatever counts they claim.
class Unpacker {
public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {}
  void raw(void* to, std::size_t size) {
    if (size > rest_.size()) throw std::runtime_error("the reader's answer is cut off");
    rest_.copy(static_cast<char*>(to), size);
    rest_.remove_prefix(size);
  }
  /// Of elements that take `least` bytes each, or more.
  void count(std::size_t& size, std::size_t least) {
    raw(&size, sizeof size);
    if (size > rest_.size() / least) throw std::runtime_error("the reader's answer is cut off");
  }
  bool at_end() const { return rest_.empty(); }

private:
  std::string_view rest_;
};

// pass(archive, value) writes or reads, whichever the archive does: one list of fields serves both ways.

template <typename Archive, typename T>
requires std::is_arithmetic_v<T>
void pass(Archive& archive, T& value) { archive.raw(&value, sizeof value); }
template <typename Archive> void pass(Archive& archive, bool& value) {
  unsigned char byte = value ? 1 : 0; // a bool that is neither must never come to be
  pass(archive, byte);
  if (byte > 1) throw std::runtime_error("the reader's answer has a bool of " + std::to_string(byte));
  value = byte == 1;
}
template <typename Archive> void pass(Archive& archive, Extrapolation& value) {
  bool loops = value == Extrapolation::loop;
  pass(archive, loops);
  value = loops ? Extrapolation::loop : Extrapolation::clamp;
}
template <typename Archive, typename Scalar, int rows, int columns, int options>
void pass(Archive& archive, Eigen::Matrix<Scalar, rows, columns, options>& value) {
  archive.raw(value.data(), sizeof(Scalar) * static_cast<std::size_t>(value.size()));
}
template <typename Archive> void pass(Archive& archive, Quat& value) { pass(archive, value.coeffs()); }
template <typename Archive> void pass(Archive& archive, Eigen::Affine3d& value) {
  pass(archive, value.matrix());
  value.makeAffine(); // its last row, whatever the bytes say
}
template <typename Archive> void pass(Archive& archive, Transform& value) {
  pass(archive, value.rotation);
  pass(archive, value.translation);
}
template <typename Archive, typename T, std::size_t size> void pass(Archive& archive, std::array<T, size>& value) {
  for (T& item : value) pass(archive, item);
}
template <typename Archive> void pass(Archive& archive, std::string& value) {
  std::size_t size = value.size();
  archive.count(size, 1);
  value.resize(size);
  archive.raw(value.data(), size);
}
template <typename Archive, typename T> void pass(Archive& archive, std::optional<T>& value) {
  bool given = value.has_value();
  pass(archive, given);
  if (given && !value) value.emplace();
  if (given) pass(archive, *value);
}
template <typename Archive> void pass(Archive& archive, Law& law) {
  auto value = static_cast<std::uint8_t>(law);
  pass(archive, value);
  if (value > static_cast<std::uint8_t>(Law::cubic))
    throw std::runtime_error("the reader's answer has a law that is none");
  law = Law{value};
}
template <typename Archive> void pass(Archive& archive, MeshPart& part);
template <typename Archive> void pass(Archive& archive, ChannelClip::Joint& joint);
template <typename Archive> void pass(Archive& archive, ChannelClip& clip);
template <typename Archive, typename T> void pass(Archive& archive, std::vector<T>& value) {
  std::size_t size = value.size();
  if constexpr (std::is_arithmetic_v<T>) {
    archive.count(size, sizeof(T));
    value.resize(size);
    archive.raw(value.data(), size * sizeof(T));
  } else {
    archive.count(size, 1);
    for (std::size_t i = 0; i < size; ++i) {
      if (i == value.size()) value.emplace_back(); // grows with what is there, not with what is claimed
      pass(archive, value[i]);
    }
  }
}
template <typename Archive> void pass(Archive& archive, MeshPart& part) {
  pass(archive, part.name);
  pass(archive, part.first_triangle);
  pass(archive, part.triangle_count);
  pass(archive, part.colour);
}
template <typename Archive, typename Value> void pass(Archive& archive, Curve<Value>& curve) {
  pass(archive, curve.times);
  pass(archive, curve.values);
  pass(archive, curve.laws);
  pass(archive, curve.leaving);
  pass(archive, curve.arriving);
}
template <typename Archive> void pass(Archive& archive, ChannelClip::Joint& joint) {
  pass(archive, joint.joint);
  pass(archive, joint.translation);
  pass(archive, joint.rotation);
}
template <typename Archive> void pass(Archive& archive, ChannelClip& clip) {
  pass(archive, clip.name);
  pass(archive, clip.extrapolation);
  pass(archive, clip.start);
  pass(archive, clip.end);
  pass(archive, clip.still);
  pass(archive, clip.joints);
}
template <typename Archive> void pass(Archive& archive, Character& character) {
  pass(archive, character.skeleton.names);
  pass(archive, character.skeleton.parents);
  pass(archive, character.skeleton.rest_local);
  pass(archive, character.mesh.positions);
  pass(archive, character.mesh.normals);
  pass(archive, character.mesh.triangles);
  pass(archive, character.mesh.parts);
  pass(archive, character.skin.influences);
  pass(archive, character.skin.slot_joint);
  pass(archive, character.skin.inverse_bind);
  pass(archive, character.skin.slots);
  pass(archive, character.skin.weights);
}
template <typename Archive> void pass(Archive& archive, ImportReport& report) {
  pass(archive, report.format);
  pass(archive, report.metres_per_unit);
  pass(archive, report.up_axis);
  pass(archive, report.height);
  pass(archive, report.file_meshes);
  pass(archive, report.file_skeletons);
  pass(archive, report.file_vertices);
  pass(archive, report.joints_without_weight);
  pass(archive, report.largest_influences);
  pass(archive, report.cut_vertices);
  pass(archive, report.largest_cut);
  pass(archive, report.notes);
}
template <typename Archive> void pass(Archive& archive, Import& import) {
  pass(archive, import.character);
  pass(archive, import.clips);
  pass(archive, import.report);
}
template <typename Archive> void pass(Archive& archive, TriangleSurface& surface) {
  pass(archive, surface.positions);
  pass(archive, surface.triangles);
}

} // namespace tutu::rig::import_detail
