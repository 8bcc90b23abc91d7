// What the reader of glTF says of a file, for tests of what it refuses.
#pragma once

#include "rig/error.h"
#include "rig/import/gltf/gltf.h"
#include "tests/rig/import/gltf/gltf_body.h"

#include <optional>
#include <string>
#include <string_view>
#include <unistd.h>

#include <gtest/gtest.h>

namespace tutu::test {

/// The message, or "" when the file was read. Anything thrown but InputError fails the test.
inline std::string message_of(const std::filesystem::path& file) {
  try {
    rig::import_detail::read_gltf(file);
    return "";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(file.string())) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), file.string().size() + 500) << message;
    return message;
  }
}
inline std::string message_of_bytes(std::string_view bytes, const char* name = "bad.glb") {
  static const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("tutu-gltf-hostile." + std::to_string(::getpid()));
  return message_of(GltfMaker::write(folder / name, std::string(bytes)));
}
inline std::string message_of(const GltfMaker& maker) { return message_of_bytes(maker.glb()); }

inline GltfBody compressed_body(bool meshopt, std::optional<int> draco) {
  GltfBody body({.draco = draco});
  body.maker.meshopt = meshopt;
  return body;
}

} // namespace tutu::test
