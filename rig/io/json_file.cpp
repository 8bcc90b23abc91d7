#include "rig/io/json_file.h"

#include "rig/io/file_io.h"
#include "rig/io/memory_limit.h"
#include "rig/text.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tutu {
namespace {

using nlohmann::json;

std::string shortened(const json& value) {
  constexpr std::size_t k_longest = 60;
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > k_longest) text = text.substr(0, k_longest) + "...";
  return text;
}

std::string listed(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

/// Number for a message: as short as it can be.
std::string shown(double value) { return json(value).dump(); }

/// "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error ..." -> "syntax error ...".
std::string reason_of(const char* what) {
  std::string text = what;
  if (const std::size_t bracket = text.find("] "); bracket != std::string::npos) text = text.substr(bracket + 2);
  const std::size_t position = text.find(": ");
  return position == std::string::npos ? text : text.substr(position + 2);
}

/// Where a number stands that is too large to be read: the parser says only its text, between quotes.
std::string place_of_number(std::string_view text, const std::string& reason) {
  const std::size_t start = reason.find('\''), end = reason.rfind('\'');
  if (start == std::string::npos || end <= start) return "";
  const std::size_t offset = text.find(reason.substr(start + 1, end - start - 1));
  return offset == std::string_view::npos ? "" : line_and_column(text, offset + 1);
}

/// Bytes that a value takes in the tree, with what readers of it take for a while (JsonValue::items), at the most: of a
/// value, of a text besides, of an array or object besides its values, of a member besides its value. Measured as the
/// peak of the process (tests/rig/io/test_memory_limit.cpp does it again).
constexpr double k_bytes_a_value = 80.0, k_bytes_a_text = 64.0, k_bytes_a_container = 288.0, k_bytes_a_member = 288.0;

/// What parsing the text will take, and what it is made of, by what separates its values: counted in one pass. Comments
/// count as what they look like.
struct Size {
  double bytes = 0.0;
  std::uint64_t values = 0;
};
Size size_of(std::string_view text) {
  std::uint64_t values = 1, quotes = 0, containers = 0, members = 0;
  bool in_string = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '"') {
      in_string = !in_string;
      ++quotes;
    } else if (in_string) k += c == '\\'; // what follows means nothing
    else if (c == ',') ++values;
    else if (c == ':') ++members;
    else if (c == '[' || c == '{') ++containers;
  }
  return {k_bytes_a_value * static_cast<double>(values) + k_bytes_a_text * static_cast<double>(quotes / 2) +
              k_bytes_a_container * static_cast<double>(containers) + k_bytes_a_member * static_cast<double>(members) +
              static_cast<double>(text.size()),
          values};
}

/// What the parser does not object to: nesting without end, a key twice. (Before it builds anything, and not from its
/// own callback, which looks through all of an array after each object in it.)
class Checks final : public nlohmann::json_sax<json> {
public:
  explicit Checks(const std::string& file) : file_(file) {}

  bool start_object(std::size_t) override {
    keys_.emplace_back();
    return deeper();
  }
  bool end_object() override {
    keys_.pop_back();
    --depth_;
    return true;
  }
  bool start_array(std::size_t) override { return deeper(); }
  bool end_array() override {
    --depth_;
    return true;
  }
  bool key(std::string& name) override {
    if (!keys_.back().insert(name).second)
      throw InputError(file_, "key \"" + name + "\"", "it twice in one object", "it once");
    return true;
  }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(binary_t&) override { return true; }
  /// Told by the parser that builds the tree.
  bool parse_error(std::size_t, const std::string&, const json::exception&) override { return false; }

private:
  bool deeper() {
    constexpr int k_deepest = 64; // far deeper than any of our files; keeps a hostile file off the stack
    if (++depth_ > k_deepest) throw InputError(file_, "", "more than 64 levels of nesting", "at most 64");
    return true;
  }

  const std::string& file_;
  std::vector<std::set<std::string>> keys_; ///< of the objects that are open
  int depth_ = 0;
};

} // namespace

JsonValue JsonValue::read(const std::filesystem::path& file) {
  return within_memory(file.string(), [&] { return parse(read_file(file), file.string()); });
}

JsonValue JsonValue::parse(std::string_view text, std::string name) {
  auto document = std::make_shared<Document>();
  document->file = std::move(name);
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    throw InputError(document->file, "", "an empty file", "JSON");
  const Size size = size_of(text);
  check_memory(size.bytes, document->file, "", "JSON of " + with_commas(size.values) + " values");

  Checks checks(document->file);
  json::sax_parse(text, &checks, json::input_format_t::json, true, true);
  try {
    document->root = json::parse(text, nullptr, true, true);
  } catch (const json::parse_error& error) {
    throw InputError(document->file, line_and_column(text, error.byte), reason_of(error.what()), "JSON");
  } catch (const json::exception& error) {
    const std::string reason = reason_of(error.what());
    throw InputError(document->file, place_of_number(text, reason), reason, "JSON with finite numbers");
  }
  const json* root = &document->root;
  return {std::move(document), root, ""};
}

JsonValue JsonValue::child(const std::string& step, const json& node) const {
  return {document_, &node, pointer_ + "/" + step};
}

InputError JsonValue::error(std::string expected) const { return error(shortened(*node_), std::move(expected)); }

InputError JsonValue::error(std::string found, std::string expected) const {
  return {document_->file, pointer_.empty() ? "/" : pointer_, std::move(found), std::move(expected)};
}

bool JsonValue::has(const char* key) const { return find(key).has_value(); }

std::optional<JsonValue> JsonValue::find(const char* key) const {
  if (!node_->is_object()) throw error("an object");
  const auto found = node_->find(key);
  if (found == node_->end()) return std::nullopt;
  return child(key, *found);
}

JsonValue JsonValue::at(const char* key) const {
  if (auto value = find(key)) return *value;
  throw error("no key \"" + std::string(key) + "\"", "it to be given");
}

std::vector<JsonValue> JsonValue::items() const {
  if (!node_->is_array()) throw error("an array");
  std::vector<JsonValue> all;
  all.reserve(node_->size());
  for (std::size_t i = 0; i < node_->size(); ++i) all.push_back(child(std::to_string(i), (*node_)[i]));
  return all;
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
  if (!node_->is_object()) throw error("an object");
  std::vector<std::pair<std::string, JsonValue>> all;
  for (const auto& [key, value] : node_->items()) {
    if (!is_plain_text(key)) throw error("the key " + shortened(json(key)), "keys without control characters");
    all.emplace_back(key, child(key, value));
  }
  return all;
}

void JsonValue::only_keys(std::span<const std::string_view> known) const {
  if (!node_->is_object()) throw error("an object");
  for (const auto& [key, value] : node_->items()) {
    if (key == "$schema" || key == "comment") continue;
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw child(key, value).error("unknown key \"" + key + "\"", "one of: " + listed(known));
  }
}

std::string JsonValue::string() const {
  if (!node_->is_string()) throw error("a string");
  const std::string& text = node_->get_ref<const std::string&>();
  if (!is_plain_text(text)) throw error("text without control characters");
  return text;
}

std::string JsonValue::string_among(std::span<const std::string_view> choices) const {
  std::string value = string();
  if (std::find(choices.begin(), choices.end(), value) == choices.end()) throw error("one of: " + listed(choices));
  return value;
}

bool JsonValue::boolean() const {
  if (!node_->is_boolean()) throw error("true or false");
  return node_->get<bool>();
}

double JsonValue::number() const {
  if (!node_->is_number()) throw error("a number");
  const double value = node_->get<double>();
  if (!(std::abs(value) <= k_largest_number)) throw error("a finite number within +-1e9");
  return value;
}

double JsonValue::number_in(double lowest, double highest) const {
  if (!node_->is_number() || !(number() >= lowest && number() <= highest))
    throw error("a number from " + shown(lowest) + " to " + shown(highest));
  return number();
}

double JsonValue::positive() const {
  if (!node_->is_number() || !(number() > 0.0)) throw error("a number above 0");
  return number();
}

double JsonValue::non_negative() const {
  if (!node_->is_number() || !(number() >= 0.0)) throw error("a number, 0 or above");
  return number();
}

int JsonValue::integer_in(int lowest, int highest) const {
  const bool good = node_->is_number_integer() && number() >= lowest && number() <= highest;
  if (!good) throw error("a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest));
  return node_->get<int>();
}

std::vector<double> JsonValue::numbers() const {
  if (!node_->is_array()) throw error("an array");
  std::vector<double> all;
  all.reserve(node_->size());
  for (std::size_t i = 0; i < node_->size(); ++i) {
    const json& item = (*node_)[i];
    const bool is_good = item.is_number() && std::abs(item.get<double>()) <= k_largest_number;
    all.push_back(is_good ? item.get<double>() : child(std::to_string(i), item).number()); // which says what is wrong
  }
  return all;
}

std::vector<double> JsonValue::numbers(std::size_t count) const {
  if (!node_->is_array() || node_->size() != count) throw error("an array of " + std::to_string(count) + " numbers");
  return numbers();
}

Vec3 JsonValue::vec3() const {
  const std::vector<double> v = numbers(3);
  return {v[0], v[1], v[2]};
}

} // namespace tutu
