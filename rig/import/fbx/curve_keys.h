// Private to the importer: the keys of an FBX AnimationCurve.
#pragma once

#include "rig/import/curves/scalar_curve.h"
#include "rig/import/fbx/tree.h"

#include <cstdint>

namespace tutu::rig::import_detail {

/// Times in s (of ticks, of which a second has so many), values as they are (angles in degrees). Without keys where the
/// file has none. Throws FbxUnreadable on arrays that are missing or do not fit each other, on times that fall, on
/// numbers that are none.
ScalarCurve curve_keys(const FbxElement& curve, const FbxTree& tree, double ticks_per_second);

/// Does it go on beyond its keys other than with the value of the last?
bool is_extrapolated(const FbxElement& curve);

} // namespace tutu::rig::import_detail
