// Coulomb's law in double: what every solver that rubs calls.
#pragma once

#include "proxies/distance/closed_forms.h"

namespace tutu::cloth {

#include "cloth/contact/coulomb_inl.h"

/// In plain numbers.
inline Vec3 rubbed(const Vec3& moved, const Vec3& slip, const Vec3& normal, double most) {
  return rubbed<proxies::PlainArithmetic>(moved, slip, normal, most);
}

} // namespace tutu::cloth
