#include "rig/import/gltf/rotations.h"

#include "rig/error.h"
#include "rig/import/detail/parts.h"

#include <cmath>
#include <cstdio>

namespace tutu::rig::import_detail {
namespace {

constexpr double k_most_off = 0.1; // of a length of 1

std::string shown(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", length);
  return text;
}

} // namespace

Eigen::Vector4d GltfRotations::unit(const Eigen::Vector4d& rotation, double rounding, const std::string& place,
                                    int key) {
  const double length = rotation.norm(), off = std::abs(length - 1.0);
  const auto where = [&] { return place + (key < 0 ? "" : ", key " + std::to_string(key)); };
  if (!(off <= k_most_off))
    throw InputError(file_, where(), "a rotation of length " + shown(length), "a unit quaternion (x, y, z, w)");
  if (off > rounding) {
    if (++mended_ == 1) first_place_ = where();
    if (off > std::abs(farthest_ - 1.0)) farthest_ = length;
  }
  return rotation / length;
}

void GltfRotations::note(FileScene& scene) const {
  if (mended_ == 0) return;
  scene.notes.push_back(count_of(mended_, "rotation") + " of length other than 1 (" + (mended_ == 1 ? "" : "up to ") +
                        shown(farthest_) + "; " + (mended_ == 1 ? "" : "the first at ") + first_place_ +
                        ") normalised");
}

} // namespace tutu::rig::import_detail
