// Where tests find what they read, and where they may write.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace tutu::test {

/// A file of the checkout: `source_file("assets/poses/dance.json")`.
inline std::filesystem::path source_file(const std::string& relative) {
  return std::filesystem::path(TUTU_SOURCE_DIR) / relative;
}

/// Debian's assimp-testmodels; a dependency that bootstrap installs.
inline std::filesystem::path assimp_model(const std::string& relative) {
  return std::filesystem::path("/usr/share/assimp/models") / relative;
}

/// Characters that lie beside the project on some machines. Skip with a reason where absent:
///   if (!exists(human("human-female.dae"))) GTEST_SKIP() << "no human test characters beside the checkout";
inline std::filesystem::path human(const std::string& name) {
  return std::filesystem::path(TUTU_SOURCE_DIR).parent_path() / "shared" / "characters" / name;
}

/// A fresh empty folder of the running test's own.
inline std::filesystem::path scratch_folder() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::temp_directory_path() / ("tutu-" + std::string(info->test_suite_name()) + "." +
                                                                info->name() + "." + std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

} // namespace tutu::test
