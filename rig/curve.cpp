#include "rig/curve.h"

#include "rig/error.h"
#include "rig/interpolation.h"

#include <algorithm>
#include <cmath>

namespace tutu::rig {
namespace {

using Vec4 = Eigen::Vector4d;

Vec3 between(const Vec3& a, const Vec3& b, double s) { return a + s * (b - a); }
Vec4 between(const Vec4& a, const Vec4& b, double s) { return Quat(a).slerp(s, Quat(b)).coeffs(); }

template <typename Value> Value raw_value_at(const Curve<Value>& curve, double time) {
  const auto after = std::upper_bound(curve.times.begin(), curve.times.end(), time);
  // NaN compares as behind every key; it is held at the last one.
  if (after == curve.times.begin()) return curve.values.front();
  const auto k = static_cast<std::size_t>(after - curve.times.begin()) - 1;
  if (after == curve.times.end() || curve.laws[k] == Law::step) return curve.values[k];
  const double h = curve.times[k + 1] - curve.times[k], s = (time - curve.times[k]) / h;
  if (curve.laws[k] == Law::linear) return between(curve.values[k], curve.values[k + 1], s);
  return hermite(curve.values[k], curve.values[k + 1], curve.leaving[k], curve.arriving[k + 1], h, s);
}

template <typename Value>
void check_values(const Curve<Value>& curve, const std::string& file, const std::string& place) {
  const std::size_t keys = curve.times.size();
  const bool cubic = std::find(curve.laws.begin(), curve.laws.end(), Law::cubic) != curve.laws.end();
  if (curve.values.size() != keys || curve.laws.size() != keys || curve.leaving.size() != (cubic ? keys : 0) ||
      curve.arriving.size() != curve.leaving.size())
    throw InputError(file, place, "keys and values that are not as many", "one value a key");
  for (std::size_t k = 0; k < keys; ++k) {
    if (!(std::abs(curve.times[k]) <= k_largest_number))
      throw InputError(file, place, "a key time that is no number", "times within +-1e9 s");
    if (k > 0 && curve.times[k] < curve.times[k - 1])
      throw InputError(file, place, "key times that fall", "rising key times");
  }
  for (const auto* values : {&curve.values, &curve.leaving, &curve.arriving})
    for (const Value& value : *values)
      if (!(value.array().abs() <= k_largest_number).all())
        throw InputError(file, place, "a key that is no number", "finite numbers within +-1e9");
}

} // namespace

Vec3 value_at(const VectorCurve& curve, double time) { return raw_value_at(curve, time); }

Quat value_at(const RotationCurve& curve, double time) {
  const Vec4 value = raw_value_at(curve, time);
  const double length = value.norm(); // a cubic may pass through zero
  return length > 1e-12 ? Quat(Vec4(value / length)) : Quat::Identity();
}

void check(const VectorCurve& curve, const std::string& file, const std::string& place) {
  check_values(curve, file, place);
}

void check(const RotationCurve& curve, const std::string& file, const std::string& place) {
  check_values(curve, file, place);
  for (const Vec4& value : curve.values)
    if (!(std::abs(value.norm() - 1.0) <= 1e-6))
      throw InputError(file, place, "a rotation of length " + std::to_string(value.norm()), "a unit quaternion");
}

} // namespace tutu::rig
