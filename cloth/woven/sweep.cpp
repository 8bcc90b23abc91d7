#include "cloth/woven/sweep.h"

#include "cloth/state/tolerances.h"

#include <algorithm>

namespace tutu::cloth {
namespace {

template <class T> class TileSweep {
public:
  TileSweep(WovenSheet<T>& sheet, const SweptCollider& collider, std::vector<ClothContact>* kept)
      : sheet_(sheet), collider_(collider), kept_(kept) {}

  void particle(int i) {
    const Vec3 now = sheet_.position(i);
    const auto contact = swept_contact(sheet_.start_position(i), now, collider_);
    if (!contact) return;
    sheet_.move_to(i, now + contact->passed * contact->touch.normal);
    count({i, -1, -1}, *contact, {1.0, 0.0, 0.0});
  }

  void triangle(const std::array<int, 3>& corners) {
    std::array<Vec3, 3> from, to;
    for (int k = 0; k < 3; ++k) {
      from[k] = sheet_.start_position(corners[k]);
      to[k] = sheet_.position(corners[k]);
    }
    const auto contact = swept_contact(from, to, collider_);
    if (!contact) return;
    double lightness = 0.0; // sum of inverse mass times squared share
    for (int k = 0; k < 3; ++k)
      lightness += sheet_.inverse_mass(corners[k]) * contact->weights[k] * contact->weights[k];
    if (!(lightness > 0.0)) return;
    std::array<double, 3> levers;
    for (int k = 0; k < 3; ++k) {
      levers[k] = std::min(sheet_.inverse_mass(corners[k]) * contact->weights[k] / lightness, k_longest_lever);
      const double moved = contact->passed * levers[k];
      if (moved > 0.0) sheet_.move_to(corners[k], to[k] + moved * contact->touch.normal);
    }
    count(corners, *contact, levers);
  }

  std::int64_t count() const { return count_; }

private:
  void count(const std::array<int, 3>& particles, const SweptContact& contact, const std::array<double, 3>& levers) {
    ++count_;
    if (!kept_) return;
    ClothContact& kept = kept_->emplace_back();
    kept.particles = particles;
    kept.weights = contact.weights;
    kept.levers = levers;
    kept.contact = contact.touch;
    kept.push = contact.passed;
    kept.moved = contact.passed * contact.touch.normal;
    kept.cause = ContactCause::sweep;
    kept.time = contact.time;
  }

  WovenSheet<T>& sheet_;
  const SweptCollider& collider_;
  std::vector<ClothContact>* kept_;
  std::int64_t count_ = 0;
};

} // namespace

template <class T>
std::int64_t sweep_tile(WovenSheet<T>& sheet, int block, int first, int last, const SweptCollider& collider, bool cells,
                        std::vector<ClothContact>* kept) {
  const WovenSheetView<T>& view = sheet.view();
  const Weave& weave = sheet.weave();
  TileSweep<T> sweep(sheet, collider, kept);
  sheet.for_free({block, first, last}, [&](int particle) { sweep.particle(particle); });
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

template std::int64_t sweep_tile(WovenSheet<float>&, int, int, int, const SweptCollider&, bool,
                                 std::vector<ClothContact>*);
template std::int64_t sweep_tile(WovenSheet<double>&, int, int, int, const SweptCollider&, bool,
                                 std::vector<ClothContact>*);

} // namespace tutu::cloth
