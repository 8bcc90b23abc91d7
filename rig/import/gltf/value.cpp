#include "rig/import/gltf/value.h"

#include "rig/io/memory_limit.h"
#include "rig/math.h"
#include "rig/text.h"

#include <algorithm>
#include <cmath>

namespace tutu::rig::import_detail {
namespace {

using nlohmann::json;

constexpr std::size_t k_longest_shown = 60;

std::string shortened(std::string_view text, std::size_t longest) {
  return plain_text(text.substr(0, longest)) + (text.size() > longest ? "..." : "");
}

/// "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error ..." -> "syntax error ...".
std::string reason_of(std::string_view what) {
  if (const std::size_t bracket = what.find("] "); bracket != what.npos) what.remove_prefix(bracket + 2);
  if (const std::size_t colon = what.find(": "); what.starts_with("parse error at") && colon != what.npos)
    what.remove_prefix(colon + 2);
  return shortened(what, 160);
}

/// Builds the tree in one pass and minds what nlohmann's own builder does not.
class TreeBuilder final : public nlohmann::json_sax<json> {
public:
  TreeBuilder(std::string_view text, const std::string& file) : text_(text), file_(file), limit_(memory_limit()) {}

  json take() { return std::move(root_); }
  bool met_foreign_bytes() const { return met_foreign_bytes_; }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const std::string&) override { return add(value); }
  bool string(std::string& value) override {
    bytes_ += static_cast<double>(value.size());
    return add(std::move(value));
  }
  bool binary(binary_t&) override { return false; } // not in text
  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    const auto [member, is_new] = open_.back()->emplace(name, nullptr);
    if (!is_new)
      throw InputError(file_, "key \"" + shortened(name, k_longest_shown) + "\"", "it twice in one object", "it once");
    bytes_ += k_bytes_a_member + static_cast<double>(name.size());
    member_ = &*member;
    return true;
  }
  bool parse_error(std::size_t offset, const std::string&, const json::exception& error) override {
    met_foreign_bytes_ = std::string_view(error.what()).find("ill-formed UTF-8") != std::string_view::npos;
    if (met_foreign_bytes_) return false;
    throw InputError(file_, line_and_column(text_, offset), reason_of(error.what()), "JSON");
  }

private:
  /// Of the tree, at the most: a value in an array that grows, a container, a member of an object.
  static constexpr double k_bytes_a_value = 48.0, k_bytes_a_container = 96.0, k_bytes_a_member = 112.0;

  template <typename T> bool add(T&& value) {
    place(std::forward<T>(value));
    return true;
  }
  bool open(json container) {
    constexpr std::size_t k_deepest = 128; // extras of exporters are some ten deep
    if (open_.size() == k_deepest) throw InputError(file_, "", "more than 128 levels of nesting", "at most 128");
    bytes_ += k_bytes_a_container;
    open_.push_back(&place(std::move(container)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  json& place(json value) {
    bytes_ += k_bytes_a_value;
    if (bytes_ > limit_) check_memory(bytes_, file_, "", "its JSON");
    if (open_.empty()) return root_ = std::move(value);
    if (open_.back()->is_object()) return *member_ = std::move(value);
    open_.back()->push_back(std::move(value));
    return open_.back()->back();
  }

  std::string_view text_;
  const std::string& file_;
  double limit_, bytes_ = 0.0;
  json root_;
  std::vector<json*> open_; ///< containers that are not closed; none of them moves while an inner one is open
  json* member_ = nullptr;
  bool met_foreign_bytes_ = false;
};

/// Of the text, UTF-8 alone; its lines stay.
std::string without_foreign_bytes(std::string_view text) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  std::string clean;
  clean.reserve(text.size());
  while (!text.empty()) {
    const auto size = static_cast<std::size_t>(std::find_if(text.begin(), text.end(), is_control) - text.begin());
    clean += plain_text(text.substr(0, size));
    text.remove_prefix(size);
    if (text.empty()) break;
    clean.push_back(text.front());
    text.remove_prefix(1);
  }
  return clean;
}

} // namespace

GltfTree parse_gltf(std::string_view text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == text.npos) throw InputError(file, "", "no JSON", "glTF 2.0");
  GltfTree tree;
  TreeBuilder builder(text, file);
  json::sax_parse(text, &builder);
  tree.has_foreign_bytes = builder.met_foreign_bytes();
  if (tree.has_foreign_bytes) {
    const std::string clean = without_foreign_bytes(text);
    TreeBuilder again(clean, file);
    // An error that quotes the words by which such bytes are known would be taken for one.
    if (!json::sax_parse(clean, &again)) throw InputError(file, "", "text that cannot be read", "JSON");
    tree.root = again.take();
  } else {
    tree.root = builder.take();
  }
  if (!tree.root.is_object()) throw InputError(file, "", "JSON that is no object", "glTF 2.0");
  return tree;
}

std::optional<GltfValue> GltfValue::find(std::string_view key) const {
  if (!node_->is_object()) throw error("an object");
  const auto found = node_->find(key);
  if (found == node_->end() || found->is_null()) return std::nullopt;
  return GltfValue(*file_, *found, pointer_ + "/" + std::string(key));
}

GltfValue GltfValue::at(std::string_view key) const {
  if (auto value = find(key)) return *std::move(value);
  throw error("no \"" + std::string(key) + "\"", "it to be given");
}

std::optional<GltfValue> GltfValue::extension(std::string_view name) const {
  const std::optional<GltfValue> all = find("extensions");
  return all ? all->find(name) : std::nullopt;
}

std::vector<GltfValue> GltfValue::items() const {
  std::vector<GltfValue> all;
  all.reserve(size());
  for (std::size_t i = 0; i < node_->size(); ++i) all.push_back(item(i));
  return all;
}

std::vector<GltfValue> GltfValue::items(std::string_view key) const {
  const std::optional<GltfValue> list = find(key);
  return list ? list->items() : std::vector<GltfValue>();
}

GltfValue GltfValue::item(std::size_t index) const {
  return {*file_, (*node_)[index], pointer_ + "/" + std::to_string(index)};
}

std::size_t GltfValue::size() const {
  if (!node_->is_array()) throw error("an array");
  return node_->size();
}

const std::string& GltfValue::text() const {
  if (!node_->is_string()) throw error("a string");
  return node_->get_ref<const std::string&>();
}

std::string GltfValue::text_or(std::string_view key, std::string_view instead) const {
  const std::optional<GltfValue> value = find(key);
  return value ? value->text() : std::string(instead);
}

bool GltfValue::flag_or(std::string_view key, bool instead) const {
  const std::optional<GltfValue> value = find(key);
  if (!value) return instead;
  if (!value->node_->is_boolean()) throw value->error("true or false");
  return value->node_->get<bool>();
}

double GltfValue::number() const {
  if (!node_->is_number()) throw error("a number");
  const double value = node_->get<double>();
  if (!(std::abs(value) <= k_largest_number)) throw error("a finite number within +-1e9");
  return value;
}

std::size_t GltfValue::whole() const {
  constexpr double k_largest_whole = 9007199254740992.0; // 2^53
  if (!node_->is_number()) throw error("a whole number");
  const double value = node_->get<double>();
  if (!(value >= 0.0 && value <= k_largest_whole) || value != std::floor(value))
    throw error("a whole number, 0 or above");
  return static_cast<std::size_t>(value);
}

std::size_t GltfValue::whole_or(std::string_view key, std::size_t instead) const {
  const std::optional<GltfValue> value = find(key);
  return value ? value->whole() : instead;
}

std::vector<double> GltfValue::numbers() const {
  std::vector<double> all;
  all.reserve(size());
  for (std::size_t i = 0; i < node_->size(); ++i) {
    const json& number = (*node_)[i];
    const bool is_good = number.is_number() && std::abs(number.get<double>()) <= k_largest_number;
    all.push_back(is_good ? number.get<double>() : item(i).number()); // which says what is wrong
  }
  return all;
}

std::vector<double> GltfValue::numbers(std::size_t count) const {
  if (size() != count) throw error("an array of " + std::to_string(count) + " numbers");
  return numbers();
}

InputError GltfValue::error(std::string expected) const { return error(shown(), std::move(expected)); }

InputError GltfValue::error(std::string found, std::string expected) const {
  return {*file_, pointer_.empty() ? "/" : pointer_, std::move(found), std::move(expected)};
}

std::string GltfValue::shown() const {
  if (node_->is_string()) return '"' + shortened(node_->get_ref<const std::string&>(), k_longest_shown) + '"';
  if (node_->is_array()) return "an array of " + std::to_string(node_->size());
  if (node_->is_object()) return "an object";
  return node_->dump();
}

} // namespace tutu::rig::import_detail
