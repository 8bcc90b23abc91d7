#include "cloth/woven/contacts.h"

#include "cloth/state/tolerances.h"
#include "cloth/woven/sweep.h"
#include "proxies/distance/closed_forms.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/motion/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tutu::cloth {
namespace {

// Tile::pinched: substeps that a tile is settled particle by particle after it was pinched, those that one beside it
// is, and when it is looked at whether it has to be.
constexpr int k_pinched_for = 16, k_beside_pinched = 9, k_suspect = 1;
/// Substeps for which nobody looks again at a tile that was not; Tile::pinched is below 0.
constexpr int k_unsuspected_for = 7;

template <class T> void copy(const Vec3& from, T* to) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<T>(from[axis]);
}

} // namespace

template <class T>
WovenContacts<T>::WovenContacts(const Garment& garment, const SolverOptions& options, const WovenSheet<T>& sheet)
    : offset_(garment.fabric.contact_offset()), features_(options.features), swept_(options.swept),
      pinched_cloth_(garment) {
  const WovenSheetView<T>& view = sheet.view();
  for (int block = 0; block < view.blocks; ++block)
    for (int first = 0; first < view.rows; first += k_tile_rows) {
      Tile tile;
      tile.rows = {block, first, std::min(first + k_tile_rows, view.rows)};
      tiles_.push_back(tile);
    }
  tiles_per_block_ = tiles_.size() / static_cast<std::size_t>(view.blocks);
  const Weave& weave = sheet.weave();
  struct Row {
    double reach = 0.0, weft = 0.0, warp = 0.0;
  };
  std::vector<Row> rows(view.rows); // of the cells below each
  for (const Spring& spring : garment.springs) {
    if (spring.kind == SpringKind::bend) continue;
    // A cell lies within its longest diagonal of each corner, and cloth stretches.
    Row& row = rows[std::min(weave.row(spring.i), weave.row(spring.j))];
    row.reach = std::max(row.reach, k_cell_stretch * spring.rest_length);
    if (spring.kind == SpringKind::shear) continue;
    double& edge = weave.row(spring.i) != weave.row(spring.j) ? row.warp : row.weft;
    edge = std::max(edge, spring.rest_length);
  }
  for (Tile& tile : tiles_)
    for (int k = std::max(tile.rows.first - 1, 0); k < tile.rows.last; ++k) {
      tile.reach = std::max(tile.reach, rows[k].reach);
      tile.weft = std::max(tile.weft, rows[k].weft);
      tile.warp = std::max(tile.warp, rows[k].warp);
    }
  boxes_.resize(tiles_.size());
}

template <class T>
void WovenContacts<T>::begin_frame(proxies::CollisionQuery& query, const FrameInput& input,
                                   const WovenSheet<T>& sheet) {
  input_ = &input;
  s_before_ = 0.0;
  keeper_.begin_step(sheet, input.contacts);
  placed_.assign(input.colliders.start.begin(), input.colliders.start.end());
  if (colliders_.size() != placed_.size()) { // room for all there may be, so that no later frame asks for more
    const std::size_t most = tiles_.size() * (placed_.size() + 1);
    pairs_.reserve(most);
    candidates_.colliders.reserve(most);
    asked_.reserve(placed_.size() + 1);
    pinched_cloth_.reserve(placed_.size() + 1);
  }
  colliders_.resize(placed_.size());
  marks_.resize(placed_.size() * static_cast<std::size_t>(sheet.view().blocks * sheet.view().rows));
  for (Tile& tile : tiles_) tile.margin = k_least_tile_margin + k_margin_growth * tile.speed * input.seconds;
  find_pairs(query, sheet);
}

template <class T> void WovenContacts<T>::find_pairs(proxies::CollisionQuery& query, const WovenSheet<T>& sheet) {
  const WovenKernel<T> kernel = woven_kernel<T>();
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    Tile& tile = tiles_[t];
    tile.travelled = 0.0;
    T low[3], high[3];
    kernel.bounds(sheet.view(), tile.rows.block, tile.rows.first, tile.rows.last, low, high);
    const double grown = offset_ + tile.margin + (features_ == ContactFeatures::particles ? 0.0 : tile.reach);
    for (int axis = 0; axis < 3; ++axis) {
      boxes_[t].min()[axis] = static_cast<double>(low[axis]) + sheet.origin()[axis] - grown;
      boxes_[t].max()[axis] = static_cast<double>(high[axis]) + sheet.origin()[axis] + grown;
    }
  }
  query.find_for_boxes(input_->colliders, boxes_, candidates_);
  begin_ = candidates_.begin;
  pairs_.clear();
  for (std::size_t t = 0; t < tiles_.size(); ++t)
    for (int p = begin_[t]; p < begin_[t + 1]; ++p) pairs_.push_back(pair_of(tiles_[t], candidates_.colliders[p]));
  any_wide_ = std::ranges::any_of(pairs_, [](const Pair& pair) { return pair.features.wide; });
  collider_travel_.assign(placed_.size() + 1, 0.0);
  ++counts_.searches;
  counts_.candidates += static_cast<std::int64_t>(pairs_.size());
}

template <class T> void WovenContacts<T>::place(const Vec3& origin, double s, double h) {
  placed_before_.swap(placed_);
  placed_.resize(placed_before_.size());
  proxies::colliders_at(input_->colliders, s, placed_);
  const double push_speed_step = k_push_out_speed * h;
  for (std::size_t k = 0; k < placed_.size(); ++k) {
    // Where one end ball is all there is, it alone has moved.
    const bool is_ball = proxies::is_one_ball(placed_[k]);
    const proxies::Capsule now = is_ball ? proxies::wide_end(placed_[k]) : placed_[k],
                           before = is_ball ? proxies::wide_end(placed_before_[k]) : placed_before_[k];
    const proxies::PlainCone cone = proxies::round_cone(now);
    WovenCollider<T>& c = colliders_[k];
    const Vec3 move_a = now.a - before.a, move_b = now.b - before.b;
    copy(Vec3(cone.a - origin), c.a);
    copy(cone.axis, c.axis);
    c.per_axis_squared = static_cast<T>(cone.per_axis_squared);
    c.radius = static_cast<T>(cone.radius + offset_);
    c.taper = static_cast<T>(cone.taper);
    c.lean = static_cast<T>(cone.lean);
    copy(move_a, c.move_a);
    copy(Vec3(move_b - move_a), c.move_axis);
    Vec3 spin = Vec3::Zero();
    if (!input_->colliders.spin.empty()) spin = (s - s_before_) * input_->colliders.spin[k];
    copy(is_ball ? spin : Vec3(cone.axis * (cone.axis.dot(spin) / cone.axis.squaredNorm())), c.spin);
    copy(proxies::normal_on_axis(now), c.on_axis);
    c.friction = input_->friction.empty() ? T(0) : static_cast<T>(input_->friction[k]);
    const double moved = std::max(move_a.norm(), move_b.norm());
    c.moved = static_cast<T>(moved);
    c.push_speed_step = static_cast<T>(push_speed_step);
    collider_travel_[k] += moved;
  }
  ground_.reset();
  if (const auto& plane = input_->colliders.ground) {
    WovenPlane<T>& g = ground_.emplace();
    copy(plane->normal, g.normal);
    g.offset = static_cast<T>(plane->offset - plane->normal.dot(origin) + offset_);
    g.friction = input_->friction.empty() ? T(0) : static_cast<T>(input_->friction[placed_.size()]);
    g.push_speed_step = static_cast<T>(push_speed_step);
  }
  s_step_ = s - s_before_;
  s_before_ = s;
}

template <class T>
bool WovenContacts<T>::resolve(proxies::CollisionQuery& query, const WovenKernel<T>& kernel, WovenSheet<T>& sheet,
                               double s, double h) {
  const WovenSheetView<T>& view = sheet.view();
  place(sheet.origin(), s, h);
  keeper_.begin_substep(sheet.origin(), h);
  bool all_numbers = true, covered = true;
  for (Tile& tile : tiles_) {
    const double way =
        std::sqrt(static_cast<double>(kernel.farthest(view, tile.rows.block, tile.rows.first, tile.rows.last)));
    all_numbers = all_numbers && way < k_world_radius; // false for what is no number
    tile.way = way;
    tile.travelled += way;
    covered = covered && tile.travelled <= tile.margin;
  }
  if (!all_numbers) return false;
  if (!covered) {
    for (Tile& tile : tiles_) tile.margin = std::max(tile.margin, k_margin_growth * tile.travelled);
    find_pairs(query, sheet);
  }
  WovenHits<T>& hits = keeper_.hits();
  const int ground = static_cast<int>(placed_.size());
  const bool any_pinched = std::ranges::any_of(tiles_, [](const Tile& tile) { return tile.pinched > 0; });
  if (any_pinched) pinched_cloth_.begin(sheet);
  if (any_wide_) std::ranges::fill(marks_, std::uint8_t{0});
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    Tile& tile = tiles_[t];
    if (tile.pinched < 0) ++tile.pinched;
    if (tile.pinched > 0 && settle(sheet, t, h)) continue;
    const std::int64_t before = hits.count;
    for (int p = begin_[t]; p < begin_[t + 1]; ++p) {
      Pair& pair = pairs_[p];
      const double travelled = tile.travelled + collider_travel_[pair.collider];
      pair.in_haste = false;
      if (swept_ && pair.collider != ground && travelled >= pair.wake - tile.reach) {
        // So near a cell of the tile may be.
        const double safe = proxies::safe_motion(placed_[pair.collider].narrowest(), offset_);
        const double motion = tile.way + static_cast<double>(colliders_[pair.collider].moved);
        const double hasty = pair.fits_through ? std::min(0.5 * safe, k_hasty_speed * h) : 0.5 * safe;
        pair.in_haste = motion >= hasty && features_ != ContactFeatures::particles;
        if (motion >= safe) sweep(sheet, tile, pair);
      }
      if (travelled < pair.wake && !(pair.features.wide && travelled >= pair.cells_wake)) continue;
      ++counts_.queries;
      WovenMarks<T> marks;
      if (pair.features.wide)
        marks = {static_cast<T>(pair.within), marks_of(view, pair.collider, tile.rows.block) + tile.rows.first, 0};
      const T gap = pair.collider == ground
                        ? kernel.contact_plane(view, tile.rows, *ground_, &hits)
                        : kernel.contact_capsule(view, tile.rows, colliders_[pair.collider], pair.rise,
                                                 pair.features.wide ? &marks : nullptr, &hits);
      if (keeper_.keeps()) take(pair, static_cast<double>(pair.rise));
      pair.wake = travelled + static_cast<double>(gap) - k_tile_travel_slack;
      pair.cells_wake = travelled + static_cast<double>(marks.nearest) - pair.within - k_tile_travel_slack;
      const double moved = pair.collider == ground ? 0.0 : static_cast<double>(colliders_[pair.collider].moved);
      if (tile.pinched == 0 && -static_cast<double>(gap) > moved + k_left_deep) tile.pinched = k_suspect;
    }
    tile.touched = hits.count != before;
  }
  if (any_pinched) spread_pinches();
  resolve_cells(kernel, view);
  counts_.contacts = hits.count;
  return true;
}

template <class T> bool WovenContacts<T>::settle(WovenSheet<T>& sheet, std::size_t t, double h) {
  Tile& tile = tiles_[t];
  asked_.clear();
  for (int p = begin_[t]; p < begin_[t + 1]; ++p)
    if (tile.travelled + collider_travel_[pairs_[p].collider] >= pairs_[p].wake)
      asked_.push_back({pairs_[p].collider, offset_ + static_cast<double>(pairs_[p].rise)});
  const PlacedColliders placed{input_->colliders, placed_before_, placed_, input_->friction, s_step_, h};
  if (tile.pinched == k_suspect && !pinched_cloth_.is_pinched(sheet, tile.rows, placed, asked_)) {
    tile.pinched = -k_unsuspected_for;
    return false;
  }
  const SettledTile settled = pinched_cloth_.settle(sheet, tile.rows, placed, asked_, keeper_.listed());
  if (keeper_.keeps()) keeper_.take_settled(placed_);
  std::size_t k = 0;
  for (int p = begin_[t]; p < begin_[t + 1] && k < asked_.size(); ++p) {
    if (pairs_[p].collider != asked_[k].collider) continue;
    pairs_[p].wake = tile.travelled + collider_travel_[pairs_[p].collider] + asked_[k].gap - k_tile_travel_slack;
    pairs_[p].cells_wake = 0.0;
    ++k;
  }
  counts_.queries += static_cast<std::int64_t>(asked_.size());
  keeper_.hits().count += settled.contacts;
  tile.travelled += settled.start_moved;
  tile.touched = true;
  tile.pinched = settled.pinched ? k_pinched_for : tile.pinched - 1;
  return true;
}

/// Those beside a tile that is pinched are settled too: what pushes their corners must not tear those that it holds.
template <class T> void WovenContacts<T>::spread_pinches() {
  const std::size_t count = tiles_.size(), down = tiles_per_block_;
  for (std::size_t t = 0; t < count; ++t) {
    if (tiles_[t].pinched != k_pinched_for) continue;
    const auto warn = [&](std::size_t at) {
      tiles_[at % count].pinched = std::max(tiles_[at % count].pinched, k_beside_pinched);
    };
    warn(t + down);
    warn(t + count - down);
    if ((t + 1) % down != 0) warn(t + 1);
    if (t % down != 0) warn(t - 1);
  }
}

/// A tile whose cells have a corner in one that is pinched: what pushed them would undo what was settled.
template <class T> bool WovenContacts<T>::is_pinched_around(std::size_t t) const {
  const std::size_t count = tiles_.size(), down = tiles_per_block_;
  const auto is = [&](std::size_t at) { return tiles_[at % count].pinched > k_suspect; };
  const bool has_below = (t + 1) % down != 0;
  return is(t) || is(t + down) || (has_below && (is(t + 1) || is(t + 1 + down)));
}

template <class T> void WovenContacts<T>::sweep(WovenSheet<T>& sheet, const Tile& tile, const Pair& pair) {
  SweptCollider collider;
  collider.start = placed_before_[pair.collider];
  collider.end = placed_[pair.collider];
  if (!input_->colliders.spin.empty()) collider.spin = s_step_ * input_->colliders.spin[pair.collider];
  collider.offset = offset_;
  keeper_.hits().count += sweep_tile(sheet, tile.rows.block, tile.rows.first, tile.rows.last, collider,
                                     pair.features.wide || pair.in_haste, keeper_.listed());
  if (keeper_.keeps()) keeper_.take_swept(pair.collider, collider.start, collider.end);
}

template <class T> typename WovenContacts<T>::Pair WovenContacts<T>::pair_of(const Tile& tile, int collider) const {
  Pair pair;
  pair.collider = collider;
  const bool is_flat = collider == static_cast<int>(placed_.size()); // a plane meets the corners first
  if (is_flat || features_ == ContactFeatures::particles) return pair;
  const double offset = placed_[collider].narrowest() + offset_;
  // The square of the distance to what is convex bends no more than that to a point. Between two corners of a cell it
  // is less than theirs by a quarter of the squared distance between them at most, as it is on their triangle.
  const double longest = k_cell_stretch * std::hypot(tile.weft, tile.warp);
  const double within = std::sqrt(offset * offset + 0.25 * longest * longest) - offset;
  if (features_ == ContactFeatures::triangles) {
    pair.features = {true, true};
    pair.within = within;
    return pair;
  }
  const double radius = placed_[collider].narrowest(), clear = radius - k_tolerated_poke;
  const double weft = k_worn_cell * tile.weft, warp = k_worn_cell * tile.warp;
  // The middle of a triangle bent around the collider with legs of length h lies (2/9) h^2 within the square of its
  // corners' distance from the axis: it clears all but k_tolerated_poke when the corners keep this from the axis.
  const double longer = std::max(weft, warp), kept = clear * clear + 2.0 / 9.0 * longer * longer;
  const double floating = offset + k_most_rise;
  pair.fits_through = k_torn_cell * std::max(tile.weft, tile.warp) > 2.0 * offset;
  if (kept <= floating * floating) {
    pair.rise = static_cast<T>(kept > offset * offset ? std::sqrt(kept) - offset : 0.0);
    return pair;
  }
  // Of a line of length l whose ends keep the offset the middle lies l^2 / 4 within that square. Where that is nothing
  // along the warp, edges along the weft and diagonals are enough: all of a triangle lies on such lines between two of
  // them.
  const auto pokes = [&](double length) { return 0.25 * length * length > offset * offset - clear * clear; };
  pair.features = {pokes(weft) || pokes(warp), pokes(warp)};
  if (pair.features.wide) pair.within = within;
  return pair;
}

template <class T> void WovenContacts<T>::take(const Pair& pair, double rise) {
  if (pair.collider == static_cast<int>(placed_.size())) keeper_.take(pair.collider, offset_);
  else keeper_.take(pair.collider, placed_[pair.collider], offset_ + rise);
}

/// Of the cells of a tile those with a corner that is near to the collider.
template <class T>
bool WovenContacts<T>::find_asked_rows(const WovenSheetView<T>& view, const Tile& tile, const Pair& pair) {
  const auto& [block, first, last] = tile.rows;
  if (pair.in_haste) {
    asked_rows_.fill(1);
    return pair.wake - tile.travelled - collider_travel_[pair.collider] <= tile.reach;
  }
  if (!pair.features.wide) return false;
  const std::uint8_t* left = marks_of(view, pair.collider, block);
  const std::uint8_t* right = marks_of(view, pair.collider, (block + 1) % view.blocks);
  const std::uint8_t* turned = needs_halo(view, block) ? marks_of(view, pair.collider, 0) : right;
  const auto is_near = [&](int row) { return left[row] | right[row] | turned[row]; };
  int above = is_near(first), any = 0;
  for (int row = first; row < last; ++row) {
    const int below = row + 1 < view.rows ? is_near(row + 1) : 0;
    asked_rows_[row - first] = static_cast<std::uint8_t>(above | below);
    any |= above | below;
    above = below;
  }
  return any != 0;
}

template <class T> void WovenContacts<T>::resolve_cells(const WovenKernel<T>& kernel, const WovenSheetView<T>& view) {
  if (features_ == ContactFeatures::particles) return;
  WovenHits<T>& hits = keeper_.hits();
  bool has_halo = false;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    Tile& tile = tiles_[t];
    const std::int64_t before = hits.count;
    if (is_pinched_around(t)) continue;
    for (int p = begin_[t]; p < begin_[t + 1]; ++p) {
      const Pair& pair = pairs_[p];
      if (!find_asked_rows(view, tile, pair)) continue;
      if (!has_halo && needs_halo(view, tile.rows.block)) {
        kernel.fetch_halo(view);
        has_halo = true;
      }
      kernel.contact_cells(view, tile.rows, colliders_[pair.collider],
                           pair.in_haste ? CellFeatures{true, true} : pair.features, asked_rows_.data(), &hits);
      if (keeper_.keeps()) take(pair, 0.0);
    }
    tile.touched = tile.touched || hits.count != before;
  }
  if (has_halo) kernel.return_halo(view);
}

template <class T>
bool WovenContacts<T>::finish(WovenFinish<T> kernel, const WovenSheetView<T>& view, const WovenStep<T>& step) {
  bool all_numbers = true;
  for (Tile& tile : tiles_) {
    const double way =
        std::sqrt(static_cast<double>(kernel(view, step, tile.rows.block, tile.rows.first, tile.rows.last)));
    all_numbers = all_numbers && way < k_world_radius;
    // From where the tile was measured, contacts took it at most back and on to where it is now.
    if (tile.touched) tile.travelled += tile.way + way;
    tile.speed = way / static_cast<double>(step.h);
  }
  return all_numbers;
}

template <class T> double WovenContacts<T>::fastest() const {
  double fastest = 0.0;
  for (const Tile& tile : tiles_) fastest = std::max(fastest, tile.speed);
  return fastest;
}

template class WovenContacts<float>;
template class WovenContacts<double>;

} // namespace tutu::cloth
