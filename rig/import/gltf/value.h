// Private to the glTF reader: values of its JSON, asked for by type; a wrong one is told with its place.
#pragma once

#include "rig/error.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig::import_detail {

struct GltfTree {
  nlohmann::json root;            ///< an object
  bool has_foreign_bytes = false; ///< text that is not UTF-8, as older exporters write names: '_' in place of each byte
};
/// Throws InputError on a syntax error (with line and column), on a key twice in one object, on nesting deeper than
/// 128, on anything but an object, and where its values would take more memory than memory_limit.h allows.
GltfTree parse_gltf(std::string_view text, const std::string& file);

/// One value and where it stands. What it views must outlive it. All functions throw InputError on a value of another
/// type than asked.
class GltfValue {
public:
  GltfValue(const std::string& file, const nlohmann::json& node, std::string pointer)
      : file_(&file), node_(&node), pointer_(std::move(pointer)) {}

  const std::string& file() const { return *file_; }
  const std::string& pointer() const { return pointer_; } ///< "/accessors/3"

  std::optional<GltfValue> find(std::string_view key) const; ///< member of an object; null counts as absent
  GltfValue at(std::string_view key) const;
  /// Member of the object `extensions`.
  std::optional<GltfValue> extension(std::string_view name) const;
  std::vector<GltfValue> items() const;                     ///< of an array
  std::vector<GltfValue> items(std::string_view key) const; ///< of an array that may be absent
  GltfValue item(std::size_t index) const;                  ///< of an array; below size()
  std::size_t size() const;                                 ///< of an array

  const std::string& text() const;
  std::string text_or(std::string_view key, std::string_view instead) const;
  bool flag_or(std::string_view key, bool instead) const;
  double number() const;     ///< within +-k_largest_number
  std::size_t whole() const; ///< 0 to 2^53; 3.0 is one
  std::size_t whole_or(std::string_view key, std::size_t instead) const;
  std::vector<double> numbers() const;
  std::vector<double> numbers(std::size_t count) const; ///< exactly so many

  InputError error(std::string expected) const; ///< found = the value itself, in short
  InputError error(std::string found, std::string expected) const;

private:
  std::string shown() const;

  const std::string* file_;
  const nlohmann::json* node_;
  std::string pointer_;
};

} // namespace tutu::rig::import_detail
