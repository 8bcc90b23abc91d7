#include "rig/import/curves/scalar_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tutu::rig::import_detail {
namespace {

using Law = ScalarKey::Law;

/// The key whose stretch holds `time`: null before the first key. At a key's own time the side decides.
const ScalarKey* key_at(const ScalarCurve& curve, double time, Side side) {
  const auto is_later = [](double t, const ScalarKey& key) { return t < key.time; };
  const auto is_earlier = [](const ScalarKey& key, double t) { return key.time < t; };
  const auto next = side == Side::behind ? std::upper_bound(curve.begin(), curve.end(), time, is_later)
                                         : std::lower_bound(curve.begin(), curve.end(), time, is_earlier);
  return next == curve.begin() ? nullptr : &*next - 1;
}

/// The cubic with Bezier ordinates a b c d.
double cubic(double a, double b, double c, double d, double s) {
  const double r = 1.0 - s;
  return r * r * (r * a + 3.0 * s * b) + s * s * (3.0 * r * c + s * d);
}

/// Where the Bezier is at `time`. With handles inside their stretch its time only rises: bisection, hurried by Newton.
double parameter_at(const ScalarKey& key, const ScalarKey& next, double time) {
  const double h = next.time - key.time;
  const double b = (key.leaving.time - key.time) / h, c = (key.arriving.time - key.time) / h;
  const double wanted = (time - key.time) / h;
  double low = 0.0, high = 1.0, s = wanted;
  for (int step = 0; step < 80 && high - low > 1e-15; ++step) {
    const double r = 1.0 - s, error = cubic(0.0, b, c, 1.0, s) - wanted;
    if (error == 0.0) break;
    (error > 0.0 ? high : low) = s;
    const double slope = 3.0 * (r * r * b + 2.0 * r * s * (c - b) + s * s * (1.0 - c));
    const double newton = s - error / slope; // by a slope of 0 it is no number or far outside
    const double better = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (better == s) break;
    s = better;
  }
  return s;
}

bool has_thirds(const ScalarKey& key, const ScalarKey& next) {
  const double h = next.time - key.time;
  // Times of files are often single precision: what that cannot tell apart is the same.
  const double same = 1e-5 * h + 4.0 * static_cast<double>(std::numeric_limits<float>::epsilon()) *
                                     std::max(std::abs(key.time), std::abs(next.time));
  return std::abs(key.leaving.time - (key.time + h / 3.0)) <= same &&
         std::abs(key.arriving.time - (next.time - h / 3.0)) <= same;
}

} // namespace

void set_slopes(ScalarKey& key, const ScalarKey& next, double leaving, double arriving) {
  const double third = (next.time - key.time) / 3.0;
  key.law = Law::bezier;
  key.leaving = {key.time + third, key.value + third * leaving};
  key.arriving = {next.time - third, next.value - third * arriving};
}

void keep_handles_inside(ScalarCurve& curve) {
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    if (curve[k].law != Law::bezier) continue;
    const double from = curve[k].time, to = curve[k + 1].time, h = to - from;
    // A handle that points the wrong way in time has no slope to keep: it ends at its key's time.
    ScalarKey::Handle &leaving = curve[k].leaving, &arriving = curve[k].arriving;
    if (leaving.time < from) leaving.time = from;
    if (leaving.time > to)
      leaving = {to, curve[k].value + (leaving.value - curve[k].value) * h / (leaving.time - from)};
    if (arriving.time > to) arriving.time = to;
    if (arriving.time < from)
      arriving = {from, curve[k + 1].value + (arriving.value - curve[k + 1].value) * h / (to - arriving.time)};
  }
}

double value_at(const ScalarCurve& curve, double time, Side side) {
  const ScalarKey* key = key_at(curve, time, side);
  if (!key) return curve.front().value;
  if (key == &curve.back() || key->law == Law::step) return key->value;
  const ScalarKey& next = key[1];
  if (key->law == Law::step_next || !(next.time > key->time)) return next.value;
  const double s = (time - key->time) / (next.time - key->time);
  if (key->law == Law::linear) return key->value + s * (next.value - key->value);
  return cubic(key->value, key->leaving.value, key->arriving.value, next.value,
               has_thirds(*key, next) ? s : parameter_at(*key, next, time));
}

double slope_at(const ScalarCurve& curve, double time, Side side) {
  const ScalarKey* key = key_at(curve, time, side);
  if (!key || key == &curve.back() || key->law == Law::step || key->law == Law::step_next) return 0.0;
  const ScalarKey& next = key[1];
  const double h = next.time - key->time;
  if (!(h > 0.0)) return 0.0;
  if (key->law == Law::linear) return (next.value - key->value) / h;
  const double s = (time - key->time) / h, r = 1.0 - s;
  return 3.0 / h *
         (r * r * (key->leaving.value - key->value) + 2.0 * r * s * (key->arriving.value - key->leaving.value) +
          s * s * (next.value - key->arriving.value));
}

Law law_at(const ScalarCurve& curve, double time) {
  const ScalarKey* key = key_at(curve, time, Side::behind);
  return !key || key == &curve.back() ? Law::step : key->law;
}

bool is_polynomial(const ScalarCurve& curve, double time) {
  const ScalarKey* key = key_at(curve, time, Side::behind);
  return !key || key == &curve.back() || key->law != Law::bezier || has_thirds(*key, key[1]);
}

double way_between(const ScalarCurve& curve, double from, double to) {
  const ScalarKey* key = key_at(curve, from, Side::behind);
  if (!key || key == &curve.back() || key->law == Law::step || key->law == Law::step_next) return 0.0;
  if (key->law == Law::linear) return std::abs(value_at(curve, to, Side::before) - value_at(curve, from, Side::behind));
  // No curve is longer than its control polygon.
  return std::abs(key->leaving.value - key->value) + std::abs(key->arriving.value - key->leaving.value) +
         std::abs(key[1].value - key->arriving.value);
}

} // namespace tutu::rig::import_detail
