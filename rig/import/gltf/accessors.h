// Private to the glTF reader: accessors as numbers.
#pragma once

#include "rig/import/gltf/buffers.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tutu::rig::import_detail {

/// componentType [glTF 2.0, 3.6.2.2].
enum class GltfComponent { int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126 };

/// Elements of `width` numbers that lie `stride` bytes apart, all within memory that is there; what is sparse replaces
/// some of them.
struct GltfElements {
  std::string place; ///< of the accessor, for messages
  std::size_t count = 0;
  int width = 1;
  GltfComponent component = GltfComponent::float32;
  bool normalized = false;
  const char* first = nullptr; ///< nullptr: zeros
  std::size_t stride = 0;

  struct Sparse {
    std::size_t count = 0;
    GltfComponent index_component = GltfComponent::uint32;
    const char* indices = nullptr; ///< packed, each below the elements' count
    const char* values = nullptr;  ///< packed
  };
  std::optional<Sparse> sparse;

  std::size_t numbers() const { return count * static_cast<std::size_t>(width); }
  bool is_float() const { return component == GltfComponent::float32; }
};

/// Finds the elements of accessors.
class GltfAccessors {
public:
  GltfAccessors(const GltfDocument& document, GltfMemory& memory)
      : document_(document), memory_(memory), buffers_(document, memory) {}

  /// Of the accessor that `reference` names by its index. Throws InputError unless it is of this type ("VEC3") and
  /// within its bytes; without any it has at most 4,194,304 elements.
  GltfElements elements(const GltfValue& reference, std::string_view type);
  /// The bytes of the buffer view that `reference` names.
  std::string_view bytes(const GltfValue& reference) { return buffers_.view(reference).bytes; }
  const GltfDocument& document() const { return document_; }
  GltfMemory& memory() { return memory_; }

private:
  GltfElements::Sparse sparse_of(const GltfValue& sparse, const GltfElements& elements);
  const char* packed(const GltfValue& from, std::size_t count, std::size_t size, const char* what);

  const GltfDocument& document_;
  GltfMemory& memory_;
  GltfBuffers buffers_;
};

/// All numbers, elements.numbers() of them; integers that are normalised as c / 255, max(c / 127, -1), c / 65535,
/// max(c / 32767, -1) [glTF 2.0, 3.11].
void read_numbers(const GltfElements& elements, float* to);
void read_numbers(const GltfElements& elements, double* to);
/// Of unsigned integers that are not normalised.
void read_wholes(const GltfElements& elements, std::uint32_t* to);

} // namespace tutu::rig::import_detail
