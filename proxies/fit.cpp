#include "proxies/fit.h"

#include "proxies/fit_search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tutu::proxies {
namespace {

using namespace fit;

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

} // namespace

FitResult fit_proxies(const rig::Character& character, const std::vector<std::vector<Transform>>& poses,
                      const FitOptions& options, const FitProgress& progress) {
  if (poses.empty()) throw std::invalid_argument("no pose to fit");
  const std::vector<int> chosen = most_different(poses, options.poses);
  std::vector<std::vector<Transform>> fitted;
  for (const int p : chosen) fitted.push_back(poses[p]);
  const FitPoints points = sample_skin(character, fitted, options.region, options.samples, 1);
  const BodyMotion motion = body_motion(character, fitted, options.symmetric, points.skin);
  std::vector<int> guarded;
  for (const int p : most_different(fitted, 8)) guarded.push_back(p);
  const Guard guard(character, fitted, guarded, motion);

  FitResult result;
  const auto keep_going = [&] { return !progress || progress(0.5); };
  Cost cc; if (getenv("GW")) cc.guard.weight=atof(getenv("GW")); if (getenv("GD")) cc.guard.dead=atof(getenv("GD"));
  Search search(points, motion, guard, cc, keep_going);
  search.start(first_layout(points.skin, motion, character.skeleton));
  search.refine(10);
  while (search.shape_count() > options.count && search.shrink(search.shape_count())) {}
  while (search.shape_count() < options.count) {
    result.curve.push_back(curve_point(search, points.blocks));
    if (!search.grow(options.count - search.shape_count())) break;
  }
  if(getenv("V2")) fprintf(stderr,"before polish %g\n",search.cost()); search.polish(getenv("PR")?atoi(getenv("PR")):12, 15);if(getenv("V2")) fprintf(stderr,"after polish %g\n",search.cost());
  result.curve.push_back(curve_point(search, points.blocks));
  result.proxies = proxies_of(search.units(), motion, character.skeleton);
  return result;
}

} // namespace tutu::proxies
