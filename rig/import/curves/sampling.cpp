#include "rig/import/curves/sampling.h"

#include "rig/import/detail/parts.h"
#include "rig/interpolation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace tutu::rig::import_detail {
namespace {

using Vec4 = Eigen::Vector4d;

constexpr int k_most_halvings = 16;
constexpr double k_share_of_rest = 1e-3; ///< of the tolerance: what moves less is at rest

double distance(const Vec3& a, const Vec3& b) { return (a - b).norm(); }
double distance(const Vec4& a, const Vec4& b) { return Quat(a).angularDistance(Quat(b)); }
Vec3 between(const Vec3& a, const Vec3& b, double s) { return a + s * (b - a); }
Vec4 between(const Vec4& a, const Vec4& b, double s) { return Quat(a).slerp(s, Quat(b)).coeffs(); }

/// Of the two signs of a rotation that which is nearer to another.
const Vec3& aligned(const Vec3&, const Vec3& value) { return value; }
Vec4 aligned(const Vec4& to, const Vec4& value) { return to.dot(value) < 0.0 ? Vec4(-value) : value; }

/// As a curve has it: slopes over the whole way, s in [0, 1].
Vec3 cubic_between(const Vec3& a, const Vec3& b, const Vec3& leaving, const Vec3& arriving, double s) {
  return hermite(a, b, leaving, arriving, 1.0, s);
}
Vec4 cubic_between(const Vec4& a, const Vec4& b, const Vec4& leaving, const Vec4& arriving, double s) {
  return hermite(a, b, leaving, arriving, 1.0, s).normalized();
}

/// May a curve have it? (Between keys that are next to one time it may not.)
template <typename Value> bool is_slope(const Value& slope) { return (slope.array().abs() <= k_largest_number).all(); }

/// Puts pieces of a curve one behind the other: a key where each starts, two where one does not start where the last
/// has ended.
template <typename Value> class Pieces {
public:
  explicit Pieces(double rest) : rest_(rest) {}

  /// A value with the sign in which the curve goes on.
  Value aligned(const Value& value) const {
    if (reached_) return import_detail::aligned(*reached_, value);
    return curve_.empty() ? value : import_detail::aligned(curve_.values.back(), value);
  }

  void start(double time, const Value& value, Law law, const Value& leaving = Value::Zero()) {
    if (reached_ && distance(*reached_, value) > rest_) {
      add(time, *reached_, Law::step, Value::Zero());
    } else if (!reached_ && law == Law::step && !curve_.empty() && distance(curve_.values.back(), value) <= rest_) {
      return; // still held
    }
    add(time, value, law, leaving);
    reached_.reset();
  }
  /// Where a piece that is not held ends.
  void reach(const Value& value, const Value& arriving = Value::Zero()) {
    reached_ = value;
    arriving_ = arriving;
  }
  Curve<Value> finished(double time, const Value& value) {
    start(time, value, Law::step);
    if (std::ranges::find(curve_.laws, Law::cubic) == curve_.laws.end()) {
      curve_.leaving.clear();
      curve_.arriving.clear();
    }
    return std::move(curve_);
  }

private:
  void add(double time, const Value& value, Law law, const Value& leaving) {
    if (curve_.times.size() >= k_most_pieces) throw std::length_error("a curve of too many pieces");
    curve_.times.push_back(time);
    curve_.values.push_back(value);
    curve_.laws.push_back(law);
    curve_.leaving.push_back(leaving);
    curve_.arriving.push_back(arriving_);
    arriving_ = Value::Zero();
  }

  double rest_;
  Curve<Value> curve_;
  std::optional<Value> reached_; ///< the end of the last piece, unless it is held
  Value arriving_ = Value::Zero();
};

template <typename Value> class Sampler {
public:
  using At = std::function<Value(double time, Side side)>;
  Sampler(const At& at, double tolerance) : at_(at), tolerance_(tolerance), pieces_(rest()) {}

  double rest() const { return k_share_of_rest * tolerance_; }
  Pieces<Value>& pieces() { return pieces_; }

  void interval(double from, double to, int cuts) {
    const double count = static_cast<double>(std::max(cuts, 1));
    Value start = pieces_.aligned(at_(from, Side::behind));
    double time = from;
    for (int cut = 1; cut <= std::max(cuts, 1); ++cut) {
      const double next = cut >= cuts ? to : from + (to - from) * (static_cast<double>(cut) / count);
      start = piece(time, start, next, at_(next, Side::before), 0);
      time = next;
    }
  }

private:
  /// Returns the end as it was kept: of a rotation with one of its two signs.
  Value piece(double from, const Value& start, double to, const Value& raw_end, int halvings) {
    if (++tried_ > 4 * k_most_pieces) throw std::length_error("a curve of too many pieces");
    const double h = to - from, middle = 0.5 * (from + to);
    Value sixths[7] = {start, start, start, start, start, start, start};
    for (int i = 1; i < 6; ++i) sixths[i] = aligned(sixths[i - 1], at_(from + h * (i / 6.0), Side::behind));
    const Value& end = sixths[6] = aligned(sixths[5], raw_end);

    // The cubic through the ends and the thirds, by its slopes over the whole piece.
    const Value leaving = 0.5 * (-11.0 * start + 18.0 * sixths[2] - 9.0 * sixths[4] + 2.0 * end);
    const Value arriving = 0.5 * (11.0 * end - 18.0 * sixths[4] + 9.0 * sixths[2] - 2.0 * start);
    double moved = 0.0, bent = 0.0, off = 0.0;
    for (int i = 1; i <= 6; ++i) {
      const double s = i / 6.0;
      moved = std::max(moved, distance(start, sixths[i]));
      bent = std::max(bent, distance(between(start, end, s), sixths[i]));
      off = std::max(off, distance(cubic_between(start, end, leaving, arriving, s), sixths[i]));
    }
    if (moved <= rest()) {
      pieces_.start(from, start, Law::step);
      return end;
    }
    const bool is_as_short_as_can_be = halvings == k_most_halvings || !(middle > from && middle < to);
    if (bent <= tolerance_ || is_as_short_as_can_be) {
      pieces_.start(from, start, Law::linear);
      pieces_.reach(end);
      return end;
    }
    if (off <= tolerance_ && is_slope(leaving / h) && is_slope(arriving / h)) {
      pieces_.start(from, start, Law::cubic, leaving / h);
      pieces_.reach(end, arriving / h);
      return end;
    }
    const Value half = piece(from, start, middle, sixths[3], halvings + 1);
    return piece(middle, half, to, raw_end, halvings + 1);
  }

  const At& at_;
  double tolerance_;
  std::size_t tried_ = 0; ///< pieces, kept or not
  Pieces<Value> pieces_;
};

template <typename Value>
Curve<Value> sampled_values(const std::vector<double>& times, const std::vector<int>& first_cuts,
                            const std::function<Value(double, Side)>& at, double tolerance) {
  if (std::accumulate(first_cuts.begin(), first_cuts.end(), std::size_t{0}) >= k_most_pieces)
    throw std::length_error("a curve of too many pieces");
  Sampler<Value> sampler(at, tolerance);
  sampler.pieces().reach(at(times.front(), Side::before)); // what holds before the first key
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    sampler.interval(times[i], times[i + 1], first_cuts.empty() ? 1 : first_cuts[i]);
  return sampler.pieces().finished(times.back(), sampler.pieces().aligned(at(times.back(), Side::behind)));
}

} // namespace

std::vector<double> merged_times(const std::vector<const ScalarCurve*>& curves) {
  std::vector<double> times;
  for (const ScalarCurve* curve : curves)
    for (const ScalarKey& key : *curve) times.push_back(key.time);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

Pose pose_of(const Eigen::Affine3d& map, bool& has_shear) {
  const auto [rotation, stretch] = polar(map.linear());
  const Vec3 scale = stretch.diagonal();
  constexpr double k_shear = 1e-4; // what six digits of a matrix leave in doubt is less
  if ((stretch - Eigen::Matrix3d(scale.asDiagonal())).cwiseAbs().maxCoeff() > k_shear * stretch.cwiseAbs().maxCoeff())
    has_shear = true;
  return {map.translation(), rotation, scale};
}

VectorCurve joined(const std::array<const ScalarCurve*, 3>& curves, const Vec3& constant, const Eigen::Affine3d& map,
                   double tolerance) {
  std::vector<const ScalarCurve*> moving;
  std::ranges::copy_if(curves, std::back_inserter(moving), [](const ScalarCurve* curve) { return curve != nullptr; });
  const std::vector<double> times = merged_times(moving);
  const std::function<Vec3(double, Side)> at = [&](double time, Side side) -> Vec3 {
    Vec3 numbers = constant;
    for (int i = 0; i < 3; ++i)
      if (curves[i]) numbers[i] = value_at(*curves[i], time, side);
    return map * numbers;
  };
  const auto slope = [&](double time, Side side) -> Vec3 {
    Vec3 numbers = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      if (curves[i]) numbers[i] = slope_at(*curves[i], time, side);
    return map.linear() * numbers;
  };

  Sampler<Vec3> sampler(at, tolerance);
  Pieces<Vec3>& pieces = sampler.pieces();
  pieces.reach(at(times.front(), Side::before));
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double from = times[i], to = times[i + 1], middle = 0.5 * (from + to);
    bool is_curved = false, is_held = true, is_exact = true;
    for (const ScalarCurve* curve : moving) {
      const ScalarKey::Law law = law_at(*curve, middle);
      is_curved |= law == ScalarKey::Law::bezier;
      is_held &= law == ScalarKey::Law::step || law == ScalarKey::Law::step_next;
      is_exact &= is_polynomial(*curve, middle);
    }
    const Vec3 leaving = is_curved && is_exact ? slope(from, Side::behind) : Vec3::Zero();
    const Vec3 arriving = is_curved && is_exact ? slope(to, Side::before) : Vec3::Zero();
    if (!is_exact || !is_slope(leaving) || !is_slope(arriving)) {
      sampler.interval(from, to, 1);
    } else if (is_held) {
      pieces.start(from, at(from, Side::behind), Law::step);
    } else {
      pieces.start(from, at(from, Side::behind), is_curved ? Law::cubic : Law::linear, leaving);
      pieces.reach(at(to, Side::before), arriving);
    }
  }
  return pieces.finished(times.back(), at(times.back(), Side::behind));
}

VectorCurve sampled(const std::vector<double>& times, const std::vector<int>& first_cuts,
                    const std::function<Vec3(double, Side)>& at, double tolerance) {
  return sampled_values<Vec3>(times, first_cuts, at, tolerance);
}

RotationCurve sampled(const std::vector<double>& times, const std::vector<int>& first_cuts,
                      const std::function<Quat(double, Side)>& at, double tolerance) {
  const std::function<Vec4(double, Side)> coefficients = [&](double time, Side side) -> Vec4 {
    return at(time, side).coeffs();
  };
  return sampled_values<Vec4>(times, first_cuts, coefficients, tolerance);
}

double tolerance_for(const std::vector<double>& times, const std::function<Vec3(double, Side)>& at, const Vec3& rest) {
  double largest = rest.norm();
  for (const double time : times) largest = std::max(largest, at(time, Side::behind).norm());
  return k_sampled_share * std::max(largest, 1e-12);
}

int cuts_for(double turn) {
  constexpr double k_eighth = 0.785398; // of a turn, rad
  return static_cast<int>(std::clamp(std::ceil(turn / k_eighth), 1.0, static_cast<double>(k_most_pieces)));
}

void drop_if_idle(VectorCurve& curve, const Vec3& rest, double tolerance) {
  if (curve.values.size() == 1 && distance(curve.values[0], rest) <= k_share_of_rest * tolerance) curve = {};
}

void drop_if_idle(RotationCurve& curve, const Quat& rest) {
  if (curve.values.size() == 1 && distance(curve.values[0], Vec4(rest.coeffs())) <= k_share_of_rest * k_sampled_angle)
    curve = {};
}

PoseCurves sampled_pose(const std::vector<double>& times, const std::vector<int>& first_cuts,
                        const std::function<Pose(double, Side)>& pose, const Pose& rest) {
  const std::function<Vec3(double, Side)> translation = [&](double t, Side side) { return pose(t, side).translation; };
  const std::function<Quat(double, Side)> rotation = [&](double t, Side side) { return pose(t, side).rotation; };
  const std::function<Vec3(double, Side)> scale = [&](double t, Side side) { return pose(t, side).scale; };
  const double length = tolerance_for(times, translation, rest.translation);
  const double share = tolerance_for(times, scale, rest.scale);
  PoseCurves curves = {sampled(times, first_cuts, translation, length),
                       sampled(times, first_cuts, rotation, k_sampled_angle), sampled(times, first_cuts, scale, share)};
  drop_if_idle(curves.translation, rest.translation, length);
  drop_if_idle(curves.rotation, rest.rotation);
  drop_if_idle(curves.scale, rest.scale, share);
  return curves;
}

} // namespace tutu::rig::import_detail
