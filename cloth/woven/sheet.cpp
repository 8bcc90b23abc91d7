#include "cloth/woven/sheet.h"

#include "cloth/garment/elements.h"
#include "cloth/state/tolerances.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <tuple>

namespace tutu::cloth {
namespace {

constexpr std::size_t k_alignment = 64; // bytes: the widest vector

/// Lanes in use: as many as there can be with at least `fewest` columns in each.
int lanes_for(int columns, bool woven_shut, int fewest) {
  const int most = std::clamp(columns / fewest, 1, k_lanes);
  if (!woven_shut) return most;
  // A ring: few blocks; of such lanes those that divide its columns, which spares the copies; of the others those with
  // the fewest vectors of half a row, short lanes having none in the last block.
  const auto cost = [&](int lanes) {
    const int blocks = (columns + lanes - 1) / lanes, long_lanes = columns % lanes;
    const auto halves = [](int count) { return count > k_lanes / 2 ? 2 : 1; };
    const int vectors = (blocks - (long_lanes > 0)) * halves(lanes) + (long_lanes > 0 ? halves(long_lanes) : 0);
    return std::tuple(blocks, long_lanes > 0, vectors, -lanes);
  };
  int best = most;
  for (int lanes = most; lanes > 0; --lanes)
    if (cost(lanes) < cost(best)) best = lanes;
  return best;
}

/// Whether fewer than half of the threads that are solved as wholes have a pinned particle: then most of the load goes
/// through the weft, which is not.
bool is_held_at_few_places(const Weave& weave, const Garment& garment) {
  std::vector<std::uint8_t> held(weave.columns, 0);
  for (const Pin& pin : garment.pins) held[weave.column(pin.particle)] = 1;
  const auto count = 2 * std::count(held.begin(), held.end(), 1);
  return count > 0 && count < weave.columns;
}

/// Equal but for rounding: what a ring of equal cells gives.
bool same(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

} // namespace

Weave::Weave(const Garment& garment) : rows(garment.rows), columns(garment.columns) {
  if (garment.woven_shut) return; // the view's columns go round
  int at_row_ends = 0, at_column_ends = 0;
  for (const Pin& pin : garment.pins) {
    const int r = pin.particle / columns, c = pin.particle % columns;
    at_row_ends += c == 0 || c == columns - 1;
    at_column_ends += r == 0 || r == rows - 1;
  }
  turned = at_row_ends * columns > at_column_ends * rows; // as shares of each pair of borders
  if (turned) std::swap(rows, columns);
}

template <class T> AlignedArray<T>::AlignedArray(std::size_t count) {
  if (count == 0) return;
  data_.reset(static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(k_alignment))));
  std::fill_n(data_.get(), count, T(0));
}
template <class T> void AlignedArray<T>::Free::operator()(T* p) const {
  ::operator delete(p, std::align_val_t(k_alignment));
}

template <class T>
WovenSheet<T>::WovenSheet(const Garment& garment, bool with_multipliers) : garment_(&garment), weave_(garment) {
  view_.has_bend = garment.fabric.bend > 0.0;
  view_.has_shear = garment.fabric.shear > 0.0;
  view_.rows = weave_.rows;
  // A constraint must not meet a particle twice in one vector: edges reach one block on, bends two.
  const int fewest = view_.has_bend ? 3 : 2;
  view_.lanes = lanes_for(weave_.columns, garment.woven_shut, fewest);
  view_.blocks = std::max(fewest, (weave_.columns + view_.lanes - 1) / view_.lanes);
  const int left_over = garment.woven_shut ? weave_.columns % view_.lanes : 0;
  view_.long_lanes = left_over > 0 ? left_over : view_.lanes;
  view_.block_stride = static_cast<std::ptrdiff_t>(view_.rows + 1) * k_lanes; // one row of room behind each

  const std::size_t size = static_cast<std::size_t>(view_.blocks + 2) * view_.block_stride;
  const auto array = [&](std::size_t count) {
    arrays_.emplace_back(count);
    return arrays_.back().data();
  };
  for (T** field : {view_.x, view_.was, view_.v})
    for (int axis = 0; axis < 3; ++axis) field[axis] = array(size);
  view_.workspace = array(6 * static_cast<std::size_t>(view_.block_stride));
  const bool tethered = is_held_at_few_places(weave_, garment);
  view_.multipliers[0] = array(with_multipliers ? size : view_.block_stride);
  view_.multipliers[1] = array(size);
  for (int k = 2; k < 4; ++k) view_.multipliers[k] = with_multipliers ? array(size) : nullptr;

  elements_.resize(garment.particle_count());
  const auto element = [&](int block, int row, int lane) {
    return block * view_.block_stride + static_cast<std::ptrdiff_t>(row) * k_lanes + lane;
  };
  for (int block = 0; block < view_.blocks; ++block)
    for (int lane = 0; lane < k_lanes; ++lane)
      if (const int column = column_of(block, lane); column >= 0)
        for (int row = 0; row < view_.rows; ++row) elements_[weave_.particle(row, column)] = element(block, row, lane);
  for (int block = 0; block < view_.blocks; ++block)
    for (int lane = 0; lane < k_lanes; ++lane) {
      if (column_of(block, lane) >= 0) continue;
      for (int row = 0; row < view_.rows; ++row) {
        empty_.push_back(element(block, row, lane));
        twins_.push_back(elements_[weave_.particle(row, std::min(block, weave_.columns - 1))]);
      }
    }
  build_springs(garment);
  build_bends(garment);
  if (tethered) place_tethers(garment);
  set(garment.rest_positions, std::vector<Vec3>(garment.rest_positions.size(), Vec3::Zero()));
}

template <class T> int WovenSheet<T>::column_of(int block, int lane) const {
  if (lane >= view_.lanes || (block + 1 == view_.blocks && lane >= view_.long_lanes)) return -1;
  const int column = lane * view_.blocks - std::max(lane - view_.long_lanes, 0) + block;
  return column < weave_.columns ? column : -1;
}

template <class T> std::vector<int> WovenSheet<T>::particles_of_elements() const {
  std::vector<int> particles(static_cast<std::size_t>(view_.blocks + 2) * view_.block_stride, -1);
  for (int block = 0; block < view_.blocks + 2; ++block)
    for (int lane = 0; lane < view_.lanes; ++lane)
      for (int row = 0; row < view_.rows; ++row) { // what lies behind a lane's end are the columns that come next
        const int column = (column_of(0, lane) + block) % weave_.columns;
        particles[block * view_.block_stride + row * k_lanes + lane] = weave_.particle(row, column);
      }
  return particles;
}

template <class T> WovenTable<T> WovenSheet<T>::table(std::vector<T> values) {
  // One block for all when every row is uniform.
  bool uniform = true;
  for (int block = 0; block < view_.blocks + 2 && uniform; ++block)
    for (int k = 0; k < view_.rows * k_lanes && uniform; ++k)
      uniform = same(values[block * view_.block_stride + k], values[k / k_lanes * k_lanes]);
  if (uniform) {
    for (int k = 0; k < view_.rows * k_lanes; ++k) values[k] = values[k / k_lanes * k_lanes];
    values.resize(view_.block_stride);
  }
  arrays_.emplace_back(values.size());
  std::copy(values.begin(), values.end(), arrays_.back().data());
  return {arrays_.back().data(), uniform ? 0 : view_.block_stride};
}

template <class T> void WovenSheet<T>::build_springs(const Garment& garment) {
  const std::size_t size = static_cast<std::size_t>(view_.blocks + 2) * view_.block_stride;
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  const bool ring = garment.woven_shut;
  // What lies behind the lanes' ends, from `block` on: copies of blocks 0 and 1, a lane on.
  const auto turned = [&](std::vector<T>& values, int block, int first_lane) {
    for (int number = 0; number < 2; ++number)
      for (int row = 0; row < view_.rows; ++row)
        for (int lane = first_lane; lane < view_.lanes; ++lane) {
          const std::ptrdiff_t in_block = static_cast<std::ptrdiff_t>(row) * k_lanes;
          values[(block + number) * view_.block_stride + in_block + lane] =
              values[number * view_.block_stride + in_block + (lane + 1) % view_.lanes];
        }
  };

  std::vector<T> weights(size, T(0));
  for (int i = 0; i < garment.particle_count(); ++i)
    if (!pinned[i]) weights[elements_[i]] = static_cast<T>(1.0 / garment.masses[i]);
  turned(weights, view_.blocks, 0);
  view_.own_inverse_mass = view_.inverse_mass = table(weights);
  if (has_short_lanes(view_)) {
    turned(weights, view_.blocks - 1, view_.long_lanes);
    view_.inverse_mass = table(weights);
  }

  // What does not exist gives way; what lies in lanes without a column looks like the others of its row.
  struct Family {
    std::vector<T> length, compliance;
  };
  constexpr T k_no_length = T(1e6); // m: never found broken
  const Family none{std::vector<T>(size, k_no_length), std::vector<T>(size, static_cast<T>(k_no_constraint))};
  Family warp = none, weft = none, falling = none, rising = none;
  const int n = weave_.columns;
  for (const Spring& spring : garment.springs) {
    if (spring.kind == SpringKind::bend) continue;
    int upper = spring.i, lower = spring.j;
    if (weave_.row(upper) > weave_.row(lower)) std::swap(upper, lower);
    const int row = weave_.row(upper), first = weave_.column(upper), second = weave_.column(lower);
    const bool slants = row != weave_.row(lower);
    // The left end is the one whose right neighbour the other is.
    const bool first_is_left = first + 1 == second || (ring && first == n - 1 && second == 0);
    Family& family = first == second ? warp : !slants ? weft : first_is_left ? falling : rising;
    const std::ptrdiff_t at = elements_[weave_.particle(row, first == second || first_is_left ? first : second)];
    family.length[at] = static_cast<T>(spring.rest_length);
    family.compliance[at] = static_cast<T>(1.0 / spring.stiffness);
  }
  for (Family* family : {&warp, &weft, &falling, &rising}) {
    if (ring || family == &warp)
      for (std::size_t k = 0; k < empty_.size(); ++k) {
        family->length[empty_[k]] = family->length[twins_[k]];
        family->compliance[empty_[k]] = family->compliance[twins_[k]];
      }
    turned(family->length, view_.blocks, 0);
    turned(family->compliance, view_.blocks, 0);
  }
  view_.warp = {table(warp.length), table(warp.compliance)};
  view_.weft = {table(weft.length), table(weft.compliance)};
  view_.falling = {table(falling.length), table(falling.compliance)};
  view_.rising = {table(rising.length), table(rising.compliance)};
}

template <class T> void WovenSheet<T>::build_bends(const Garment& garment) {
  const std::size_t size = static_cast<std::size_t>(view_.blocks + 2) * view_.block_stride;
  std::vector<T> warp_ratio(size, T(1)), weft_ratio(size, T(1));
  std::vector<T> warp(size, static_cast<T>(k_no_constraint)), weft = warp;
  const int n = weave_.columns;
  const auto& rest = garment.rest_positions;
  const auto add = [&](int a, int b, int c, std::vector<T>& ratio, std::vector<T>& compliance) {
    const double first = (rest[b] - rest[a]).norm(), second = (rest[c] - rest[b]).norm();
    // The sheet's share of the middle particle: its mass over the density. c is first * (first + second) / 2 times the
    // curvature.
    const double area = garment.masses[b] / garment.fabric.density, per_curvature = 0.5 * first * (first + second);
    ratio[elements_[a]] = static_cast<T>(first / second);
    compliance[elements_[a]] = static_cast<T>(per_curvature * per_curvature / (garment.fabric.bend * area));
  };
  if (view_.has_bend)
    for (int row = 0; row < weave_.rows; ++row)
      for (int column = 0; column < n; ++column) {
        const auto particle = [&](int r, int c) { return weave_.particle(r, c % n); };
        const int a = particle(row, column);
        if (row + 2 < weave_.rows) add(a, particle(row + 1, column), particle(row + 2, column), warp_ratio, warp);
        if (column + 2 < n || garment.woven_shut)
          add(a, particle(row, column + 1), particle(row, column + 2), weft_ratio, weft);
      }
  if (garment.woven_shut)
    for (std::size_t k = 0; k < empty_.size(); ++k)
      for (std::vector<T>* values : {&warp_ratio, &weft_ratio, &warp, &weft})
        (*values)[empty_[k]] = (*values)[twins_[k]];
  view_.warp_bend = {table(warp_ratio), table(warp)};
  view_.weft_bend = {table(weft_ratio), table(weft)};
}

template <class T> void WovenSheet<T>::place_tethers(const Garment& garment) {
  const std::size_t size = static_cast<std::size_t>(view_.blocks + 2) * view_.block_stride;
  constexpr T k_no_tether = T(1e6); // m, and its square is a number
  arrays_.emplace_back(size);
  T* const length = arrays_.back().data();
  std::fill_n(length, size, k_no_tether);
  anchors_ = AlignedArray<typename WovenTethers<T>::Element>(size);
  for (const Tether& tether : build_tethers(garment)) {
    if (!(tether.length > 0.0)) continue; // a seam holds it
    length[elements_[tether.particle]] = static_cast<T>(longest_of(tether, garment.fabric));
    anchors_.data()[elements_[tether.particle]] =
        static_cast<typename WovenTethers<T>::Element>(elements_[tether.anchor]);
  }
  view_.tethers = {length, anchors_.data()};
}

template <class T> Vec3 WovenSheet<T>::at(T* const* field, int particle) const {
  const std::ptrdiff_t element = elements_[particle];
  return {static_cast<double>(field[0][element]), static_cast<double>(field[1][element]),
          static_cast<double>(field[2][element])};
}

template <class T> double WovenSheet<T>::inverse_mass(int particle) const {
  const std::ptrdiff_t block = elements_[particle] / view_.block_stride,
                       in_block = elements_[particle] % view_.block_stride;
  return static_cast<double>(view_.inverse_mass.data[block * view_.inverse_mass.block_stride + in_block]);
}

template <class T> void WovenSheet<T>::put(T* const* field, int particle, const Vec3& position) {
  for (int axis = 0; axis < 3; ++axis)
    field[axis][elements_[particle]] = static_cast<T>(position[axis] - origin_[axis]);
}

template <class T> void WovenSheet<T>::move_to(int particle, const Vec3& position) { put(view_.x, particle, position); }

template <class T> void WovenSheet<T>::move_start_to(int particle, const Vec3& position) {
  put(view_.was, particle, position);
}

template <class T> void WovenSheet<T>::pin_to(int particle, const Vec3& position, double h) {
  move_to(particle, position);
  const std::ptrdiff_t element = elements_[particle];
  for (int axis = 0; axis < 3; ++axis)
    view_.v[axis][element] = (view_.x[axis][element] - view_.was[axis][element]) / static_cast<T>(h);
}

template <class T> void WovenSheet<T>::set_velocity(int particle, const Vec3& velocity) {
  for (int axis = 0; axis < 3; ++axis) view_.v[axis][elements_[particle]] = static_cast<T>(velocity[axis]);
}

template <class T> void WovenSheet<T>::take_back() {
  for (int axis = 0; axis < 3; ++axis)
    std::copy_n(view_.was[axis], static_cast<std::size_t>(view_.blocks) * view_.block_stride, view_.x[axis]);
}

template <class T> void WovenSheet<T>::join(int first, int second, T share_of_second) {
  const std::ptrdiff_t a = elements_[first], b = elements_[second];
  for (T* x : view_.x) x[a] = x[b] = (T(1) - share_of_second) * x[a] + share_of_second * x[b];
}

template <class T> void WovenSheet<T>::set(std::span<const Vec3> positions, std::span<const Vec3> velocities) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : positions) middle += p / static_cast<double>(positions.size());
  // What is no number leaves the origin where it was; the step will find it.
  if (middle.allFinite()) origin_ = middle.array().round();
  for (int i = 0; i < static_cast<int>(positions.size()); ++i) {
    move_to(i, positions[i]);
    set_velocity(i, velocities[i]);
  }
  follow();
  for (int axis = 0; axis < 3; ++axis)
    std::copy_n(view_.x[axis], static_cast<std::size_t>(view_.blocks) * view_.block_stride, view_.was[axis]);
}

template <class T> void WovenSheet<T>::get_positions(std::span<Vec3> out) const {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = at(view_.x, static_cast<int>(i)) + origin_;
}

template <class T> void WovenSheet<T>::get_starts(std::span<Vec3> out) const {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = at(view_.was, static_cast<int>(i)) + origin_;
}

template <class T> void WovenSheet<T>::get(Particles& out) const {
  get_positions(out.positions);
  for (std::size_t i = 0; i < out.velocities.size(); ++i) out.velocities[i] = at(view_.v, static_cast<int>(i));
}

template <class T> void WovenSheet<T>::follow() {
  // Whole metres: moving the origin costs no bits while coordinates stay small.
  const Vec3 somewhere = at(view_.x, 0);
  constexpr double k_far = 2.0; // m
  if (somewhere.allFinite() && somewhere.cwiseAbs().maxCoeff() > k_far) {
    const Vec3 shift = somewhere.array().round();
    for (int axis = 0; axis < 3; ++axis)
      for (const std::ptrdiff_t element : elements_) view_.x[axis][element] -= static_cast<T>(shift[axis]);
    origin_ += shift;
  }
  for (std::size_t k = 0; k < empty_.size(); ++k)
    for (int axis = 0; axis < 3; ++axis) view_.x[axis][empty_[k]] = view_.x[axis][twins_[k]];
}

template class AlignedArray<float>;
template class AlignedArray<double>;
template class AlignedArray<std::int32_t>;
template class AlignedArray<std::int64_t>;
template class WovenSheet<float>;
template class WovenSheet<double>;

} // namespace tutu::cloth
