// Which file is read by which reader.
#include "rig/error.h"
#include "rig/import/assimp/assimp.h"
#include "rig/import/detail/parts.h"
#include "rig/import/gltf/gltf.h"

#include <algorithm>
#include <cctype>

namespace tutu::rig::import_detail {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t k_largest_file = std::uintmax_t{1} << 30; // bytes

struct Format {
  const char* extension;
  bool has_characters, has_surfaces;
  FileScene (*read)(const fs::path& file);
};
constexpr Format k_formats[] = {
    {".dae", true, false, read_collada}, {".gltf", true, true, read_gltf}, {".glb", true, true, read_gltf},
    {".vrm", true, false, read_gltf},    {".fbx", true, false, read_fbx},  {".x", true, false, read_directx},
    {".obj", false, true, read_obj},     {".ply", false, true, read_ply},  {".stl", false, true, read_stl}};

const char* expected_for(Purpose purpose) {
  return purpose == Purpose::surface ? "a surface: .obj, .ply, .stl, .gltf or .glb"
                                     : "a rigged character: .dae, .gltf, .glb, .vrm, .fbx or .x";
}

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// Null when a file of this name is none for the purpose.
const Format* format_of(const fs::path& file, Purpose purpose) {
  const std::string extension = lower_extension(file);
  for (const Format& format : k_formats)
    if (extension == format.extension && (purpose == Purpose::surface ? format.has_surfaces : format.has_characters))
      return &format;
  return nullptr;
}

} // namespace

std::uintmax_t check_acceptable(const fs::path& file, Purpose purpose) {
  const char* expected = expected_for(purpose);
  std::error_code error;
  if (!fs::exists(file, error)) throw InputError(file.string(), "", "no such file", expected);
  if (!fs::is_regular_file(file, error)) throw InputError(file.string(), "", "something that is not a file", expected);
  if (!format_of(file, purpose)) {
    const std::string extension = lower_extension(file);
    throw InputError(file.string(), "", extension.empty() ? "a name without extension" : "a " + extension + " file",
                     expected);
  }
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size == 0) throw InputError(file.string(), "", "an empty file", expected);
  if (size > k_largest_file) throw InputError(file.string(), "", std::to_string(size) + " bytes", "at most 1 GiB");
  return size;
}

FileScene read_scene_of(const fs::path& file, Purpose purpose) { return format_of(file, purpose)->read(file); }

} // namespace tutu::rig::import_detail
