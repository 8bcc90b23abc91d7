// FBX files for tests, written from one tree as text or binary.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <variant>
#include <vector>
#include <zlib.h>

namespace tutu::test {

/// Words of 32 bits that are not all floats.
struct FbxWords {
  std::vector<std::uint32_t> words;
};
using FbxTestValue = std::variant<std::int64_t, double, std::string, std::vector<std::int64_t>,
                                  std::vector<std::int32_t>, std::vector<float>, FbxWords>;

struct FbxTestElement {
  std::string name;
  std::vector<FbxTestValue> values = {};
  std::vector<FbxTestElement> children = {};
};

struct FbxForm {
  bool is_text = true;
  int version = 7400;
  bool deflates = false;
};
inline const std::vector<FbxForm> k_fbx_forms = {{true, 7100, false},  {true, 7400, false}, {true, 7700, false},
                                                 {false, 7100, false}, {false, 7400, true}, {false, 7500, false},
                                                 {false, 7700, true}};

// Text.

template <typename T> std::string text_array(const std::vector<T>& numbers, const char* format) {
  std::string text = "*" + std::to_string(numbers.size()) + " {\n a: ";
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    char digits[40];
    std::snprintf(digits, sizeof digits, format, numbers[i]);
    text += (i ? i % 5 == 0 ? ",\n" : "," : "") + std::string(digits);
  }
  return text + "\n }";
}

inline std::string text_of(const FbxTestValue& value, int version) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* real = std::get_if<double>(&value)) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.17g", *real);
    return digits;
  }
  if (const auto* text = std::get_if<std::string>(&value)) return '"' + *text + '"';
  if (const auto* wide = std::get_if<std::vector<std::int64_t>>(&value)) {
    std::vector<long long> numbers(wide->begin(), wide->end());
    return text_array(numbers, "%lld");
  }
  if (const auto* whole = std::get_if<std::vector<std::int32_t>>(&value)) return text_array(*whole, "%d");
  if (const auto* real = std::get_if<std::vector<float>>(&value)) {
    std::vector<double> numbers(real->begin(), real->end());
    return text_array(numbers, "%.9g");
  }
  const std::vector<std::uint32_t>& words = std::get<FbxWords>(value).words;
  if (version >= 7200) return text_array(std::vector<int>(words.begin(), words.end()), "%d");
  std::vector<double> numbers;
  for (const std::uint32_t word : words) numbers.push_back(static_cast<double>(std::bit_cast<float>(word)));
  return text_array(numbers, "%.9g");
}

inline std::string text_of(const FbxTestElement& element, int version, const std::string& indent) {
  std::string text = indent + element.name + ": ";
  for (std::size_t v = 0; v < element.values.size(); ++v) text += (v ? "," : "") + text_of(element.values[v], version);
  if (element.children.empty() && !element.values.empty()) return text + "\n";
  text += " {\n";
  for (const FbxTestElement& child : element.children) text += text_of(child, version, indent + "\t");
  return text + indent + "}\n";
}

// Binary.

template <typename T> std::string bytes_of(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

template <typename T> std::string array_bytes(char type, const std::vector<T>& numbers, bool deflates) {
  std::string raw;
  for (const T number : numbers) raw += bytes_of(number);
  std::string stored = raw;
  if (deflates) {
    uLongf length = ::compressBound(raw.size());
    stored.resize(length);
    ::compress(reinterpret_cast<Bytef*>(stored.data()), &length, reinterpret_cast<const Bytef*>(raw.data()),
               raw.size());
    stored.resize(length);
  }
  return type + bytes_of(static_cast<std::uint32_t>(numbers.size())) + bytes_of(std::uint32_t{deflates}) +
         bytes_of(static_cast<std::uint32_t>(stored.size())) + stored;
}

inline std::string bytes_of(const FbxTestValue& value, bool deflates) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return 'L' + bytes_of(*whole);
  if (const auto* real = std::get_if<double>(&value)) return 'D' + bytes_of(*real);
  if (const auto* text = std::get_if<std::string>(&value)) { // "Class::Name" the other way round
    std::string stored = *text;
    if (const std::size_t at = text->find("::"); at != text->npos)
      stored = text->substr(at + 2) + std::string("\0\1", 2) + text->substr(0, at);
    return 'S' + bytes_of(static_cast<std::uint32_t>(stored.size())) + stored;
  }
  if (const auto* wide = std::get_if<std::vector<std::int64_t>>(&value)) return array_bytes('l', *wide, deflates);
  if (const auto* whole = std::get_if<std::vector<std::int32_t>>(&value)) return array_bytes('i', *whole, deflates);
  if (const auto* real = std::get_if<std::vector<float>>(&value)) return array_bytes('f', *real, deflates);
  return array_bytes('f', std::get<FbxWords>(value).words, deflates);
}

inline std::string word_bytes(std::size_t word, bool is_wide) {
  return is_wide ? bytes_of(static_cast<std::uint64_t>(word)) : bytes_of(static_cast<std::uint32_t>(word));
}

/// `at`: where in the file it begins.
inline std::string bytes_of(const FbxTestElement& element, const FbxForm& form, std::size_t at) {
  const bool is_wide = form.version >= 7500;
  const std::size_t head = (is_wide ? 24 : 12) + 1 + element.name.size();
  std::string values, children;
  for (const FbxTestValue& value : element.values) values += bytes_of(value, form.deflates);
  for (const FbxTestElement& child : element.children)
    children += bytes_of(child, form, at + head + values.size() + children.size());
  if (!element.children.empty()) children += std::string(is_wide ? 25 : 13, '\0');
  return word_bytes(at + head + values.size() + children.size(), is_wide) + word_bytes(element.values.size(), is_wide) +
         word_bytes(values.size(), is_wide) + static_cast<char>(element.name.size()) + element.name + values + children;
}

/// The whole file of these elements at the top.
inline std::string fbx_bytes(const std::vector<FbxTestElement>& elements, const FbxForm& form) {
  if (form.is_text) {
    std::string text =
        "; FBX project file\n; ----\n\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: " +
        std::to_string(form.version) + "\n\tCreator: \"a test\"\n}\n; Objects\n";
    for (const FbxTestElement& element : elements) text += text_of(element, form.version, "");
    return text;
  }
  std::string bytes =
      std::string("Kaydara FBX Binary  \0\x1a\0", 23) + bytes_of(static_cast<std::uint32_t>(form.version));
  for (const FbxTestElement& element : elements) bytes += bytes_of(element, form, bytes.size());
  return bytes + std::string(form.version >= 7500 ? 25 : 13, '\0') + "footer";
}

// Motion.

inline constexpr std::int64_t k_ticks = 46186158000; ///< a second

/// Keys of an AnimationCurve; flags and data one each key.
struct FbxTestCurve {
  std::vector<double> times;
  std::vector<float> values;
  std::vector<std::int32_t> flags;
  std::vector<std::array<std::uint32_t, 4>> data = {}; ///< none: zeros
};

inline std::uint32_t as_word(double real) { return std::bit_cast<std::uint32_t>(static_cast<float>(real)); }

/// Objects and connections of a file whose models hang in each other as they come.
class FbxTestFile {
public:
  std::vector<FbxTestElement> objects, connections;

  std::int64_t model(const std::string& name, std::int64_t parent, std::vector<FbxTestElement> properties,
                     const std::string& subkind = "LimbNode") {
    objects.push_back({"Model", {++last_, "Model::" + name, subkind}, {{"Properties70", {}, std::move(properties)}}});
    connect(last_, parent);
    return last_;
  }
  std::int64_t take(const std::string& name, std::vector<FbxTestElement> properties = {}) {
    objects.push_back(
        {"AnimationStack", {++last_, "AnimStack::" + name, ""}, {{"Properties70", {}, std::move(properties)}}});
    return last_;
  }
  std::int64_t layer(std::int64_t take_id) {
    objects.push_back({"AnimationLayer", {++last_, "AnimLayer::Base", ""}});
    connect(last_, take_id);
    return last_;
  }
  /// Of "Lcl Translation", say; curves of X, Y and Z as far as they are not null.
  void move(std::int64_t layer_id, std::int64_t model_id, const std::string& property,
            const std::array<const FbxTestCurve*, 3>& curves) {
    const std::int64_t node = ++last_;
    objects.push_back({"AnimationCurveNode", {node, "AnimCurveNode::N", ""}});
    connect(node, layer_id);
    connect(node, model_id, property);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!curves[axis]) continue;
      objects.push_back(curve_element(++last_, *curves[axis]));
      connect(last_, node, std::string("d|") + "XYZ"[axis]);
    }
  }
  void connect(std::int64_t part, std::int64_t whole, const std::string& property = "") {
    FbxTestElement element = {"C", {std::string(property.empty() ? "OO" : "OP"), part, whole}};
    if (!property.empty()) element.values.emplace_back(property);
    connections.push_back(std::move(element));
  }
  std::string bytes(const FbxForm& form = {}) const {
    return fbx_bytes({{"Objects", {}, objects}, {"Connections", {}, connections}}, form);
  }

private:
  static FbxTestElement curve_element(std::int64_t id, const FbxTestCurve& curve) {
    std::vector<std::int64_t> times;
    for (const double time : curve.times)
      times.push_back(static_cast<std::int64_t>(time * static_cast<double>(k_ticks)));
    std::vector<std::uint32_t> words;
    for (std::size_t k = 0; k < curve.times.size(); ++k)
      for (std::size_t i = 0; i < 4; ++i) words.push_back(curve.data.empty() ? 0 : curve.data[k][i]);
    return {"AnimationCurve",
            {id, std::string("AnimCurve::"), std::string()},
            {{"Default", {0.0}},
             {"KeyVer", {std::int64_t{4008}}},
             {"KeyTime", {times}},
             {"KeyValueFloat", {curve.values}},
             {"KeyAttrFlags", {curve.flags}},
             {"KeyAttrDataFloat", {FbxWords{words}}},
             {"KeyAttrRefCount", {std::vector<std::int32_t>(curve.times.size(), 1)}}}};
  }

  std::int64_t last_ = 1000;
};

inline FbxTestElement fbx_property(const std::string& name, const std::vector<double>& numbers) {
  const bool is_local = name.starts_with("Lcl "); // else of the common type
  FbxTestElement property = {
      "P", {name, is_local ? name : "Vector3D", std::string(is_local ? "" : "Vector"), std::string("A")}};
  for (const double number : numbers) property.values.emplace_back(number);
  return property;
}
inline FbxTestElement fbx_property(const std::string& name, std::int64_t number) {
  return {"P", {name, std::string("int"), std::string(), std::string(), number}};
}

} // namespace tutu::test
