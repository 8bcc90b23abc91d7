#include "rig/import/gltf/accessors.h"

#include "rig/io/memory_limit.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>

namespace tutu::rig::import_detail {
namespace {

constexpr std::size_t k_most_zeros = std::size_t{1} << 22; ///< elements of an accessor without bytes

struct Type {
  std::string_view name;
  int width;
};
/// Those that anything here is stored in; MAT2 and MAT3, whose columns may be padded, are not among them.
constexpr std::array<Type, 4> k_types = {{{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}}};

int width_of(std::string_view type) {
  return std::find_if(k_types.begin(), k_types.end(), [&](const Type& t) { return t.name == type; })->width;
}

std::size_t size_of(GltfComponent component) {
  switch (component) {
  case GltfComponent::int8:
  case GltfComponent::uint8: return 1;
  case GltfComponent::int16:
  case GltfComponent::uint16: return 2;
  case GltfComponent::uint32:
  case GltfComponent::float32: break;
  }
  return 4;
}

GltfComponent component_of(const GltfValue& value) {
  const std::size_t number = value.whole();
  if (number < 5120 || number > 5126 || number == 5124) throw value.error("5120, 5121, 5122, 5123, 5125 or 5126");
  return static_cast<GltfComponent>(number);
}

/// Calls with a value of the type that the component is stored in.
template <typename Use> void with_type(GltfComponent component, const Use& use) {
  switch (component) {
  case GltfComponent::int8: return use(std::int8_t{});
  case GltfComponent::uint8: return use(std::uint8_t{});
  case GltfComponent::int16: return use(std::int16_t{});
  case GltfComponent::uint16: return use(std::uint16_t{});
  case GltfComponent::uint32: return use(std::uint32_t{});
  case GltfComponent::float32: return use(float{});
  }
}

template <typename From> From stored(const char* at) {
  From value;
  std::memcpy(&value, at, sizeof value); // nothing promises alignment
  return value;
}

template <typename From, typename To> To plain_value(From value) { return static_cast<To>(value); }
template <typename From, typename To> To normalized_value(From value) {
  constexpr To k_largest = static_cast<To>(std::numeric_limits<From>::max());
  const To number = static_cast<To>(value) / k_largest;
  if constexpr (std::is_signed_v<From>) return std::max(number, To{-1});
  return number;
}

template <typename From, typename To>
void convert(const GltfElements& elements, const char* from, std::size_t stride, std::size_t count, To* to) {
  const auto width = static_cast<std::size_t>(elements.width);
  if (std::is_same_v<From, To> && stride == width * sizeof(From)) {
    std::memcpy(to, from, count * stride);
    return;
  }
  const auto each = [&](auto value_of) {
    for (std::size_t i = 0; i < count; ++i, from += stride)
      for (std::size_t k = 0; k < width; ++k) *to++ = value_of(stored<From>(from + k * sizeof(From)));
  };
  if constexpr (std::is_integral_v<From> && std::is_floating_point_v<To>) {
    if (elements.normalized) return each(normalized_value<From, To>);
  }
  each(plain_value<From, To>);
}

std::size_t index_at(const GltfElements::Sparse& sparse, std::size_t k) {
  switch (sparse.index_component) {
  case GltfComponent::uint8: return stored<std::uint8_t>(sparse.indices + k);
  case GltfComponent::uint16: return stored<std::uint16_t>(sparse.indices + 2 * k);
  default: return stored<std::uint32_t>(sparse.indices + 4 * k);
  }
}

template <typename From, typename To> void read(const GltfElements& elements, To* to) {
  const auto width = static_cast<std::size_t>(elements.width);
  if (elements.first) convert<From>(elements, elements.first, elements.stride, elements.count, to);
  else std::fill(to, to + elements.numbers(), To{0});
  if (!elements.sparse) return;
  const std::size_t size = width * sizeof(From);
  for (std::size_t k = 0; k < elements.sparse->count; ++k)
    convert<From>(elements, elements.sparse->values + k * size, size, 1, to + index_at(*elements.sparse, k) * width);
}

template <typename To> void read_as(const GltfElements& elements, To* to) {
  with_type(elements.component, [&]<typename From>(From) { read<From>(elements, to); });
}

} // namespace

GltfElements GltfAccessors::elements(const GltfValue& reference, std::string_view type) {
  const GltfValue from = document_.target(reference, "accessors");
  GltfElements elements;
  elements.place = from.pointer();
  elements.width = width_of(type);
  elements.component = component_of(from.at("componentType"));
  elements.normalized = from.flag_or("normalized", false);
  elements.count = from.at("count").whole();
  if (from.at("type").text() != type) throw from.at("type").error('"' + std::string(type) + '"');
  if (elements.normalized && size_of(elements.component) == 4)
    throw from.error("normalised numbers of 32 bits", "normalised integers of 8 or 16 bits");

  const std::size_t size = static_cast<std::size_t>(elements.width) * size_of(elements.component);
  if (const std::optional<GltfValue> view_reference = from.find("bufferView")) {
    const GltfView& view = buffers_.view(*view_reference);
    const std::size_t start = from.whole_or("byteOffset", 0), length = view.bytes.size();
    elements.stride = view.stride == 0 ? size : view.stride;
    if (elements.stride < size)
      throw from.error("elements of " + std::to_string(size) + " bytes at a stride of " + std::to_string(view.stride),
                       "elements that do not overlap");
    const bool is_inside = elements.count == 0 || (start <= length && size <= length - start &&
                                                   (elements.count - 1) <= (length - start - size) / elements.stride);
    if (!is_inside)
      throw from.error(std::to_string(elements.count) + " elements of " + std::to_string(size) + " bytes from byte " +
                           std::to_string(start) + " at a stride of " + std::to_string(elements.stride),
                       "elements within a view of " + std::to_string(length) + " bytes");
    if (elements.count > 0) elements.first = view.bytes.data() + start;
  } else if (elements.count > k_most_zeros) {
    throw from.error(with_commas(elements.count) + " elements without a buffer view",
                     "at most " + with_commas(k_most_zeros));
  }
  if (const std::optional<GltfValue> sparse = from.find("sparse")) elements.sparse = sparse_of(*sparse, elements);
  return elements;
}

GltfElements::Sparse GltfAccessors::sparse_of(const GltfValue& from, const GltfElements& elements) {
  GltfElements::Sparse sparse;
  sparse.count = from.at("count").whole();
  if (sparse.count > elements.count)
    throw from.error(std::to_string(sparse.count) + " elements", "at most " + std::to_string(elements.count));
  const GltfValue indices = from.at("indices");
  sparse.index_component = component_of(indices.at("componentType"));
  if (sparse.index_component != GltfComponent::uint8 && sparse.index_component != GltfComponent::uint16 &&
      sparse.index_component != GltfComponent::uint32)
    throw indices.at("componentType").error("5121, 5123 or 5125");
  sparse.indices = packed(indices, sparse.count, size_of(sparse.index_component), "indices");
  sparse.values = packed(from.at("values"), sparse.count,
                         static_cast<std::size_t>(elements.width) * size_of(elements.component), "values");
  for (std::size_t k = 0; k < sparse.count; ++k)
    if (const std::size_t index = index_at(sparse, k); index >= elements.count)
      throw indices.error("index " + std::to_string(index), "indices below " + std::to_string(elements.count));
  return sparse;
}

const char* GltfAccessors::packed(const GltfValue& from, std::size_t count, std::size_t size, const char* what) {
  const std::string_view bytes = buffers_.view(from.at("bufferView")).bytes;
  const std::size_t start = from.whole_or("byteOffset", 0);
  if (start > bytes.size() || count > (bytes.size() - start) / size)
    throw from.error(std::to_string(count) + " " + what + " from byte " + std::to_string(start),
                     "all of them within a view of " + std::to_string(bytes.size()) + " bytes");
  return bytes.data() + start;
}

void read_numbers(const GltfElements& elements, float* to) { read_as(elements, to); }
void read_numbers(const GltfElements& elements, double* to) { read_as(elements, to); }

void read_wholes(const GltfElements& elements, std::uint32_t* to) { read_as(elements, to); }

} // namespace tutu::rig::import_detail
