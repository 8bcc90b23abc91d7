// What flags and data of a key mean is not published but in the SDK's headers (fbxanimcurve.h) and in what readers have
// found by trial; that slopes are in 1/s and weights in ten thousandths, and the formula for slopes that the file
// leaves to its reader, is the finding of ufbx (ufbxi_read_animation_curve, ufbxi_solve_auto_tangent).
#include "rig/import/fbx/curve_keys.h"

#include "rig/math.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace tutu::rig::import_detail {
namespace {

using Law = ScalarKey::Law;

enum Flag : std::uint32_t {
  constant = 0x2,
  cubic = 0x8,           // with neither of them: linear
  constant_next = 0x100, // of a constant key: the next one's value
  tcb = 0x200,
  user = 0x400,   // else, unless tcb: the slope follows from the neighbours
  clamp = 0x1000, // level where a neighbour has the same value, whatever else is said
  time_independent = 0x2000,
  clamp_progressive = 0x4000,
  weighted_leaving = 0x1000000,
  weighted_arriving = 0x2000000 // of the next key
};

/// Of one key: its flags, and four words of data.
struct Attributes {
  std::uint32_t flags = 0;
  std::array<std::uint32_t, 4> data{};

  bool has(std::uint32_t flag) const { return (flags & flag) != 0; }
  bool is_cubic() const { return has(cubic) && !has(constant); }
  double real(std::size_t word) const { return static_cast<double>(std::bit_cast<float>(data[word])); }
  /// The share of the way to the next key at which a handle ends.
  double weight(bool of_leaving) const {
    if (!has(of_leaving ? weighted_leaving : weighted_arriving)) return 1.0 / 3.0;
    return 1e-4 * static_cast<double>(of_leaving ? data[2] & 0xffff : data[2] >> 16);
  }
};

struct Slopes {
  double arriving = 0.0, leaving = 0.0; ///< 1/s
};

const FbxElement& required(const FbxElement& curve, std::string_view name) {
  const FbxElement* found = curve.child(name);
  if (!found) throw FbxUnreadable("a curve without " + std::string(name));
  return *found;
}

/// One each key: a run of keys shares what is kept once.
std::vector<Attributes> attributes(const FbxElement& curve, const FbxTree& tree, std::size_t keys) {
  const std::vector<std::int64_t> flags = integers_of(required(curve, "KeyAttrFlags")),
                                  runs = integers_of(required(curve, "KeyAttrRefCount"));
  const std::vector<std::uint32_t> data = words_of(required(curve, "KeyAttrDataFloat"), tree);
  if (flags.size() != runs.size() || data.size() != 4 * runs.size())
    throw FbxUnreadable("a curve whose flags and data do not fit each other");
  std::vector<Attributes> result;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (runs[r] < 0 || static_cast<std::uint64_t>(runs[r]) > keys - result.size())
      throw FbxUnreadable("a curve with flags for more keys than there are");
    Attributes own;
    own.flags = static_cast<std::uint32_t>(flags[r]);
    for (std::size_t i = 0; i < 4; ++i) own.data[i] = data[4 * r + i];
    result.insert(result.end(), static_cast<std::size_t>(runs[r]), own);
  }
  if (result.size() != keys) throw FbxUnreadable("a curve with flags for fewer keys than there are");
  return result;
}

/// The slope between two chords that neighbours and `bias` (percent towards one of them) give, kept from overshooting
/// where the key says so.
double automatic_slope(const ScalarKey& before, const ScalarKey& key, const ScalarKey& next, const Attributes& own,
                       double weight_before, double bias) {
  const double left = (key.value - before.value) / (key.time - before.time);
  const double right = (next.value - key.value) / (next.time - key.time);
  double slope = (next.value - before.value) / (next.time - before.time);
  if (!own.has(time_independent)) {
    const double share = (key.time - before.time) / (next.time - before.time);
    slope = 0.5 * (slope + (1.0 - share) * left + share * right);
    const double pull = std::min(std::abs(bias) / 100.0, 1.0);
    slope += pull * ((bias > 0.0 ? right : left) - slope);
  }
  if (!own.has(clamp_progressive)) return slope;
  const double side = slope < 0.0 ? -1.0 : 1.0;
  const auto most = [&](double chord, double weight) {
    return weight > 0.0 ? std::max(side * chord / weight, 0.0) : 0.0;
  };
  return side * std::min({side * slope, most(left, weight_before), most(right, own.weight(true))});
}

/// [Kochanek and Bartels 1984, eq. 8 and 9], of chords by time.
Slopes tcb_slopes(double left, double right, bool is_end, const Attributes& own) {
  const double tension = own.real(0), continuity = own.real(1), bias = own.real(2);
  const double share = (is_end ? 1.0 : 0.5) * (1.0 - tension);
  return {share * ((1.0 + bias) * (1.0 - continuity) * left + (1.0 - bias) * (1.0 + continuity) * right),
          share * ((1.0 + bias) * (1.0 + continuity) * left + (1.0 - bias) * (1.0 - continuity) * right)};
}

/// At key k, whose own law is cubic or that of the key before.
Slopes slopes_at(const ScalarCurve& keys, const std::vector<Attributes>& all, std::size_t k) {
  const ScalarKey& key = keys[k];
  const ScalarKey* before = k > 0 && keys[k - 1].time < key.time ? &keys[k - 1] : nullptr;
  const ScalarKey* next = k + 1 < keys.size() && keys[k + 1].time > key.time ? &keys[k + 1] : nullptr;
  const Attributes& own = all[k];
  const double left = before ? (key.value - before->value) / (key.time - before->time) : 0.0;
  const double right = next ? (next->value - key.value) / (next->time - key.time) : 0.0;
  // What the key before keeps for this one is a slope only where that key has slopes, a bias where it has none.
  const bool has_data_before = before && all[k - 1].is_cubic() && !all[k - 1].has(tcb);
  const bool user_before = has_data_before && all[k - 1].has(user);
  const double kept_before = has_data_before ? all[k - 1].real(1) : 0.0;

  if (!own.is_cubic()) return {user_before ? kept_before : left, right};
  if (own.has(clamp) && ((before && before->value == key.value) || (next && next->value == key.value))) return {};
  if (own.has(tcb)) return tcb_slopes(left, right, !before || !next, own);
  if (own.has(user)) return {user_before ? kept_before : own.real(0), own.real(0)};
  if (!before || !next) {
    const double slope = own.has(clamp_progressive) ? 0.0 : before ? left : right;
    return {slope, slope};
  }
  const double bias_before = user_before ? 0.0 : -kept_before, weight = all[k - 1].weight(false);
  return {automatic_slope(*before, key, *next, own, weight, bias_before),
          automatic_slope(*before, key, *next, own, weight, own.real(0))};
}

} // namespace

ScalarCurve curve_keys(const FbxElement& curve, const FbxTree& tree, double ticks_per_second) {
  const std::vector<std::int64_t> times = integers_of(required(curve, "KeyTime"));
  const std::vector<double> values = reals_of(required(curve, "KeyValueFloat"));
  if (times.size() != values.size()) throw FbxUnreadable("a curve with another number of times than of values");
  const std::vector<Attributes> all = attributes(curve, tree, times.size());
  ScalarCurve keys(times.size());
  for (std::size_t k = 0; k < keys.size(); ++k) {
    keys[k].time = static_cast<double>(times[k]) / ticks_per_second;
    keys[k].value = values[k];
    if (!(std::abs(values[k]) <= k_largest_number)) throw FbxUnreadable("a curve with a key that is no number");
    if (k > 0 && times[k] < times[k - 1]) throw FbxUnreadable("a curve with key times that fall");
    if (all[k].has(constant)) keys[k].law = all[k].has(constant_next) ? Law::step_next : Law::step;
    else keys[k].law = all[k].is_cubic() ? Law::bezier : Law::linear;
  }
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    const double h = keys[k + 1].time - keys[k].time;
    if (keys[k].law != Law::bezier || !(h > 0.0)) continue;
    const double leaving = h * all[k].weight(true), arriving = h * all[k].weight(false);
    keys[k].leaving = {keys[k].time + leaving, keys[k].value + leaving * slopes_at(keys, all, k).leaving};
    keys[k].arriving = {keys[k + 1].time - arriving,
                        keys[k + 1].value - arriving * slopes_at(keys, all, k + 1).arriving};
    if (!(std::abs(keys[k].leaving.value) <= k_largest_number && std::abs(keys[k].arriving.value) <= k_largest_number))
      throw FbxUnreadable("a curve with a slope that is no number");
  }
  keep_handles_inside(keys);
  return keys;
}

bool is_extrapolated(const FbxElement& curve) {
  for (const char* name : {"Pre-Extrapolation", "Post-Extrapolation"})
    if (const FbxElement* extrapolation = curve.child(name))
      if (const FbxElement* type = extrapolation->child("Type"); type && !type->values.empty()) {
        const FbxValue& value = type->values[0];
        const bool is_constant = value.kind == FbxValue::Kind::text ? value.text == "C" : value.integer == 'C';
        if (!is_constant) return true;
      }
  return false;
}

} // namespace tutu::rig::import_detail
