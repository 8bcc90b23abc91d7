#include "cloth/recovery.h"

#include <algorithm>

namespace tutu::cloth {
namespace {

bool all_finite(std::span<const Vec3> points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3& p) { return tutu::is_finite(p); });
}

bool all_finite(std::span<const proxies::Capsule> capsules) {
  return std::all_of(capsules.begin(), capsules.end(),
                     [](const proxies::Capsule& c) { return tutu::is_finite(c.a) && tutu::is_finite(c.b); });
}

bool all_finite(std::span<const Vec3f> points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3f& p) { return p.allFinite(); });
}

bool is_finite(const FrameInput& input) {
  return all_finite(input.pins_start) && all_finite(input.pins_end) && all_finite(input.colliders.start) &&
         all_finite(input.colliders.end) && all_finite(input.colliders.spin) && all_finite(input.colliders.body_end);
}

} // namespace

void draw_in_edges(const Garment& garment, std::span<Vec3> positions, const FrameInput& input) {
  const std::vector<std::uint8_t> pinned = pinned_flags(garment);
  bool drawn = true;
  for (int pass = 0; pass < k_mending_passes && drawn && !input.is_stopped(); ++pass) {
    drawn = false;
    for (int k = 0; k < garment.structural_count; ++k) {
      const Spring& edge = garment.springs[k];
      const double wi = pinned[edge.i] ? 0.0 : 1.0 / garment.masses[edge.i];
      const double wj = pinned[edge.j] ? 0.0 : 1.0 / garment.masses[edge.j];
      const Vec3 d = positions[edge.j] - positions[edge.i];
      const double length = d.norm(), longest = (1.0 + k_mended_stretch) * edge.rest_length;
      if (wi + wj == 0.0 || !(length > longest)) continue;
      // To its rest length, not to the bound: so that the passes end.
      const Vec3 pull = ((length - edge.rest_length) / (length * (wi + wj))) * d;
      positions[edge.i] += wi * pull;
      positions[edge.j] -= wj * pull;
      drawn = true;
    }
  }
}

void GuardedSolver::forget() {
  recovery_.reset();
  refinement_ = 1;
  calm_ = stops_ = 0;
}

void GuardedSolver::reset(std::span<const Vec3> positions) {
  solver_->reset(positions);
  forget();
}

void GuardedSolver::restore(const Particles& state) {
  solver_->restore(state);
  forget();
}

std::optional<Unfinished> GuardedSolver::attempt(FrameInput input, proxies::CollisionQuery& query) {
  input.substeps *= refinement_;
  substeps_ = input.substeps;
  const auto end = solver_->step(input, query);
  times_.broad += solver_->times().broad;
  times_.cloth += solver_->times().cloth;
  times_.contact += solver_->times().contact;
  return end;
}

void GuardedSolver::jump(FrameInput& input) {
  mended_ = good_.positions;
  Vec3 way = Vec3::Zero();
  for (std::size_t k = 0; k < input.pins_end.size(); ++k)
    way += (input.pins_end[k] - input.pins_start[k]) / static_cast<double>(input.pins_end.size());
  for (Vec3& p : mended_) p += way;
  for (std::size_t k = 0; k < garment_->pins.size(); ++k) mended_[garment_->pins[k].particle] = input.pins_end[k];
  draw_in_edges(*garment_, mended_, input);
  solver_->reset(mended_);
  input.pins_start = input.pins_end;
  input.colliders.start = input.colliders.end;
  input.colliders.spin = {};
  input.colliders.body_start = input.colliders.body_end;
}

/// What of the input is no number.
Divergence GuardedSolver::nowhere(const FrameInput& input) const {
  Divergence nowhere;
  nowhere.trouble = Trouble::bad_collider;
  for (std::size_t k = 0; k < input.pins_end.size(); ++k) {
    if (tutu::is_finite(input.pins_start[k]) && tutu::is_finite(input.pins_end[k])) continue;
    nowhere.trouble = Trouble::bad_target;
    nowhere.particle = garment_->pins[k].particle;
    break;
  }
  nowhere.position = good_.positions[nowhere.particle];
  return nowhere;
}

std::optional<Unfinished> GuardedSolver::step(const FrameInput& input, proxies::CollisionQuery& query) {
  times_ = {};
  recovery_.reset();
  good_ = solver_->particles();
  if (!is_finite(input)) { // no solver and no collision query can make sense of it
    recovery_ = Recovery{nowhere(input), input.substeps};
    return recovery_->divergence;
  }
  const int refinement_before = refinement_;
  const auto stopped = [&](const std::optional<Unfinished>& end) {
    if (!end || divergence_of(end)) return false;
    solver_->restore(good_);
    recovery_.reset();
    refinement_ = refinement_before;
    return true;
  };
  auto end = attempt(input, query);
  if (stopped(end)) return end;
  if (!end) {
    stops_ = 0;
    if (refinement_ > 1 && ++calm_ >= k_calm_frames) {
      refinement_ /= 2;
      calm_ = 0;
    }
    return std::nullopt;
  }

  recovery_ = Recovery{*divergence_of(end), substeps_};
  Divergence& first = recovery_->divergence;
  if (!first.position.allFinite()) first.position = good_.positions[first.particle];
  const int most_substeps = std::max(k_most_recovery_substeps, 2 * input.substeps);
  FrameInput again = input;
  while (end && !recovery_->at_rest) {
    ++recovery_->tries;
    if (refinement_ < (1 << k_recovery_tries) && 2 * refinement_ * input.substeps <= most_substeps) {
      refinement_ *= 2;
      solver_->restore(good_);
    } else {
      recovery_->at_rest = true;
      jump(again);
    }
    end = attempt(again, query);
    if (stopped(end)) return end;
  }
  calm_ = 0;
  stops_ = recovery_->at_rest ? stops_ + 1 : 0;
  if (recovery_->at_rest) refinement_ = refinement_before; // it was not small steps that carried it
  recovery_->substeps = substeps_;
  recovery_->carried = !end && stops_ < k_stops_in_a_row;
  recovery_->worn_out = !end && !recovery_->carried;
  if (recovery_->carried) return std::nullopt;
  solver_->restore(good_);
  return recovery_->divergence;
}

} // namespace tutu::cloth
