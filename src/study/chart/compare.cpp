#include "src/study/chart/compare.h"

#include "src/study/chart/same_cloth.h"

#include <algorithm>
#include <cmath>

namespace tutu::app {
namespace {

/// Of the particle of `from` that is nearest to each of `to`: whether it touches.
std::vector<std::uint8_t> flags_on(const cloth::Garment& from, const std::vector<std::uint8_t>& flags,
                                   const cloth::Garment& to) {
  std::vector<Vec3> numbers;
  for (const std::uint8_t flag : flags) numbers.push_back(Vec3::Constant(flag));
  std::vector<std::uint8_t> result;
  for (const Vec3& number : positions_on(from, numbers, to)) result.push_back(number.x() >= 0.5);
  return result;
}

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

} // namespace

RunErrors errors_against(const std::vector<cloth::Garment>& reference_garments, const Trajectory& reference,
                         const std::vector<cloth::Garment>& garments, const Trajectory& run) {
  RunErrors errors;
  double squares = 0.0;
  std::int64_t particles = 0, touching = 0, missed = 0, apart = 0, wrong = 0;
  const std::size_t moments = std::min(reference.moments.size(), run.moments.size());
  for (std::size_t m = 0; m < moments; ++m) {
    const Trajectory::Moment &truth = reference.moments[m], &moment = run.moments[m];
    for (std::size_t g = 0; g < garments.size(); ++g) {
      const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garments[g]);
      const std::vector<Vec3> places = positions_on(reference_garments[g], truth.positions[g], garments[g]);
      const std::vector<std::uint8_t> touches = flags_on(reference_garments[g], truth.touching[g], garments[g]);
      for (std::size_t i = 0; i < places.size(); ++i) {
        if (pinned[i]) continue;
        (touches[i] ? touching : apart) += 1;
        missed += touches[i] && !moment.touching[g][i];
        wrong += !touches[i] && moment.touching[g][i];
        if (truth.time > k_trajectory_seconds + 1e-9) continue;
        const double distance = (moment.positions[g][i] - places[i]).norm();
        squares += distance * distance;
        ++particles;
        errors.trajectory_max = std::max(errors.trajectory_max, distance);
      }
    }
  }
  errors.trajectory_rms = particles > 0 ? std::sqrt(squares / static_cast<double>(particles)) : 0.0;
  errors.missed = share(missed, touching);
  errors.false_contacts = share(wrong, apart);
  errors.reference_contacts = share(touching, touching + apart);
  SurfaceDistance apart_by;
  for (std::size_t g = 0; g < garments.size(); ++g)
    apart_by.add(surface_distance(reference_garments[g], reference.drape[g], garments[g], run.drape[g]));
  errors.drape_rms = apart_by.rms();
  errors.drape_hausdorff = apart_by.hausdorff;
  return errors;
}

} // namespace tutu::app
