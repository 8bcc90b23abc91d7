// Private to the importer: the keys of a Collada <sampler>.
#pragma once

#include "rig/import/collada/collada.h"
#include "rig/import/curves/scalar_curve.h"

#include <pugixml.hpp>
#include <string>
#include <vector>

namespace tutu::rig::import_detail {

/// Keys of as many numbers as are animated together: one curve each, all with the same times.
struct SamplerKeys {
  std::vector<ScalarCurve> curves; ///< [number]; without keys where the sampler has none
  bool is_straight = true;         ///< every law is step or linear
  std::string doubt;               ///< what could not be read as it stands ("CARDINAL read as LINEAR"); else empty
};

/// Of a sampler whose every key has `numbers` numbers [COLLADA 1.4.1, Curve Interpolation]. Throws InputError with
/// `place` on keys of fewer numbers, on times that fall, on numbers that are none.
SamplerKeys read_sampler(const ColladaDocument& document, const pugi::xml_node& sampler, std::size_t numbers,
                         const std::string& place);

} // namespace tutu::rig::import_detail
