// Private to the glTF reader: how much a file makes it take. Accessors and views may share bytes, so that a small file
// can describe more than there is.
#pragma once

#include "rig/io/memory_limit.h"

#include <cstddef>
#include <string>

namespace tutu::rig::import_detail {

class GltfMemory {
public:
  explicit GltfMemory(const std::string& file) : file_(file) {}

  /// To be called before `bytes` are taken for what stands at `place`. Throws InputError where all that was ever taken
  /// is more than memory_limit.h allows.
  void take(std::size_t bytes, const std::string& place) {
    taken_ += static_cast<double>(bytes);
    check_memory(taken_, file_, place, "what buffers and accessors describe");
  }

private:
  const std::string& file_;
  double taken_ = 0.0;
};

} // namespace tutu::rig::import_detail
