// The motion of a woven sheet without constraints: prediction, velocities, how far and how wide. For kernel.cpp
// alone.
#if defined(TUTU_CLOTH_WOVEN_MOTION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TUTU_CLOTH_WOVEN_MOTION_INL_H
#undef TUTU_CLOTH_WOVEN_MOTION_INL_H
#else
#define TUTU_CLOTH_WOVEN_MOTION_INL_H
#endif

#include "cloth/woven/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace tutu::cloth::HWY_NAMESPACE {

/// The largest of squared lengths, no number when any of them is none.
template <class T> class Farthest {
public:
  HWY_INLINE Farthest() : most_(hn::Zero(Tag<T>())), doubts_(hn::Zero(Tag<T>())) {}
  HWY_INLINE void add(const Wide3<T>& way) {
    const Wide<T> squared = dot(way, way);
    most_ = hn::Max(most_, squared);
    doubts_ = doubts_ + (squared - squared); // Max forgets what is no number, a sum never does
  }
  HWY_INLINE T squared() const {
    return hn::GetLane(hn::MaxOfLanes(Tag<T>(), most_)) + hn::GetLane(hn::SumOfLanes(Tag<T>(), doubts_));
  }

private:
  Wide<T> most_, doubts_;
};

/// A step without constraints, from x with velocity v.
template <class T> class Prediction {
public:
  HWY_INLINE Prediction(const WovenSheetView<T>& sheet, const WovenStep<T>& step)
      : sheet_(sheet), h_(set(step.h)), kept_(set(step.kept)), gain_(times(set(step.h), set3(step.gravity))) {}

  HWY_INLINE void move(std::ptrdiff_t at, const Wide3<T>& x, const Wide3<T>& v, Wide<T> inverse_mass) const {
    const auto is_free = inverse_mass > hn::Zero(Tag<T>());
    const Wide3<T> fallen = times(kept_, plus(v, gain_));
    const Wide3<T> now = {hn::IfThenElseZero(is_free, fallen.x), hn::IfThenElseZero(is_free, fallen.y),
                          hn::IfThenElseZero(is_free, fallen.z)};
    store(x, sheet_.was, at);
    store(now, sheet_.v, at);
    store(plus_times<T>(x, h_, now), sheet_.x, at);
  }

private:
  const WovenSheetView<T>& sheet_;
  Wide<T> h_, kept_;
  Wide3<T> gain_;
};

template <class T> void predict(const WovenSheetView<T>& sheet, const WovenStep<T>& step) {
  const Prediction<T> prediction(sheet, step);
  for (int block = 0; block < sheet.blocks; ++block)
    for_columns(sheet, block, 0, sheet.rows, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
      prediction.move(at, load(sheet.x, at), load(sheet.v, at),
                      load(row_of(sheet.own_inverse_mass, block, row) + lane));
    });
}

template <class T> void predict_again(const WovenSheetView<T>& sheet, const WovenStep<T>& step) {
  const Wide<T> h = set(step.h);
  for (int block = 0; block < sheet.blocks; ++block)
    for_columns(sheet, block, 0, sheet.rows, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
      const auto is_free = load(row_of(sheet.own_inverse_mass, block, row) + lane) > hn::Zero(Tag<T>());
      const Wide3<T> was = load(sheet.was, at), x = plus_times<T>(was, h, load(sheet.v, at));
      store({hn::IfThenElse(is_free, x.x, was.x), hn::IfThenElse(is_free, x.y, was.y),
             hn::IfThenElse(is_free, x.z, was.z)},
            sheet.x, at);
    });
}

template <bool k_predicts, class T>
T finish(const WovenSheetView<T>& sheet, const WovenStep<T>& step, int block, int first, int last) {
  const Wide<T> h = set(step.h), per_h = set(T(1) / step.h), most = set(step.fastest * step.fastest);
  const Prediction<T> prediction(sheet, step);
  Farthest<T> farthest;
  for_columns(sheet, block, first, last, [&](std::ptrdiff_t at, int row, int lane) HWY_ATTR {
    const Wide3<T> x = load(sheet.x, at), was = load(sheet.was, at);
    Wide3<T> v = load(sheet.v, at);
    farthest.add(minus(x, was));
    v = plus_times<T>(v, per_h, minus(x, plus_times<T>(was, h, v)));
    const Wide<T> speed = dot(v, v);
    const auto too_fast = speed > most;
    if (HWY_UNLIKELY(!hn::AllFalse(Tag<T>(), too_fast)))
      v = times(hn::IfThenElse(too_fast, hn::Sqrt(most / speed), set(T(1))), v);
    if constexpr (k_predicts) prediction.move(at, x, v, load(row_of(sheet.own_inverse_mass, block, row) + lane));
    else store(v, sheet.v, at);
  });
  return farthest.squared();
}

template <class T> T farthest(const WovenSheetView<T>& sheet, int block, int first, int last) {
  Farthest<T> farthest;
  for_columns(sheet, block, first, last, [&](std::ptrdiff_t at, int, int) HWY_ATTR {
    farthest.add(minus(load(sheet.x, at), load(sheet.was, at)));
  });
  return farthest.squared();
}

template <class T> void bounds(const WovenSheetView<T>& sheet, int block, int first, int last, T* low, T* high) {
  for (int axis = 0; axis < 3; ++axis) {
    Wide<T> least = load(sheet.x[axis] + place(sheet, block, first)), most = least;
    for_rows(sheet, block, first, last, [&](std::ptrdiff_t at, int, int) HWY_ATTR {
      const Wide<T> x = load(sheet.x[axis] + at);
      least = hn::Min(least, x);
      most = hn::Max(most, x);
    });
    low[axis] = hn::GetLane(hn::MinOfLanes(Tag<T>(), least));
    high[axis] = hn::GetLane(hn::MaxOfLanes(Tag<T>(), most));
  }
}

} // namespace tutu::cloth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
