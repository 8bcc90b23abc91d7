#include "proxies/fit/fit.h"

#include "proxies/fit/detail/measure.h"
#include "proxies/fit/detail/search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tutu::proxies {
namespace {

using namespace fit;

constexpr int k_guard_poses = 8;
constexpr int k_first_steps = 10, k_last_steps = 15, k_swap_rounds = 12;
constexpr int k_fewest_on_curve = 4;
constexpr int k_denser = 4; // samples for the last refinement, times those of the search
constexpr int k_cover_rounds = 50;
constexpr double k_cover_margin = 2e-5; // m: rounding of radii and of single precision

/// What share of the work is done, as seen from the number of shapes: growing costs about as much as polishing.
class Share {
public:
  explicit Share(const FitProgress& progress) : progress_(progress) {}
  void set(double share) { share_ = std::clamp(share, share_, 1.0); }
  bool keep_going() {
    if (!stopped_ && progress_) stopped_ = !progress_(share_);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

private:
  const FitProgress& progress_;
  double share_ = 0.0;
  bool stopped_ = false;
};

FitCurvePoint curve_point(const Search& search, const PointBlocks& blocks) {
  FitCurvePoint point;
  point.count = search.shape_count();
  std::vector<float> under, over;
  const Nearest& nearest = search.nearest();
  for (std::size_t i = 0; i < nearest.distance.size(); ++i) {
    if (!(blocks.weight[i] > 0.0f)) continue;
    under.push_back(std::max(0.0f, nearest.distance[i]));
    over.push_back(std::max(0.0f, -nearest.distance[i]));
  }
  if (under.empty()) return point;
  const auto p95 = [](std::vector<float>& v) {
    const auto at = v.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(v.size() - 1));
    std::nth_element(v.begin(), at, v.end());
    return static_cast<double>(*at);
  };
  point.under_max = static_cast<double>(*std::max_element(under.begin(), under.end()));
  point.over_max = static_cast<double>(*std::max_element(over.begin(), over.end()));
  point.under_p95 = p95(under);
  point.over_p95 = p95(over);
  return point;
}

bool meets(const FitCurvePoint& point, double error) { return std::max(point.under_p95, point.over_p95) <= error; }

/// Makes skin that sticks out dearer and dearer, then widens what is still too thin, as seen at points of its own.
bool cover(Search& search, const FitPoints& dense, const BodyMotion& motion, double tolerance,
           std::vector<Unit>& units) {
  for (int round = 0; round < 2; ++round) {
    Cost cost = search.problem().cost;
    cost.under *= 10.0;
    search.set_cost(cost);
    search.refine(k_last_steps);
  }
  units = search.units();
  PosedShapes shapes;
  Nearest nearest;
  for (int round = 0; round < k_cover_rounds; ++round) {
    shapes.place(units, motion);
    find_nearest(dense.blocks, shapes, false, nearest);
    std::vector<double> lack(units.size(), 0.0);
    for (std::size_t i = 0; i < nearest.distance.size(); ++i) {
      if (!(dense.blocks.weight[i] > 0.0f)) continue;
      double& worst = lack[shapes.unit[nearest.shape[i]]];
      worst = std::max(worst, static_cast<double>(nearest.distance[i]) - (tolerance - k_cover_margin));
    }
    bool covered = true;
    for (std::size_t u = 0; u < units.size(); ++u) {
      if (!(lack[u] > 0.0)) continue;
      covered = false;
      units[u].radius_a += lack[u];
      units[u].radius_b += lack[u];
    }
    if (covered) return true;
  }
  return false;
}

void check(const std::vector<std::vector<Transform>>& poses, const rig::Character& character,
           const FitOptions& options) {
  if (poses.empty()) throw std::invalid_argument("no pose to fit");
  for (const auto& pose : poses)
    if (static_cast<int>(pose.size()) != character.skeleton.joint_count())
      throw std::invalid_argument("a pose of another skeleton");
  if (options.count < 1 || options.count > k_most_fit_shapes)
    throw std::invalid_argument("a count of " + std::to_string(options.count) + ", not 1 to " +
                                std::to_string(k_most_fit_shapes));
  if (options.samples < k_lanes || options.poses < 1) throw std::invalid_argument("too few samples or poses");
  if (!(std::isfinite(options.under_weight) && options.under_weight > 0.0))
    throw std::invalid_argument("a weight that is not above 0");
  const auto bad = [](const std::optional<double>& length) {
    return length && !(std::isfinite(*length) && *length >= 0.0);
  };
  if (bad(options.max_error) || bad(options.cover)) throw std::invalid_argument("a tolerance below 0");
}

} // namespace

FitResult fit_proxies(const rig::Character& character, const std::vector<std::vector<Transform>>& poses,
                      const FitOptions& options, const FitProgress& progress) {
  check(poses, character, options);
  std::vector<std::vector<Transform>> fitted;
  for (const int p : most_different(poses, options.poses)) fitted.push_back(poses[p]);
  Share share(progress);
  const FitPoints points = sample_skin(character, fitted, options.region, options.samples, 1);
  const BodyMotion motion = body_motion(character, fitted, options.symmetric, points.skin);
  const Guard guard(character, fitted, most_different(fitted, k_guard_poses), motion);
  share.set(0.1);

  FitResult result;
  Cost cost;
  cost.under = options.under_weight;
  cost.guard.weight *=
      std::max(1.0, options.under_weight); // the dearer what is missed, the more shapes reach out for it
  Search search(points, motion, guard, cost, [&] { return share.keep_going(); });
  search.start(first_layout(points.skin, motion, character.skeleton, options.tapered));
  search.refine(k_first_steps);
  const auto note = [&](const Search& at) { result.curve.push_back(curve_point(at, points.blocks)); };

  note(search);
  for (Search fewer = search; fewer.shape_count() > std::min(k_fewest_on_curve, options.count) && share.keep_going();) {
    if (!fewer.shrink(fewer.shape_count())) break;
    note(fewer);
    if (fewer.shape_count() > options.count || search.shape_count() <= options.count) continue;
    search = fewer; // the first that is not above the count
  }
  const int first = search.shape_count();
  while (search.shape_count() < options.count && share.keep_going()) {
    if (options.max_error && meets(curve_point(search, points.blocks), *options.max_error)) break;
    if (!search.grow(options.count - search.shape_count())) break;
    note(search);
    share.set(0.1 + 0.5 * (search.shape_count() - first) / std::max(1, options.count - first));
  }
  share.set(0.6);
  search.polish(k_swap_rounds, k_last_steps, [&](double done) { share.set(0.6 + 0.4 * done); });
  note(search);
  std::vector<Unit> units = search.units();
  // Where shapes are small against the samples' spacing they follow the samples: the last word has more of them.
  const FitPoints dense = sample_skin(character, fitted, options.region, k_denser * options.samples, 2);
  refine({dense.blocks, motion, guard, cost}, units, k_last_steps);
  if (options.max_error) result.met = meets(result.curve.back(), *options.max_error);
  if (options.cover) {
    search.start(units);
    result.met = cover(search, dense, motion, *options.cover, units) && result.met;
  }
  std::stable_sort(result.curve.begin(), result.curve.end(),
                   [](const auto& a, const auto& b) { return a.count < b.count; });
  // Of two with one count the later is the better one: it was refined longer.
  std::vector<FitCurvePoint> curve;
  for (const FitCurvePoint& point : result.curve) {
    if (!curve.empty() && curve.back().count == point.count) curve.pop_back();
    curve.push_back(point);
  }
  result.curve = std::move(curve);
  result.proxies = proxies_of(units, motion, character.skeleton);
  result.interrupted = share.stopped();
  for (int j = 0; j < motion.joints; ++j)
    result.symmetric = result.symmetric || (motion.mirror[j] >= 0 && motion.mirror[j] != j);
  return result;
}

} // namespace tutu::proxies
