#include "cloth/contact/self_collision.h"

#include "cloth/contact/coulomb.h"
#include "cloth/state/tolerances.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tutu::cloth {
namespace {

const double k_safe = std::sqrt(k_held * k_held - (k_worn_cell / k_cover) * (k_worn_cell / k_cover));

} // namespace

double safe_way(double kept) { return 2.0 * k_safe * kept; }

double covering_radius(const Vec3& a, const Vec3& b, const Vec3& c) {
  double sides[3] = {(b - a).norm(), (c - b).norm(), (a - c).norm()};
  std::sort(sides, sides + 3);
  const auto [x, y, z] = sides;
  const double obtuse = z * z - x * x - y * y;
  if (obtuse < 0.0) return x * y * z / (2.0 * (b - a).cross(c - a).norm()); // the circumscribed circle's
  // The corner of y and z reaches along z to where the bisector of y meets it, y / (2 cos); so does that of x and z.
  const double cos_yz = (y * y + z * z - x * x) / (2.0 * y * z);
  return y / (2.0 * cos_yz);
}

SelfCollision::SelfCollision(const Garment& garment)
    : garment_(&garment), kept_(garment.rest_positions.size(), garment.fabric.thickness) {
  const std::vector<Vec3>& rest = garment.rest_positions;
  for (const auto& triangle : garment.triangles) {
    const double kept = k_cover * covering_radius(rest[triangle[0]], rest[triangle[1]], rest[triangle[2]]);
    for (const std::uint32_t corner : triangle) kept_[corner] = std::max(kept_[corner], kept);
  }
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    inverse_masses_.push_back(pinned[i] ? 0.0 : 1.0 / garment.masses[i]);
    free_ += pinned[i] ? 0 : 1;
  }
  least_kept_ = kept_.empty() ? 0.0 : *std::min_element(kept_.begin(), kept_.end());
  travel_.resize(rest.size());
  way_.resize(rest.size());
  seen_.resize(rest.size());
  is_slowed_.resize(rest.size());
  is_moved_.resize(rest.size());
}

bool SelfCollision::resolve(std::span<const Vec3> start, std::span<Vec3> positions, double h) {
  if (!is_in_world(positions) || !is_in_world(start)) return false;
  ++counts_.substeps;
  for (const int i : moved_) is_moved_[i] = is_slowed_[i] = 0;
  moved_.clear();
  account_ways(start, positions);
  wake_pairs(start);
  std::int64_t too_fast = find_near(start, positions, h);
  if (too_fast > 0) {
    slow_down(start, positions);
    too_fast = find_near(start, positions, h);
  }
  counts_.loose += too_fast;
  for (const Pair& pair : awake_) counts_.loose += pair.before < k_held * pair.kept ? 1 : 0;
  std::copy(positions.begin(), positions.end(), seen_.begin());
  for (int pass = 0; pass < k_self_passes; ++pass)
    for (Pair& pair : near_) push_apart(pair, start, positions);
  for (const Pair& pair : near_) counts_.contacts += pair.touched ? 1 : 0;
  return true;
}

void SelfCollision::account_ways(std::span<const Vec3> start, std::span<Vec3> positions) {
  const int count = static_cast<int>(positions.size());
  mean_way_.setZero();
  held_way_.setZero();
  Vec3 since_seen = Vec3::Zero();
  for (int i = 0; i < count; ++i) {
    (inverse_masses_[i] > 0.0 ? mean_way_ : held_way_) += positions[i] - start[i];
    since_seen += start[i] - seen_[i];
  }
  mean_way_ /= std::max(free_, 1);
  held_way_ /= std::max(count - free_, 1);
  since_seen /= std::max(count, 1);
  const double off = (held_way_ - mean_way_).norm(), most_off = k_most_off * least_kept_;
  if (off > most_off) held_way_ = mean_way_ + (most_off / off) * (held_way_ - mean_way_);
  for (int i = 0; i < count; ++i) {
    const double most = k_farthest_way * kept_[i];
    way_[i] = (positions[i] - start[i] - mean_way_).norm();
    if (way_[i] > most) {
      if (inverse_masses_[i] > 0.0) {
        positions[i] = start[i] + mean_way_ + (most / way_[i]) * (positions[i] - start[i] - mean_way_);
        ++counts_.slowed;
        touch(i);
      } else {
        ++counts_.loose;
      }
      way_[i] = most;
    }
    travel_[i] += (start[i] - seen_[i] - since_seen).norm() + way_[i];
  }
  cover(start);
}

void SelfCollision::allow_slowing(std::span<const Vec3> start) {
  const double off = (held_way_ - mean_way_).norm();
  for (std::size_t i = 0; i < way_.size(); ++i) {
    const double more = off + 0.5 * k_safe * kept_[i] - way_[i];
    if (!(more > 0.0)) continue;
    way_[i] += more;
    travel_[i] += more;
  }
  cover(start);
}

void SelfCollision::cover(std::span<const Vec3> start) {
  bool covered = !begin_.empty();
  for (std::size_t i = 0; i < travel_.size(); ++i) covered = covered && travel_[i] <= room_ * kept_[i];
  if (!covered) search(start);
}

void SelfCollision::search(std::span<const Vec3> start) {
  const int count = static_cast<int>(start.size());
  double farthest = 0.0, most_kept = 0.0;
  for (int i = 0; i < count; ++i) {
    farthest = std::max(farthest, way_[i] / kept_[i]);
    most_kept = std::max(most_kept, kept_[i]);
  }
  room_ = std::clamp(k_substeps_a_search * farthest, k_least_room, k_most_room);
  hash_.build(start, (1.0 + k_near + 2.0 * room_) * most_kept + k_travel_slack);
  found_.clear();
  begin_.assign(count + 1, 0);
  hash_.for_each_pair([&](int i, int j, double squared) {
    const double kept = std::max(kept_[i], kept_[j]), patch = k_same_patch * kept;
    const double reach = (1.0 + k_near) * kept + room_ * (kept_[i] + kept_[j]) + k_travel_slack;
    if (squared > reach * reach) return;
    if ((garment_->rest_positions[j] - garment_->rest_positions[i]).squaredNorm() < patch * patch) return;
    if (inverse_masses_[i] + inverse_masses_[j] == 0.0) return;
    found_.push_back({std::min(i, j), std::max(i, j)});
    ++begin_[found_.back()[0]];
  });
  std::exclusive_scan(begin_.begin(), begin_.end(), begin_.begin(), 0);
  others_.resize(found_.size());
  for (const auto& [i, j] : found_) others_[begin_[i]++] = j; // begin_ is now where each ends
  for (int i = count; i > 0; --i) begin_[i] = begin_[i - 1];
  begin_[0] = 0;
  for (int i = 0; i < count; ++i) std::sort(others_.begin() + begin_[i], others_.begin() + begin_[i + 1]);
  wake_.assign(others_.size(), 0.0);
  travel_ = way_;
  ++counts_.searches;
  counts_.candidates += static_cast<std::int64_t>(others_.size());
}

void SelfCollision::wake_pairs(std::span<const Vec3> start) {
  awake_.clear();
  const int count = static_cast<int>(start.size());
  for (int i = 0; i < count; ++i)
    for (int pair = begin_[i]; pair < begin_[i + 1]; ++pair) {
      const int j = others_[pair];
      const double travelled = travel_[i] + travel_[j];
      if (travelled < wake_[pair]) continue;
      ++counts_.tests;
      // Whatever becomes of both on their ways (they may yet be slowed), they come no nearer than `ways` than they
      // were.
      const double kept = std::max(kept_[i], kept_[j]), ways = way_[i] + way_[j];
      const double before = (start[j] - start[i]).norm(), gap = before - (1.0 + k_near) * kept;
      wake_[pair] = travelled - ways + gap - k_travel_slack;
      if (gap < ways + k_travel_slack) awake_.push_back({i, j, kept, before, 0.0, false});
    }
}

bool SelfCollision::is_too_fast(const Pair& pair, std::span<const Vec3> start, std::span<const Vec3> positions) const {
  // The slack: two that were both slowed are at the bound, but for rounding.
  const double most = k_safe * pair.kept + k_travel_slack;
  const double squared = (positions[pair.j] - positions[pair.i] - (start[pair.j] - start[pair.i])).squaredNorm();
  return squared > most * most && pair.before < pair.kept + std::sqrt(squared);
}

bool SelfCollision::slow_down(int particle, const Vec3& start, Vec3& position) {
  const double most = 0.5 * k_safe * kept_[particle];
  const Vec3 way = position - start - held_way_;
  const double length = way.norm();
  if (inverse_masses_[particle] == 0.0 || is_slowed_[particle] || length <= most) return false;
  position = start + held_way_ + (most / length) * way;
  is_slowed_[particle] = 1;
  ++counts_.slowed;
  touch(particle);
  return true;
}

void SelfCollision::slow_down(std::span<const Vec3> start, std::span<Vec3> positions) {
  allow_slowing(start);
  wake_pairs(start);
  for (bool changed = true; changed;) { // a particle slowed for one pair moves against those it went along with
    changed = false;
    for (const Pair& pair : awake_) {
      if (!is_too_fast(pair, start, positions)) continue;
      const bool first = slow_down(pair.i, start[pair.i], positions[pair.i]);
      const bool second = slow_down(pair.j, start[pair.j], positions[pair.j]);
      changed = changed || first || second;
    }
  }
}

std::int64_t SelfCollision::find_near(std::span<const Vec3> start, std::span<const Vec3> positions, double h) {
  near_.clear();
  std::int64_t too_fast = 0;
  for (const Pair& pair : awake_) {
    too_fast += is_too_fast(pair, start, positions) ? 1 : 0;
    const double reach = (1.0 + k_near) * pair.kept;
    if (!((positions[pair.j] - positions[pair.i]).squaredNorm() < reach * reach)) continue;
    near_.push_back(pair);
    near_.back().reached = std::min(pair.kept, pair.before + k_push_out_speed * h);
  }
  return too_fast;
}

void SelfCollision::push_apart(Pair& pair, std::span<const Vec3> start, std::span<Vec3> positions) {
  Vec3 &a = positions[pair.i], &b = positions[pair.j];
  const double distance = (b - a).norm();
  if (!(distance < pair.reached) || distance == 0.0) return; // in one place: no direction, and in the next none either
  const Vec3 normal = (b - a) / distance;
  const double share = inverse_masses_[pair.i] / (inverse_masses_[pair.i] + inverse_masses_[pair.j]);
  const double push = pair.reached - distance;
  a -= (share * push) * normal;
  b += ((1.0 - share) * push) * normal;
  const Vec3 slip = (b - start[pair.j]) - (a - start[pair.i]);
  const Vec3 back = rubbed(Vec3::Zero(), slip, normal, k_cloth_friction * push);
  a -= share * back;
  b += (1.0 - share) * back;
  pair.touched = true;
  touch(pair.i);
  touch(pair.j);
}

void SelfCollision::touch(int particle) {
  if (is_moved_[particle]) return;
  is_moved_[particle] = 1;
  moved_.push_back(particle);
}

} // namespace tutu::cloth
