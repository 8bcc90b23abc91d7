#include "proxies/query/collision_query.h"

#include "proxies/detail/query_guard.h"
#include "proxies/distance/closed_forms.h"
#include "proxies/distance/signed_distance.h"
#include "proxies/motion/collider_motion.h"
#include "proxies/query/detail/box_list.h"
#include "proxies/query/detail/broad_phase.h"
#include "proxies/query/detail/narrow_phase.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace tutu::proxies {
namespace {

/// Boxes and reach are grown by this (m), so that rounding never costs a pair that is exactly `reach` away.
constexpr double k_slack = 1e-9;

/// Consecutive points that share one question to the boxes. Of 8, 16, 32, 64 the quickest on a skirt of 4096 particles
/// in rows (52 us a frame; 66, 100, 88): longer runs catch colliders that few of their points are near.
constexpr std::size_t k_run = 16;

/// From so many colliders on `hybrid` asks FCL's tree, below it the plain list. us a frame, update included, tree /
/// list (bench_proxies `boxes`, 2-core EPYC; they tie at 100 colliders whatever the number of boxes):
///   colliders |       25        50        100        200         400         800
///    64 boxes |   14 / 5    17 / 9    21 / 15    26 / 34     32 / 73    53 / 149
///   128 boxes |  26 / 11   36 / 20    40 / 40    53 / 78    72 / 158    88 / 286
///   256 boxes |  59 / 21   62 / 37   89 / 103  106 / 141   129 / 416   223 / 573
///   512 boxes |  93 / 42  100 / 76  146 / 149  182 / 239   219 / 587  473 / 1163
constexpr int k_tree_from = 128;

void require_usable_frame(const SweptColliders& colliders) {
  if (colliders.start.size() != colliders.end.size())
    throw std::invalid_argument("collision query: found " + std::to_string(colliders.start.size()) +
                                " colliders at the start of the frame and " + std::to_string(colliders.end.size()) +
                                " at its end, expected as many");
  for (int i = 0; i < colliders.size(); ++i) {
    require_usable(colliders.start[i], i);
    require_usable(colliders.end[i], i);
  }
  require_usable(colliders.ground);
}

void require_usable_place(std::span<const Capsule> colliders, const std::optional<Plane>& ground) {
  for (std::size_t i = 0; i < colliders.size(); ++i) require_usable(colliders[i], static_cast<int>(i));
  require_usable(ground);
}

void start_rows(Candidates& out) {
  out.begin.assign(1, 0);
  out.colliders.clear();
}

/// Ends the row of a point or box: without colliders that are not met, and the ground comes last.
void end_row(const SweptColliders& colliders, Candidates& out) {
  if (!colliders.ignored.empty()) {
    const auto is_ignored = [&](int collider) { return !colliders.meets(collider); };
    const auto row = out.colliders.begin() + out.begin.back();
    out.colliders.erase(std::remove_if(row, out.colliders.end(), is_ignored), out.colliders.end());
  }
  if (colliders.ground) out.colliders.push_back(colliders.ground_index());
  out.begin.push_back(static_cast<int>(out.colliders.size()));
}

/// The points within a reach of a collider at any time of the frame, and few others.
class Neighbourhood {
public:
  Neighbourhood(const Capsule& start, const Capsule& end, double reach) : cone_(round_cone(swept_cover(start, end))) {
    cone_.radius += reach;
  }

  bool holds(const Vec3& point) const {
    const Vec3 from_a = point - cone_.a;
    const double t = nearest_on_axis(cone_, from_a), limit = radius_at(cone_, t);
    return (from_a - t * cone_.axis).squaredNorm() <= limit * limit;
  }

private:
  PlainCone cone_;
};

void find_neighbourhoods(const SweptColliders& colliders, double reach, std::vector<Neighbourhood>& out) {
  out.clear();
  for (int i = 0; i < colliders.size(); ++i) out.emplace_back(colliders.start[i], colliders.end[i], reach);
}

/// Contacts in closed form; only the search is left to do.
class ClosedFormQuery : public CollisionQuery {
public:
  void place(std::span<const Capsule> colliders, const std::optional<Plane>& ground) override {
    require_usable_place(colliders, ground);
    colliders_.assign(colliders.begin(), colliders.end());
    ground_ = ground;
  }

  Contact contact(const Vec3& point, int collider) const override {
    require_usable(point);
    return collider == static_cast<int>(colliders_.size()) ? signed_distance(point, *ground_)
                                                           : signed_distance(point, colliders_[collider]);
  }

private:
  std::vector<Capsule> colliders_;
  std::optional<Plane> ground_;
};

class BruteQuery final : public ClosedFormQuery {
public:
  void find_candidates(const SweptColliders& colliders, std::span<const Vec3> points, double reach,
                       Candidates& out) override {
    require_usable_frame(colliders);
    require_usable(points, reach);
    list_all(colliders, points.size(), out);
  }

  void find_for_boxes(const SweptColliders& colliders, std::span<const Box> boxes, Candidates& out) override {
    require_usable_frame(colliders);
    require_usable(boxes);
    list_all(colliders, boxes.size(), out);
  }

private:
  static void list_all(const SweptColliders& colliders, std::size_t rows, Candidates& out) {
    start_rows(out);
    for (std::size_t i = 0; i < rows; ++i) {
      for (int collider = 0; collider < colliders.size(); ++collider) out.colliders.push_back(collider);
      end_row(colliders, out);
    }
  }
};

class FclQuery final : public CollisionQuery {
public:
  void find_candidates(const SweptColliders& colliders, std::span<const Vec3> points, double reach,
                       Candidates& out) override {
    require_usable_frame(colliders);
    require_usable(points, reach);
    broad_phase_.update(colliders.start, colliders.end);
    const double grown = reach + k_slack;
    find_neighbourhoods(colliders, grown, neighbourhoods_);
    start_rows(out);
    for (const Vec3& point : points) {
      const auto row = static_cast<std::ptrdiff_t>(out.colliders.size());
      broad_phase_.overlaps({point.array() - grown, point.array() + grown}, out.colliders);
      const auto is_far = [&](int i) { return !neighbourhoods_[i].holds(point); };
      out.colliders.erase(std::remove_if(out.colliders.begin() + row, out.colliders.end(), is_far),
                          out.colliders.end());
      std::sort(out.colliders.begin() + row, out.colliders.end());
      end_row(colliders, out);
    }
  }

  void find_for_boxes(const SweptColliders& colliders, std::span<const Box> boxes, Candidates& out) override {
    require_usable_frame(colliders);
    require_usable(boxes);
    broad_phase_.update(colliders.start, colliders.end);
    start_rows(out);
    for (const Box& box : boxes) {
      const auto row = static_cast<std::ptrdiff_t>(out.colliders.size());
      broad_phase_.overlaps(box, out.colliders);
      std::sort(out.colliders.begin() + row, out.colliders.end());
      end_row(colliders, out);
    }
  }

  void place(std::span<const Capsule> colliders, const std::optional<Plane>& ground) override {
    require_usable_place(colliders, ground);
    narrow_phase_.place(colliders);
    count_ = static_cast<int>(colliders.size());
    ground_ = ground;
  }

  Contact contact(const Vec3& point, int collider) const override {
    require_usable(point);
    return collider == count_ ? signed_distance(point, *ground_) : narrow_phase_.contact(point, collider);
  }

private:
  BroadPhase broad_phase_;
  NarrowPhase narrow_phase_;
  std::vector<Neighbourhood> neighbourhoods_;
  std::optional<Plane> ground_;
  int count_ = 0;
};

class HybridQuery final : public ClosedFormQuery {
public:
  bool leaves_contacts() const override { return true; }

  void find_candidates(const SweptColliders& colliders, std::span<const Vec3> points, double reach,
                       Candidates& out) override {
    require_usable_frame(colliders);
    require_usable(points, reach);
    update(colliders);
    const double grown = reach + k_slack;
    find_neighbourhoods(colliders, grown, neighbourhoods_);
    start_rows(out);
    for (std::size_t first = 0; first < points.size(); first += k_run) {
      const std::span<const Vec3> run = points.subspan(first, std::min(k_run, points.size() - first));
      Box box;
      for (const Vec3& point : run) box.extend(point);
      near_.clear();
      overlaps({box.min().array() - grown, box.max().array() + grown}, near_);
      for (const Vec3& point : run) {
        for (const int i : near_)
          if (neighbourhoods_[i].holds(point)) out.colliders.push_back(i);
        end_row(colliders, out);
      }
    }
  }

  void find_for_boxes(const SweptColliders& colliders, std::span<const Box> boxes, Candidates& out) override {
    require_usable_frame(colliders);
    require_usable(boxes);
    update(colliders);
    start_rows(out);
    for (const Box& box : boxes) {
      overlaps(box, out.colliders);
      end_row(colliders, out);
    }
  }

private:
  void update(const SweptColliders& colliders) {
    by_tree_ = colliders.size() >= k_tree_from;
    if (by_tree_) broad_phase_.update(colliders.start, colliders.end);
    else box_list_.update(colliders.start, colliders.end);
  }

  void overlaps(const Box& box, std::vector<int>& out) {
    if (!by_tree_) return box_list_.overlaps(box, out);
    const auto row = static_cast<std::ptrdiff_t>(out.size());
    broad_phase_.overlaps(box, out);
    std::sort(out.begin() + row, out.end());
  }

  bool by_tree_ = false;
  BroadPhase broad_phase_;
  BoxList box_list_;
  std::vector<Neighbourhood> neighbourhoods_;
  std::vector<int> near_; // what the box of a run of points touches
};

} // namespace

Backend backend_named(std::string_view name) {
  const auto found = std::find(k_backend_names.begin(), k_backend_names.end(), name);
  if (found == k_backend_names.end()) throw std::invalid_argument("no backend called " + std::string(name));
  return static_cast<Backend>(found - k_backend_names.begin());
}

std::unique_ptr<CollisionQuery> make_query(Backend backend) {
  if (backend == Backend::mesh) throw std::invalid_argument("the backend mesh needs a body");
  if (backend == Backend::brute) return std::make_unique<BruteQuery>();
  if (backend == Backend::hybrid) return std::make_unique<HybridQuery>();
  return std::make_unique<FclQuery>();
}

} // namespace tutu::proxies
