#include "rig/import/gltf/buffers.h"

#include "rig/io/file_io.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace tutu::rig::import_detail {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view k_data = "data:";
constexpr std::array<const char*, 2> k_meshopt = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

bool is_data(std::string_view uri) { return uri.starts_with(k_data); }

/// What a buffer's name may mean: as the standard has it, with escapes [RFC 3986]; as those write it who do not escape;
/// and with the folders of Windows.
std::vector<std::string> meanings_of(const std::string& uri) {
  std::vector<std::string> names = {decode_percent(uri), uri};
  for (std::size_t i = 0; i < 2; ++i) {
    std::string name = names[i];
    std::replace(name.begin(), name.end(), '\\', '/');
    names.push_back(std::move(name));
  }
  return names;
}

int value_of_hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// -1 for what is no digit.
constexpr std::array<signed char, 256> k_base64 = [] {
  constexpr std::string_view k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<signed char, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < k_digits.size(); ++i)
    values[static_cast<unsigned char>(k_digits[i])] = static_cast<signed char>(i);
  return values;
}();

} // namespace

std::string decode_percent(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_escape =
        text[i] == '%' && i + 2 < text.size() && value_of_hex(text[i + 1]) >= 0 && value_of_hex(text[i + 2]) >= 0;
    if (!is_escape) {
      plain.push_back(text[i]);
      continue;
    }
    plain.push_back(static_cast<char>(value_of_hex(text[i + 1]) * 16 + value_of_hex(text[i + 2])));
    i += 2;
  }
  return plain;
}

std::string decode_data_uri(const GltfValue& uri) {
  std::string_view text = uri.text();
  const std::size_t comma = text.find(',');
  if (comma == text.npos || !text.substr(0, comma).ends_with(";base64"))
    throw uri.error("data of another kind", "data in base64: \"data:...;base64,...\"");
  text.remove_prefix(comma + 1);
  std::string plain;
  if (text.find('%') != text.npos) text = plain = decode_percent(text);
  while (text.ends_with('=')) text.remove_suffix(1);

  if (text.size() % 4 == 1) throw uri.error("base64 that is cut off", "data in base64");
  std::string bytes((text.size() * 3 + 2) / 4, '\0');
  char* to = bytes.data();
  int wrong = 0; // below 0 once a character is no digit
  for (std::size_t i = 0; i < text.size(); i += 4) {
    std::uint32_t bits = 0;
    const std::size_t digits = std::min<std::size_t>(4, text.size() - i);
    for (std::size_t k = 0; k < 4; ++k) {
      const int digit = k < digits ? k_base64[static_cast<unsigned char>(text[i + k])] : 0;
      wrong |= digit;
      bits = bits << 6 | static_cast<std::uint32_t>(digit & 63);
    }
    for (std::size_t k = 0; k + 1 < digits; ++k) *to++ = static_cast<char>(bits >> (16 - 8 * k) & 0xff);
  }
  if (wrong < 0) throw uri.error("a character that is none of base64", "data in base64");
  bytes.resize(static_cast<std::size_t>(to - bytes.data()));
  return bytes;
}

GltfBuffers::GltfBuffers(const GltfDocument& document, GltfMemory& memory)
    : document_(document), memory_(memory), reach_(document.path()), buffers_(document.count("buffers")),
      views_(document.count("bufferViews")) {
  for (const GltfValue& buffer : document.root().items("buffers")) {
    const std::optional<GltfValue> uri = buffer.find("uri");
    if (!uri || is_data(uri->text())) continue;
    for (const std::string& name : meanings_of(uri->text())) {
      if (name.find('\0') != name.npos) throw uri->error("a name with a zero in it", "the name of a file");
      if (!reach_.holds_name(name)) throw out_of_reach(document.file(), uri->pointer(), name);
    }
  }
}

std::string_view GltfBuffers::keep(std::string bytes) { return kept_.emplace_back(std::move(bytes)); }

std::string_view GltfBuffers::load(const GltfValue& buffer, std::size_t index) {
  const std::optional<GltfValue> uri = buffer.find("uri");
  if (!uri) {
    if (index == 0 && document_.binary_chunk()) return *document_.binary_chunk();
    throw buffer.error("a buffer without a uri, and no binary chunk that is meant", "its bytes");
  }
  if (is_data(uri->text())) {
    memory_.take(uri->text().size(), uri->pointer());
    return keep(decode_data_uri(*uri));
  }
  std::error_code error;
  for (const std::string& name : meanings_of(uri->text())) {
    const fs::path beside = document_.path().parent_path() / name;
    if (!fs::is_regular_file(beside, error)) continue;
    memory_.take(fs::file_size(beside), uri->pointer());
    return keep(read_file(beside));
  }
  throw uri->error("no such file: " + uri->text().substr(0, 120), "the file of a buffer");
}

std::string_view GltfBuffers::buffer(const GltfValue& reference) {
  const std::size_t index = document_.target_index(reference, "buffers");
  std::optional<std::string_view>& bytes = buffers_[index];
  if (bytes) return *bytes;
  const GltfValue buffer = document_.target(reference, "buffers");
  bytes = load(buffer, index);
  const std::size_t length = buffer.at("byteLength").whole();
  if (length > bytes->size())
    throw buffer.error(std::to_string(bytes->size()) + " bytes", "byteLength: " + std::to_string(length));
  bytes = bytes->substr(0, length);
  return *bytes;
}

std::string_view GltfBuffers::range(const GltfValue& from) {
  const std::string_view bytes = buffer(from.at("buffer"));
  const std::size_t start = from.whole_or("byteOffset", 0), length = from.at("byteLength").whole();
  if (start > bytes.size() || length > bytes.size() - start)
    throw from.error("bytes " + std::to_string(start) + " to " + std::to_string(start + length),
                     "bytes of a buffer of " + std::to_string(bytes.size()));
  return bytes.substr(start, length);
}

const GltfView& GltfBuffers::view(const GltfValue& reference) {
  std::optional<GltfView>& view = views_[document_.target_index(reference, "bufferViews")];
  if (view) return *view;
  const GltfValue from = document_.target(reference, "bufferViews");
  GltfView made;
  made.stride = from.whole_or("byteStride", 0);
  bool is_compressed = false;
  for (const char* name : k_meshopt)
    if (const std::optional<GltfValue> extension = from.extension(name); extension && !is_compressed) {
      made.bytes = keep(decode_meshopt(*extension, name, range(*extension), memory_));
      is_compressed = true;
    }
  if (!is_compressed) made.bytes = range(from);
  view = made;
  return *view;
}

} // namespace tutu::rig::import_detail
