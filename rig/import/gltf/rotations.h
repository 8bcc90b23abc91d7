// Private to the glTF reader: rotations, which files round.
#pragma once

#include <Eigen/Core>
#include <string>

namespace tutu::rig::import_detail {

struct FileScene;

/// Makes them unit, and remembers how far they were from it.
class GltfRotations {
public:
  explicit GltfRotations(const std::string& file) : file_(file) {}

  /// How far from 1 the length is without a word: what rounding explains.
  static constexpr double k_rounding = 1e-3;
  static constexpr double k_rounding_of_bytes = 1e-2; ///< of integers of 8 bits

  /// x y z w. `place` and, unless below 0, `key` say where. Throws InputError where the length is more than 10 % off.
  Eigen::Vector4d unit(const Eigen::Vector4d& rotation, double rounding, const std::string& place, int key = -1);
  /// One note for all that were mended.
  void note(FileScene& scene) const;

private:
  const std::string& file_;
  std::size_t mended_ = 0;
  double farthest_ = 1.0; ///< length
  std::string first_place_;
};

} // namespace tutu::rig::import_detail
