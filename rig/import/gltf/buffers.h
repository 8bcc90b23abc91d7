// Private to the glTF reader: the bytes of buffers and of their views, each fetched when it is first asked for.
#pragma once

#include "rig/import/detail/reach.h"
#include "rig/import/gltf/document.h"
#include "rig/import/gltf/memory.h"

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig::import_detail {

/// Bytes of a buffer view, decompressed. They live as long as the GltfBuffers they come from.
struct GltfView {
  std::string_view bytes;
  std::size_t stride = 0; ///< bytes from an element to the next; 0: as large as an element
};

class GltfBuffers {
public:
  /// Throws InputError on a buffer whose name leads out of the file's folder, whether or not it is used.
  GltfBuffers(const GltfDocument& document, GltfMemory& memory);

  /// The view that `reference` names by its index. Throws InputError on bytes that are missing, cut or damaged.
  const GltfView& view(const GltfValue& reference);
  /// buffer, byteOffset and byteLength of a view, or of what stands for one.
  std::string_view range(const GltfValue& from);

private:
  std::string_view buffer(const GltfValue& reference);
  std::string_view load(const GltfValue& buffer, std::size_t index);
  std::string_view keep(std::string bytes);

  const GltfDocument& document_;
  GltfMemory& memory_;
  Reach reach_;
  std::vector<std::optional<std::string_view>> buffers_;
  std::vector<std::optional<GltfView>> views_;
  std::deque<std::string> kept_; ///< of what is not in the file itself
};

/// The bytes of a view that carries EXT_ or KHR_meshopt_compression (`extension` is its object there), decompressed and
/// unfiltered: count * byteStride. Throws InputError naming the extension (`name`) on layouts that it does not allow
/// and on streams that cannot be decoded; takes memory only for what a stream of this size can hold.
std::string decode_meshopt(const GltfValue& extension, const std::string& name, std::string_view stream,
                           GltfMemory& memory);

/// The bytes of "data:...;base64,...". Throws InputError when it is none.
std::string decode_data_uri(const GltfValue& uri);
/// "%20" -> " ". What is no escape stays.
std::string decode_percent(std::string_view text);

} // namespace tutu::rig::import_detail
