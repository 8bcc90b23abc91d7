// Private to the glTF reader: the file as a container. Its JSON, its binary chunk, its version, what it requires.
#pragma once

#include "rig/import/gltf/value.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tutu::rig::import_detail {

class GltfDocument {
public:
  /// Throws InputError on a container that is cut or of another version, on JSON that is none, on an asset of another
  /// version than 2, and on a required extension that is not read.
  explicit GltfDocument(const std::filesystem::path& path);
  GltfDocument(const GltfDocument&) = delete; // views its own bytes
  GltfDocument& operator=(const GltfDocument&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::string& file() const { return file_; }
  const std::string& format() const { return format_; } ///< "glTF 2.0", "glTF 2.0 binary", "VRM 0.x", "VRM 1.0"
  bool faces_back() const { return faces_back_; }       ///< VRM 0.x faces -Z
  bool has_foreign_bytes() const { return tree_.has_foreign_bytes; } ///< names that are not UTF-8
  std::optional<std::string_view> binary_chunk() const { return binary_; }

  GltfValue root() const { return {file_, tree_.root, ""}; }
  std::size_t count(std::string_view list) const; ///< of one of the lists on top: "nodes"
  /// The element of such a list that `reference` names by its index. Throws InputError when there is none.
  GltfValue target(const GltfValue& reference, std::string_view list) const;
  std::size_t target_index(const GltfValue& reference, std::string_view list) const;

private:
  std::string_view open_container(); ///< its JSON
  void check_version() const;
  void check_extensions() const;

  std::filesystem::path path_;
  std::string file_, bytes_, format_;
  std::optional<std::string_view> binary_;
  bool faces_back_ = false;
  GltfTree tree_;
};

} // namespace tutu::rig::import_detail
