// Private to the readers of clips: rotations as people's tools write them, made unit, with one note a file.
#pragma once

#include "rig/math.h"

#include <optional>
#include <string>

namespace tutu::rig {

class UnitRotations {
public:
  /// What may be given in words: of a message's "expected".
  static constexpr const char* k_expected =
      "a unit quaternion x y z w (up to 10 % off is normalised: is the order right, is it a rotation?)";

  /// The rotation made unit. One that is unit to the last digits keeps its bits; one that is rounded to three digits or
  /// more is nothing to tell of. None where the length is more than 10 % off, or no number.
  std::optional<Quat> normalised(const Quat& rotation);

  /// "1 of 603 rotations was not of unit length (0.98): normalised", where one was.
  std::optional<std::string> note() const;

private:
  int count_ = 0, off_ = 0;
  double farthest_ = 1.0; ///< the length that is farthest from 1
};

} // namespace tutu::rig
