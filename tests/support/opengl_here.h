// Whether pictures can be drawn on this machine. A driver that refuses the program's shaders is no reason to skip a
// test.
#pragma once

#include "src/view/render/gl_context.h"

#include <gtest/gtest.h>
#include <stdexcept>

namespace tutu::test {

/// "" or what is missing: `if (const auto missing = missing_opengl(); !missing.empty()) GTEST_SKIP() << missing;`
inline std::string missing_opengl() {
  try {
    const app::GlContext context;
    return "";
  } catch (const std::runtime_error& error) {
    return std::string("no OpenGL here: ") + error.what();
  }
}

} // namespace tutu::test
