#include "cloth/contact/between_colliders.h"

#include "cloth/state/tolerances.h"

#include <algorithm>
#include <cmath>

namespace tutu::cloth {
namespace {

/// What two colliders lack, m, and the cosine between their normals, < 0.
bool leave_no_room(double first, double second, double across) {
  constexpr double k_straight = -0.7; // less opposed ones leave a way out along both
  const auto [less, more] = std::minmax(first, second);
  return more > 0.0 && (less > 0.0 || (across < k_straight && less - more * across > 0.0));
}

} // namespace

std::optional<Opposed> opposed(std::span<const NearCollider> near) {
  std::optional<Opposed> most;
  double least = 0.0;
  for (std::size_t k = 0; k < near.size(); ++k)
    for (std::size_t l = k + 1; l < near.size(); ++l) {
      const double across = near[k].contact.normal.dot(near[l].contact.normal);
      if (across >= least || !leave_no_room(near[k].lacks(), near[l].lacks(), across)) continue;
      least = across;
      most = {k, l};
    }
  return most;
}

BetweenColliders::BetweenColliders(const Garment& garment)
    : begin_(garment.rest_positions.size() + 1, 0), anchors_(garment.rest_positions.size(), -1),
      reach_(garment.rest_positions.size(), 0.0) {
  const std::span<const Spring> threads = std::span(garment.springs).first(garment.structural_count);
  for (const Spring& thread : threads)
    for (const int i : {thread.i, thread.j}) ++begin_[i + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  threads_.resize(begin_.back());
  std::vector<int> next = begin_;
  for (const Spring& thread : threads) {
    threads_[next[thread.i]++] = {thread.j, thread.rest_length};
    threads_[next[thread.j]++] = {thread.i, thread.rest_length};
  }
  for (const Tether& tether : build_tethers(garment)) {
    anchors_[tether.particle] = tether.anchor;
    reach_[tether.particle] = tether.length;
  }
}

double BetweenColliders::need(int particle, double offset, double distance) const {
  return anchors_[particle] < 0 ? offset : std::min(offset, distance + k_pinched_reach * reach_[particle]);
}

Vec3 BetweenColliders::fitted(int particle, const Vec3& way, std::span<const Vec3> x) const {
  double share = 1.0;
  const double squared = way.squaredNorm();
  if (!(squared > 0.0)) return way;
  for (const auto& [other, length] : threads_of(particle)) {
    // |r + f way| = most: f^2 way^2 + 2 f r.way + r^2 - most^2 = 0, whose last term is 0 at most.
    const Vec3 r = x[particle] - x[other];
    const double most = std::max(k_pinched_thread * length, r.norm());
    const double half = r.dot(way), slack = most * most - r.squaredNorm();
    share = std::min(share, (std::sqrt(half * half + squared * std::max(0.0, slack)) - half) / squared);
  }
  return std::max(0.0, share) * way;
}

std::optional<BetweenColliders::Settled>
BetweenColliders::settle(const Place& place, std::span<const NearCollider> near, std::span<const Vec3> x) const {
  const auto pair = opposed(near);
  if (!pair) return std::nullopt;
  const NearCollider &first = near[pair->first], &second = near[pair->second];
  const double lacks_first = first.lacks(), lacks_second = second.lacks();
  const Vec3 apart = first.contact.normal - second.contact.normal, along = first.contact.normal + second.contact.normal;
  const Vec3 d = apart.normalized(), m = along.squaredNorm() > 1e-12 ? Vec3(along.normalized()) : Vec3(Vec3::Zero());
  const Vec3 surface = 0.5 * (first.surface + second.surface), way = x[place.particle] - place.start;
  const double most = way.norm() + std::max(first.moved, second.moved) + place.push_step;
  const double push = std::clamp((lacks_first - lacks_second) / apart.norm(), -most, most);
  const Vec3 relative = way - surface;
  const Vec3 slip = relative - relative.dot(d) * d - relative.dot(m) * m;
  const double sticks = std::max(first.friction, second.friction) * std::min(lacks_first + lacks_second, most);
  Settled settled;
  settled.way = push * d;
  if (const double slipped = slip.norm(); slipped > 0.0) settled.way -= std::min(1.0, sticks / slipped) * slip;
  settled.way = fitted(place.particle, settled.way, x);
  const Vec3 left = way + settled.way - surface;
  settled.start = left.dot(d) * d + left.dot(m) * m;
  settled.by = static_cast<int>(push >= 0.0 ? pair->first : pair->second);
  return settled;
}

} // namespace tutu::cloth
