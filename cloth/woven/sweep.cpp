#include "cloth/woven/sweep.h"

#include "cloth/state/tolerances.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_motion.h"
#include "proxies/motion/sweep.h"

#include <algorithm>

namespace tutu::cloth {
namespace {

/// By how much a point that touched with this contact at `time` ends the step on the wrong side of the surface, m.
/// Nothing for one whose contact at the end still points out the way it came in: that one will do.
double passed_by(const SweptCollider& collider, double time, const proxies::Contact& contact, const Vec3& now) {
  if (proxies::signed_distance(now, collider.end).normal.dot(contact.normal) > 0.0) return 0.0;
  const proxies::Capsule then = proxies::capsule_at(collider.start, collider.end, time);
  const Vec3 surface =
      contact.closest + proxies::surface_motion(then, collider.end, (1.0 - time) * collider.spin, contact.closest);
  return collider.offset - (now - surface).dot(contact.normal);
}

/// m. Single precision keeps a particle this near to where a contact put it.
constexpr double k_touching = 1e-5;

template <class T> class TileSweep {
public:
  TileSweep(WovenSheet<T>& sheet, const SweptCollider& collider) : sheet_(sheet), collider_(collider) {}

  void particle(int i) {
    if (!(sheet_.inverse_mass(i) > 0.0)) return;
    const Vec3 now = sheet_.position(i);
    const auto impact =
        proxies::time_of_impact(sheet_.start_position(i), now, collider_.start, collider_.end, collider_.offset);
    if (!impact || is_inside(impact->contact)) return;
    const double passed = passed_by(collider_, impact->time, impact->contact, now);
    if (passed <= 0.0) return;
    sheet_.move_to(i, now + passed * impact->contact.normal);
    ++count_;
  }

  void triangle(const std::array<int, 3>& corners) {
    std::array<Vec3, 3> from, to;
    for (int k = 0; k < 3; ++k) {
      from[k] = sheet_.start_position(corners[k]);
      to[k] = sheet_.position(corners[k]);
    }
    const auto impact = proxies::time_of_impact(from, to, collider_.start, collider_.end, collider_.offset);
    // Where the axis went through the triangle before the step began, no side is known to be the right one; and one
    // that began inside is worked out slowly.
    if (!impact || impact->contact.feature == proxies::ClothFeature::crossing || is_inside(impact->contact)) return;
    Vec3 now = Vec3::Zero();
    double lightness = 0.0; // sum of inverse mass times squared share
    for (int k = 0; k < 3; ++k) {
      const double share = impact->contact.weights[k];
      now += share * to[k];
      lightness += sheet_.inverse_mass(corners[k]) * share * share;
    }
    const double passed = passed_by(collider_, impact->time, impact->contact, now);
    if (passed <= 0.0 || !(lightness > 0.0)) return;
    for (int k = 0; k < 3; ++k) {
      const double lever = sheet_.inverse_mass(corners[k]) * impact->contact.weights[k] / lightness;
      const double moved = passed * std::min(lever, k_longest_lever);
      if (moved > 0.0) sheet_.move_to(corners[k], to[k] + moved * impact->contact.normal);
    }
    ++count_;
  }

  std::int64_t count() const { return count_; }

private:
  /// Deeper at the first touch than touching is: the step began so.
  bool is_inside(const proxies::Contact& contact) const { return contact.distance < collider_.offset - k_touching; }

  WovenSheet<T>& sheet_;
  const SweptCollider& collider_;
  std::int64_t count_ = 0;
};

} // namespace

template <class T>
std::int64_t sweep_tile(WovenSheet<T>& sheet, int block, int first, int last, const SweptCollider& collider,
                        bool cells) {
  const WovenSheetView<T>& view = sheet.view();
  const Weave& weave = sheet.weave();
  TileSweep<T> sweep(sheet, collider);
  for (int row = first; row < last; ++row)
    for (int lane = 0; lane < view.lanes; ++lane) {
      const int column = sheet.column_of(block, lane);
      if (column >= 0) sweep.particle(weave.particle(row, column));
    }
  for (int row = first; cells && row < std::min(last, weave.rows - 1); ++row)
    for (int lane = 0; lane < view.lanes; ++lane) {
      const int column = sheet.column_of(block, lane);
      if (column < 0 || (column == weave.columns - 1 && !sheet.is_ring())) continue;
      const int right = (column + 1) % weave.columns;
      const int a = weave.particle(row, column), b = weave.particle(row, right);
      const int c = weave.particle(row + 1, column), d = weave.particle(row + 1, right);
      sweep.triangle({a, c, b});
      sweep.triangle({b, c, d});
    }
  return sweep.count();
}

template std::int64_t sweep_tile(WovenSheet<float>&, int, int, int, const SweptCollider&, bool);
template std::int64_t sweep_tile(WovenSheet<double>&, int, int, int, const SweptCollider&, bool);

} // namespace tutu::cloth
