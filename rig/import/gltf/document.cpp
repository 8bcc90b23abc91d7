#include "rig/import/gltf/document.h"

#include "rig/io/file_io.h"
#include "rig/text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace tutu::rig::import_detail {
namespace {

constexpr std::string_view k_magic = "glTF";
constexpr std::size_t k_header = 12, k_chunk_header = 8;            // bytes [glTF 2.0, 4.4]
constexpr std::uint32_t k_json = 0x4e4f534a, k_binary = 0x004e4942; // kinds of chunk

/// Extensions that may be required: those read, and those that move no vertex. A name that ends in * stands for all
/// that begin so.
constexpr std::array<std::string_view, 17> k_fine = {"KHR_mesh_quantization",
                                                     "EXT_meshopt_compression",
                                                     "KHR_meshopt_compression",
                                                     "KHR_draco_mesh_compression",
                                                     "KHR_materials_*",
                                                     "EXT_materials_*",
                                                     "KHR_texture_*",
                                                     "EXT_texture_*",
                                                     "MSFT_texture_dds",
                                                     "KHR_lights_punctual",
                                                     "EXT_lights_*",
                                                     "KHR_technique*",
                                                     "KHR_xmp*",
                                                     "VRM",
                                                     "VRMC_*",
                                                     "FB_ngon_encoding",
                                                     "KHR_node_*"};

bool is_fine(std::string_view extension) {
  return std::any_of(k_fine.begin(), k_fine.end(), [&](std::string_view fine) {
    return fine.ends_with('*') ? extension.starts_with(fine.substr(0, fine.size() - 1)) : extension == fine;
  });
}

/// Little-endian; `at` + 4 is within the bytes.
std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k) value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(k)]);
  return value;
}

/// "2.0" -> {2, 0}.
std::optional<std::array<int, 2>> version_of(std::string_view text) {
  const auto digit = [&](std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; };
  if (text.size() != 3 || !digit(0) || text[1] != '.' || !digit(2)) return std::nullopt;
  return std::array{text[0] - '0', text[2] - '0'};
}

} // namespace

GltfDocument::GltfDocument(const std::filesystem::path& path)
    : path_(path), file_(path.string()), bytes_(read_file(path)), format_("glTF 2.0") {
  tree_ = parse_gltf(open_container(), file_);
  check_version();
  check_extensions();
  if (root().extension("VRMC_vrm")) {
    format_ = "VRM 1.0";
  } else if (root().extension("VRM")) {
    format_ = "VRM 0.x";
    faces_back_ = true;
  }
}

std::string_view GltfDocument::open_container() {
  std::string_view rest = bytes_;
  if (!rest.starts_with(k_magic)) return rest;
  format_ = "glTF 2.0 binary";
  if (rest.size() < k_header + k_chunk_header)
    throw InputError(file_, "", "a binary glTF of " + std::to_string(rest.size()) + " bytes", "a header and a chunk");
  if (const std::uint32_t version = word(rest, 4); version != 2)
    throw InputError(file_, "", "version " + std::to_string(version) + " of binary glTF", "version 2");
  if (const std::size_t length = word(rest, 8); length > rest.size())
    throw InputError(file_, "", "a file cut off after " + std::to_string(rest.size()) + " bytes",
                     std::to_string(length) + " bytes");
  else if (length < k_header + k_chunk_header)
    throw InputError(file_, "", "a length of " + std::to_string(length), "a header and a chunk");
  else rest = rest.substr(k_header, length - k_header);

  std::string_view text;
  for (int chunk = 0; rest.size() >= k_chunk_header; ++chunk) {
    const std::size_t length = word(rest, 0);
    const std::uint32_t kind = word(rest, 4);
    rest.remove_prefix(k_chunk_header);
    if (length > rest.size())
      throw InputError(file_, "chunk " + std::to_string(chunk),
                       std::to_string(length) + " bytes where " + std::to_string(rest.size()) + " are left",
                       "a chunk within the file");
    const std::string_view content = rest.substr(0, length);
    if (chunk == 0) {
      if (kind != k_json) throw InputError(file_, "chunk 0", "something else than JSON", "JSON");
      text = content.substr(0, content.find_last_not_of('\0') + 1); // some pad with zeros
    } else if (kind == k_binary && !binary_) {
      binary_ = content;
    }
    rest.remove_prefix(length);
  }
  return text;
}

void GltfDocument::check_version() const {
  const GltfValue asset = root().at("asset");
  const GltfValue version = asset.at("version");
  const auto number = version_of(version.text());
  if (!number || (*number)[0] != 2) throw version.error("glTF 2.0");
  const std::optional<GltfValue> least = asset.find("minVersion");
  if (!least) return;
  const auto least_number = version_of(least->text());
  if (!least_number || (*least_number)[0] > 2 || ((*least_number)[0] == 2 && (*least_number)[1] > 0))
    throw least->error("a file that a reader of glTF 2.0 can read");
}

void GltfDocument::check_extensions() const {
  for (const GltfValue& extension : root().items("extensionsRequired"))
    if (!is_fine(extension.text()))
      throw extension.error("a file that requires the extension " + plain_text(extension.text().substr(0, 60)) +
                                ", which is not read",
                            "");
}

std::size_t GltfDocument::count(std::string_view list) const {
  const std::optional<GltfValue> all = root().find(list);
  return all ? all->size() : 0;
}

std::size_t GltfDocument::target_index(const GltfValue& reference, std::string_view list) const {
  const std::size_t index = reference.whole(), size = count(list);
  if (index >= size)
    throw reference.error(std::to_string(index),
                          "an index below " + std::to_string(size) + ": one of " + std::string(list));
  return index;
}

GltfValue GltfDocument::target(const GltfValue& reference, std::string_view list) const {
  const std::size_t index = target_index(reference, list);
  return root().at(list).item(index);
}

} // namespace tutu::rig::import_detail
