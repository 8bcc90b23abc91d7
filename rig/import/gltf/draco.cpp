#include "rig/import/gltf/draco.h"

#include "rig/io/memory_limit.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <draco/compression/decode.h>
#include <new>
#include <stdexcept>

namespace tutu::rig::import_detail {
namespace {

constexpr const char* k_name = "KHR_draco_mesh_compression";

InputError damage(const GltfValue& extension, const std::string& found) {
  return extension.error(std::string(k_name) + ": " + found, "a stream that is not damaged");
}

/// What the head of a stream claims to hold. libdraco 1.5 allocates by these numbers before it reads any further.
struct Claim {
  std::uint64_t faces = 0, points = 0;
};

/// Reads as far as these numbers; nothing of a stream of an older kind than 2.2, or with metadata before them.
/// [Draco bitstream specification 2.2: draco_header, sequential and edgebreaker connectivity]
Claim claim_of(std::string_view stream) {
  constexpr std::size_t k_head = 11;
  constexpr unsigned k_metadata = 0x8000;
  const auto byte = [&](std::size_t at) {
    return at < stream.size() ? static_cast<unsigned>(static_cast<unsigned char>(stream[at])) : 0u;
  };
  const bool is_known = stream.size() > k_head && byte(5) * 256 + byte(6) >= 0x0202 && byte(7) == 1 &&
                        ((byte(9) | byte(10) << 8) & k_metadata) == 0;
  if (!is_known) return {};
  std::size_t at = k_head;
  const auto number = [&] { // 7 bits a byte, the lowest first
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const unsigned part = byte(at++);
      value |= std::uint64_t{part & 0x7f} << shift;
      if ((part & 0x80) == 0) break;
    }
    return value;
  };
  Claim claim;
  if (byte(8) == 0) { // sequential
    claim.faces = number();
    claim.points = number();
  } else { // edgebreaker: how it is traversed, then vertices and faces
    ++at;
    claim.points = number();
    claim.faces = number();
  }
  return claim;
}

void check_claim(const GltfValue& extension, std::string_view stream, GltfMemory& memory) {
  // The entropy coder can repeat itself below a bit a face; a hundred a byte is beyond any mesh.
  constexpr std::uint64_t k_least = 65'536, k_most_a_byte = 128;
  constexpr std::uint64_t k_bytes_each = 64; // of libdraco's tables, about
  const Claim claim = claim_of(stream);
  if (std::max(claim.faces, claim.points) > k_least + k_most_a_byte * stream.size())
    throw damage(extension, "a stream of " + with_commas(stream.size()) + " bytes that claims " +
                                with_commas(claim.faces) + " faces and " + with_commas(claim.points) + " vertices");
  memory.take((claim.faces + claim.points) * k_bytes_each, extension.pointer());
}

bool is_unsigned(GltfComponent component) {
  return component == GltfComponent::uint8 || component == GltfComponent::uint16 || component == GltfComponent::uint32;
}

float largest_of(GltfComponent component) {
  switch (component) {
  case GltfComponent::int8: return 127.0f;
  case GltfComponent::uint8: return 255.0f;
  case GltfComponent::int16: return 32767.0f;
  default: return 65535.0f;
  }
}

/// The attribute's values vertex by vertex. `place` is what a damaged one is told of.
template <typename To>
void convert(const draco::PointAttribute& attribute, const GltfValue& place, std::uint32_t points, To* to) {
  for (draco::PointIndex p(0); p < points; ++p, to += attribute.num_components()) {
    const draco::AttributeValueIndex value = attribute.mapped_index(p);
    if (value.value() >= attribute.size() ||
        !attribute.ConvertValue(value, static_cast<std::int8_t>(attribute.num_components()), to))
      throw damage(place, "an attribute without a value for vertex " + std::to_string(p.value()));
  }
}

std::unique_ptr<draco::Mesh> decode(const GltfValue& extension, std::string_view stream, GltfMemory& memory) {
  check_claim(extension, stream, memory);
  draco::DecoderBuffer buffer;
  buffer.Init(stream.data(), stream.size());
  draco::Decoder decoder;
  try {
    draco::StatusOr<std::unique_ptr<draco::Mesh>> mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (mesh.ok() && mesh.value()) return std::move(mesh).value();
  } catch (const std::bad_alloc&) {
    throw damage(extension, "a stream that claims more than there is memory for");
  } catch (const std::length_error&) {
    throw damage(extension, "a stream that claims more than there is memory for");
  }
  throw damage(extension, "a stream that cannot be decoded");
}

} // namespace

DracoGeometry::DracoGeometry(const GltfValue& extension, GltfAccessors& accessors)
    : extension_(extension), accessors_(accessors),
      mesh_(decode(extension, accessors.bytes(extension.at("bufferView")), accessors.memory())) {
  accessors_.memory().take(mesh_->num_faces() * sizeof(Triangle), extension.pointer());
  for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f)
    for (const draco::PointIndex& point : mesh_->face(f))
      if (point.value() >= mesh_->num_points())
        throw damage(extension, "a face of vertex " + std::to_string(point.value()) + " of " +
                                    std::to_string(mesh_->num_points()));
}

DracoGeometry::~DracoGeometry() = default;

std::vector<Triangle> DracoGeometry::triangles() const {
  std::vector<Triangle> all;
  all.reserve(mesh_->num_faces());
  for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh_->face(f);
    all.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return all;
}

GltfElements DracoGeometry::elements(std::string_view name, const GltfValue& reference, std::string_view type) {
  const GltfValue id = extension_.at("attributes").at(name);
  const GltfElements meant = accessors_.elements(reference, type);
  const draco::PointAttribute* attribute =
      id.whole() <= 0xffffffffu ? mesh_->GetAttributeByUniqueId(static_cast<std::uint32_t>(id.whole())) : nullptr;
  if (!attribute) throw id.error(std::string(k_name) + ": no attribute " + std::to_string(id.whole()), "one it holds");
  if (attribute->num_components() != meant.width)
    throw id.error(std::string(k_name) + ": " + std::to_string(attribute->num_components()) + " components",
                   std::to_string(meant.width));

  GltfElements elements;
  elements.place = id.pointer();
  elements.count = mesh_->num_points();
  elements.width = meant.width;
  elements.stride = static_cast<std::size_t>(meant.width) * 4;
  accessors_.memory().take(elements.count * elements.stride, id.pointer());
  if (is_unsigned(meant.component) && !meant.normalized) {
    std::vector<std::uint32_t>& to = wholes_.emplace_back(elements.numbers());
    convert(*attribute, id, mesh_->num_points(), to.data());
    elements.component = GltfComponent::uint32;
    elements.first = reinterpret_cast<const char*>(to.data());
    return elements;
  }
  std::vector<float>& to = reals_.emplace_back(elements.numbers());
  if (draco::IsDataTypeIntegral(attribute->data_type())) {
    std::vector<std::int64_t> stored(elements.numbers()); // whatever the stream thinks of their normalisation
    convert(*attribute, id, mesh_->num_points(), stored.data());
    const float unit = meant.normalized ? 1.0f / largest_of(meant.component) : 1.0f;
    std::transform(stored.begin(), stored.end(), to.begin(), [&](std::int64_t value) {
      const float number = static_cast<float>(value) * unit;
      return meant.normalized ? std::max(number, -1.0f) : number;
    });
  } else {
    convert(*attribute, id, mesh_->num_points(), to.data());
  }
  elements.first = reinterpret_cast<const char*>(to.data());
  return elements;
}

} // namespace tutu::rig::import_detail
