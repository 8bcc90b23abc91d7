// Private to the importer: an Import as bytes, so that a child process can hand it over. One machine, one build: no
// versions.
#pragma once

#include "rig/character.h"
#include "rig/import/import.h"

#include <cstddef>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tutu::rig::import_detail {

class Packer {
public:
  void raw(void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }
  void count(std::size_t& size) { raw(&size, sizeof size); }
  const std::string& bytes() const { return bytes_; }

private:
  std::string bytes_;
};

/// Throws std::runtime_error when the bytes end too early.
class Unpacker {
public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {}
  void raw(void* to, std::size_t size) {
    if (size > rest_.size()) throw std::runtime_error("the reader's answer is cut off");
    rest_.copy(static_cast<char*>(to), size);
    rest_.remove_prefix(size);
  }
  void count(std::size_t& size) {
    raw(&size, sizeof size);
    if (size > rest_.size())
      throw std::runtime_error("the reader's answer is cut off"); // an element has a byte at least
  }
  bool at_end() const { return rest_.empty(); }

private:
  std::string_view rest_;
};

// pass(archive, value) writes or reads, whichever the archive does: one list of fields serves both ways.

template <typename Archive, typename T>
requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void pass(Archive& archive, T& value) {
  archive.raw(&value, sizeof value);
}
template <typename Archive, typename Scalar, int rows, int columns, int options>
void pass(Archive& archive, Eigen::Matrix<Scalar, rows, columns, options>& value) {
  archive.raw(value.data(), sizeof(Scalar) * static_cast<std::size_t>(value.size()));
}
template <typename Archive> void pass(Archive& archive, Quat& value) { pass(archive, value.coeffs()); }
template <typename Archive> void pass(Archive& archive, Eigen::Affine3d& value) { pass(archive, value.matrix()); }
template <typename Archive> void pass(Archive& archive, Transform& value) {
  pass(archive, value.rotation);
  pass(archive, value.translation);
}
template <typename Archive, typename T, std::size_t size> void pass(Archive& archive, std::array<T, size>& value) {
  for (T& item : value) pass(archive, item);
}
template <typename Archive> void pass(Archive& archive, std::string& value) {
  std::size_t size = value.size();
  archive.count(size);
  value.resize(size);
  archive.raw(value.data(), size);
}
template <typename Archive, typename T> void pass(Archive& archive, std::optional<T>& value) {
  bool given = value.has_value();
  pass(archive, given);
  if (given && !value) value.emplace();
  if (given) pass(archive, *value);
}
template <typename Archive> void pass(Archive& archive, JointKey& key) {
  pass(archive, key.translation);
  pass(archive, key.rotation);
}
template <typename Archive> void pass(Archive& archive, std::map<std::string, JointKey>& value) {
  std::size_t size = value.size();
  archive.count(size);
  if (!value.empty()) {
    for (auto& [name, key] : value) {
      std::string copy = name;
      pass(archive, copy);
      pass(archive, key);
    }
    return;
  }
  for (std::size_t i = 0; i < size; ++i) {
    std::string name;
    JointKey key;
    pass(archive, name);
    pass(archive, key);
    value.emplace_hint(value.end(), std::move(name), key);
  }
}
template <typename Archive> void pass(Archive& archive, MeshPart& part);
template <typename Archive> void pass(Archive& archive, RawClip::Key& key);
template <typename Archive> void pass(Archive& archive, RawClip& clip);
template <typename Archive, typename T> void pass(Archive& archive, std::vector<T>& value) {
  std::size_t size = value.size();
  archive.count(size);
  value.resize(size);
  if constexpr (std::is_arithmetic_v<T>) archive.raw(value.data(), size * sizeof(T));
  else
    for (T& item : value) pass(archive, item);
}
template <typename Archive> void pass(Archive& archive, MeshPart& part) {
  pass(archive, part.name);
  pass(archive, part.first_triangle);
  pass(archive, part.triangle_count);
  pass(archive, part.colour);
}
template <typename Archive> void pass(Archive& archive, RawClip::Key& key) {
  pass(archive, key.time);
  pass(archive, key.name);
  pass(archive, key.joints);
}
template <typename Archive> void pass(Archive& archive, RawClip& clip) {
  pass(archive, clip.file);
  pass(archive, clip.name);
  pass(archive, clip.extrapolation);
  pass(archive, clip.keys);
}
template <typename Archive> void pass(Archive& archive, Character& character) {
  pass(archive, character.file);
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

} // namespace tutu::rig::import_detail
