// EXT_meshopt_compression and, of the same layout, KHR_meshopt_compression: libmeshoptimizer decodes the streams, and
// trusts the layout it is told (it only asserts), so that is checked here by the extension's own rules.
#include "rig/import/gltf/buffers.h"

#include <algorithm>
#include <array>
#include <meshoptimizer.h>
#include <string>

namespace tutu::rig::import_detail {
namespace {

enum class Mode { attributes, triangles, indices };
enum class Filter { none, octahedral, quaternion, exponential };
constexpr std::array<std::string_view, 3> k_modes = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr std::array<std::string_view, 4> k_filters = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};

struct Layout {
  Mode mode;
  Filter filter = Filter::none;
  std::size_t stride, count;
};

template <std::size_t size>
std::size_t named(const GltfValue& value, const std::array<std::string_view, size>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), value.text());
  if (found == names.end()) throw value.error("one that " + name + " has");
  return static_cast<std::size_t>(found - names.begin());
}

bool is_allowed(const Layout& layout) {
  const std::size_t stride = layout.stride;
  if (layout.mode != Mode::attributes) {
    const bool is_whole = layout.mode == Mode::indices || layout.count % 3 == 0;
    return (stride == 2 || stride == 4) && layout.filter == Filter::none && is_whole;
  }
  if (stride == 0 || stride % 4 != 0 || stride > 256) return false;
  if (layout.filter == Filter::octahedral) return stride == 4 || stride == 8;
  return layout.filter != Filter::quaternion || stride == 8;
}

/// The most bytes a stream of this many may hold. Attributes: 64 elements share a byte for each of their bytes at the
/// least; triangles and indices: each takes a byte [EXT_meshopt_compression, appendix A].
std::size_t largest_content(const Layout& layout, std::size_t stream) {
  if (layout.mode == Mode::attributes) return 64 * stream;
  return stream * layout.stride * (layout.mode == Mode::triangles ? 3 : 1);
}

bool decode(const Layout& layout, std::string_view stream, char* to) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(stream.data());
  switch (layout.mode) {
  case Mode::attributes: return meshopt_decodeVertexBuffer(to, layout.count, layout.stride, bytes, stream.size()) == 0;
  case Mode::triangles: return meshopt_decodeIndexBuffer(to, layout.count, layout.stride, bytes, stream.size()) == 0;
  case Mode::indices: return meshopt_decodeIndexSequence(to, layout.count, layout.stride, bytes, stream.size()) == 0;
  }
  return false;
}

void unfilter(const Layout& layout, char* bytes) {
  if (layout.filter == Filter::octahedral) meshopt_decodeFilterOct(bytes, layout.count, layout.stride);
  if (layout.filter == Filter::quaternion) meshopt_decodeFilterQuat(bytes, layout.count, layout.stride);
  if (layout.filter == Filter::exponential) meshopt_decodeFilterExp(bytes, layout.count, layout.stride);
}

} // namespace

std::string decode_meshopt(const GltfValue& extension, const std::string& name, std::string_view stream,
                           GltfMemory& memory) {
  Layout layout{.mode = static_cast<Mode>(named(extension.at("mode"), k_modes, name)),
                .stride = extension.at("byteStride").whole(),
                .count = extension.at("count").whole()};
  if (const std::optional<GltfValue> filter = extension.find("filter"))
    layout.filter = static_cast<Filter>(named(*filter, k_filters, name));
  if (!is_allowed(layout))
    throw extension.error("a count, a stride and a filter that do not go together",
                          "a layout that " + name + " allows");
  const std::string expected = "a stream that is not damaged";
  if (layout.mode == Mode::attributes && stream.starts_with('\xa1'))
    throw extension.error(name + ": a stream of version 1, which is not read", "version 0");
  if (layout.count > largest_content(layout, stream.size()) / layout.stride)
    throw extension.error(name + ": a stream of " + std::to_string(stream.size()) + " bytes for " +
                              std::to_string(layout.count) + " elements, which cannot be decoded",
                          expected);
  memory.take(layout.count * layout.stride, extension.pointer());
  std::string bytes(layout.count * layout.stride, '\0');
  if (!decode(layout, stream, bytes.data()))
    throw extension.error(name + ": a stream that cannot be decoded", expected);
  unfilter(layout, bytes.data());
  return bytes;
}

} // namespace tutu::rig::import_detail
