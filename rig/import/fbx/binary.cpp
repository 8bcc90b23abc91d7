// The binary form: elements with the offset of their end, 32 bits wide, from 7.5 on 64; numbers little-endian.
#include "rig/import/fbx/parse.h"

#include <bit>
#include <cstring>

namespace tutu::rig::import_detail {
namespace {

static_assert(std::endian::native == std::endian::little);

template <typename T> T number_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

class Parser {
public:
  Parser(std::string_view bytes, bool is_wide) : bytes_(bytes), is_wide_(is_wide) {}

  /// Elements up to an empty one, or up to `end`.
  std::vector<FbxElement> elements(std::size_t& at, std::size_t end, int depth, std::string_view parent = {}) {
    if (depth > k_deepest_element) throw FbxUnreadable("elements too deep in each other");
    std::vector<FbxElement> found;
    while (at < end) {
      const std::size_t next = read_word(at, end), values = read_word(at, end), length = read_word(at, end);
      const std::size_t name_length = take(at, end, 1).front() & 0xff;
      if (next == 0) return found;
      FbxElement element;
      element.name = take(at, end, name_length);
      if (next < at || next > end || length > next - at) throw FbxUnreadable("an element that ends beyond its place");
      if (!is_of_use(parent, element.name)) {
        at = next;
        continue;
      }
      const std::size_t behind_values = at + length;
      // A value is two bytes at least: more would be claimed than there is.
      if (values > length) throw FbxUnreadable("more values than there is room for");
      element.values.reserve(values);
      for (std::size_t v = 0; v < values; ++v) element.values.push_back(value(at, behind_values));
      at = behind_values;
      element.children = elements(at, next, depth + 1, element.name);
      at = next;
      found.push_back(std::move(element));
    }
    return found;
  }

private:
  std::string_view take(std::size_t& at, std::size_t end, std::size_t count) const {
    if (at > end || count > end - at) throw FbxUnreadable("lengths beyond its end");
    at += count;
    return bytes_.substr(at - count, count);
  }

  std::size_t read_word(std::size_t& at, std::size_t end) const {
    const std::string_view taken = take(at, end, is_wide_ ? 8 : 4);
    return is_wide_ ? static_cast<std::size_t>(number_at<std::uint64_t>(taken, 0)) : number_at<std::uint32_t>(taken, 0);
  }

  template <typename T> FbxValue whole(std::size_t& at, std::size_t end) const {
    FbxValue value;
    value.integer = static_cast<std::int64_t>(number_at<T>(take(at, end, sizeof(T)), 0));
    return value;
  }
  template <typename T> FbxValue real(std::size_t& at, std::size_t end) const {
    FbxValue value;
    value.kind = FbxValue::Kind::real;
    value.real = static_cast<double>(number_at<T>(take(at, end, sizeof(T)), 0));
    return value;
  }

  FbxValue value(std::size_t& at, std::size_t end) const {
    const char type = take(at, end, 1).front();
    switch (type) {
    case 'B':
    case 'C': return whole<std::uint8_t>(at, end);
    case 'Y': return whole<std::int16_t>(at, end);
    case 'I': return whole<std::int32_t>(at, end);
    case 'L': return whole<std::int64_t>(at, end);
    case 'F': return real<float>(at, end);
    case 'D': return real<double>(at, end);
    case 'S':
    case 'R': {
      FbxValue value;
      value.kind = FbxValue::Kind::text;
      value.text = take(at, end, number_at<std::uint32_t>(take(at, end, 4), 0));
      return value;
    }
    case 'b':
    case 'c': return array('b', 1, at, end);
    case 'i': return array('i', 4, at, end);
    case 'f': return array('f', 4, at, end);
    case 'l': return array('l', 8, at, end);
    case 'd': return array('d', 8, at, end);
    default: throw FbxUnreadable("a value of an unknown type");
    }
  }

  FbxValue array(char element, std::size_t size, std::size_t& at, std::size_t end) const {
    const std::string_view head = take(at, end, 12);
    FbxValue value;
    value.kind = FbxValue::Kind::array;
    value.element = element;
    value.count = number_at<std::uint32_t>(head, 0);
    const std::uint32_t encoding = number_at<std::uint32_t>(head, 4);
    if (encoding > 1) throw FbxUnreadable("an array of an unknown encoding");
    value.is_deflated = encoding == 1;
    value.text = take(at, end, value.is_deflated ? number_at<std::uint32_t>(head, 8) : std::size_t{value.count} * size);
    return value;
  }

  std::string_view bytes_;
  bool is_wide_;
};

} // namespace

std::vector<FbxElement> parse_binary_fbx(std::string_view bytes, int& version) {
  constexpr std::size_t k_head = 27; // the start, two bytes and the version
  if (bytes.size() < k_head) throw FbxUnreadable("lengths beyond its end");
  const std::uint32_t found = number_at<std::uint32_t>(bytes, k_head - 4);
  if (found < 7000 || found >= 8000) throw FbxUnreadable("of version " + std::to_string(found));
  version = static_cast<int>(found);
  std::size_t at = k_head;
  return Parser(bytes, version >= 7500).elements(at, bytes.size(), 0);
}

} // namespace tutu::rig::import_detail
