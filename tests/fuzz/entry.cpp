// What libFuzzer calls. Compiled once a target, whose function is TUTU_FUZZ_TARGET. With TUTU_FUZZ_SAY in the
// environment it says why an input is refused.
#include "rig/error.h"
#include "tests/fuzz/target.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    tutu::fuzz::TUTU_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  } catch (const tutu::InputError& error) { // refused with a message: as it should be
    static const bool says = std::getenv("TUTU_FUZZ_SAY") != nullptr;
    if (says) std::fprintf(stderr, "refused: %s\n", error.what());
  }
  return 0;
}
