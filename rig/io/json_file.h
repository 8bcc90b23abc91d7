// Reading the JSON files a person edits: every value is asked for by name and type, every wrong one is told with its
// place (a JSON pointer), what was found and what was expected. Comments (// and /* */) are allowed.
#pragma once

#include "rig/error.h"
#include "rig/math.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tutu {

/// One value of a JSON file together with where it stands. Cheap to copy; the file's content lives as long as any of
/// its values does. All functions throw InputError on a value of another type than asked.
class JsonValue {
public:
  /// Parses `file`. Throws InputError with line and column on a syntax error, on a key given twice, on an empty file,
  /// and where its values would take more memory than memory_limit.h allows.
  static JsonValue read(const std::filesystem::path& file);
  /// The same from text; `name` stands for the file in messages.
  static JsonValue parse(std::string_view text, std::string name);

  const std::string& file() const { return document_->file; }
  const std::string& pointer() const { return pointer_; } ///< "" for the whole file

  bool has(const char* key) const;
  JsonValue at(const char* key) const;                  ///< required member of an object
  std::optional<JsonValue> find(const char* key) const; ///< optional member of an object
  std::vector<JsonValue> items() const;                 ///< elements of an array
  std::vector<std::pair<std::string, JsonValue>>
  members() const; ///< members of an object, in key order; keys as string()

  /// An object whose every key is one of these ("$schema" and "comment" are always welcome).
  /// Throws, naming the unknown key, its place, and the keys that exist.
  void only_keys(std::span<const std::string_view> known) const;
  void only_keys(std::initializer_list<std::string_view> known) const {
    only_keys(std::span(known.begin(), known.size()));
  }

  std::string string() const; ///< without control characters: names and paths end up in lines, tables and scripts
  std::string string_among(std::span<const std::string_view> choices) const;
  bool boolean() const;
  double number() const; ///< finite, within +-1e9
  double number_in(double lowest, double highest) const;
  double positive() const;     ///< > 0
  double non_negative() const; ///< >= 0
  int integer_in(int lowest, int highest) const;
  Vec3 vec3() const;
  std::vector<double> numbers() const;                  ///< any length
  std::vector<double> numbers(std::size_t count) const; ///< exactly `count`

  bool is_object() const { return node_->is_object(); }
  bool is_array() const { return node_->is_array(); }
  bool is_string() const { return node_->is_string(); }
  bool is_number() const { return node_->is_number(); }
  bool is_boolean() const { return node_->is_boolean(); }

  /// The error to throw when this value reads well but cannot be (an unknown joint, say).
  InputError error(std::string expected) const; ///< found = the value itself, shortened
  InputError error(std::string found, std::string expected) const;

private:
  struct Document {
    std::string file;
    nlohmann::json root;
  };
  JsonValue(std::shared_ptr<const Document> document, const nlohmann::json* node, std::string pointer)
      : document_(std::move(document)), node_(node), pointer_(std::move(pointer)) {}
  JsonValue child(const std::string& step, const nlohmann::json& node) const;

  std::shared_ptr<const Document> document_;
  const nlohmann::json* node_;
  std::string pointer_;
};

} // namespace tutu
