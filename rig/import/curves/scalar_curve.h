// Private to the importer: a number over time, as formats have it that animate each number by itself.
#pragma once

#include <cstdint>
#include <vector>

namespace tutu::rig::import_detail {

/// Which of two values counts where a curve jumps.
enum class Side : std::uint8_t { before, behind };

struct ScalarKey {
  enum class Law : std::uint8_t {
    step,      ///< the key's value, up to the next key
    step_next, ///< the next key's value from here on
    linear,
    bezier ///< the cubic with the control points (time, value), the two handles, (time, value) of the next key
  };
  double time = 0.0; ///< s
  double value = 0.0;
  Law law = Law::step;
  struct Handle {
    double time = 0.0, value = 0.0;
  };
  Handle leaving{}, arriving{}; ///< of the stretch up to the next key; looked at of a Bezier alone
};

/// Keys in the order of their times, of which several may be one: the last counts from there on. Before the first the
/// curve has the first one's value, behind the last the last one's. Without keys it is no curve.
using ScalarCurve = std::vector<ScalarKey>;

/// Handles a third of the way in time, which make the value a cubic polynomial of time with these derivatives (1/s).
void set_slopes(ScalarKey& key, const ScalarKey& next, double leaving, double arriving);

/// Shortens handles that reach beyond their stretch, so that it has one value at every time; their slopes stay.
void keep_handles_inside(ScalarCurve& curve);

/// The curve has a key; handles are inside.
double value_at(const ScalarCurve& curve, double time, Side side);
/// 1/s; of a stretch that is_polynomial.
double slope_at(const ScalarCurve& curve, double time, Side side);

/// The law of the stretch that holds `time`, none of whose ends it is; step beyond the keys.
ScalarKey::Law law_at(const ScalarCurve& curve, double time);
/// Is the value there a polynomial of time: any law, but for a Bezier only with handles at the thirds?
bool is_polynomial(const ScalarCurve& curve, double time);
/// How far the value goes between two neighbouring key times, there and back: at most so far.
double way_between(const ScalarCurve& curve, double from, double to);

} // namespace tutu::rig::import_detail
