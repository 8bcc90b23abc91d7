#include "cloth/xpbd.h"

#include "cloth/air/air.h"
#include "cloth/contact/self_collision.h"
#include "cloth/contact/triangle_contacts.h"
#include "cloth/damping.h"
#include "cloth/detail/solver_parts.h"
#include "cloth/detail/woven_seams.h"
#include "cloth/garment/elements.h"
#include "cloth/state/tolerances.h"
#include "cloth/woven/contacts.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace tutu::cloth {
namespace {

template <class T> class Xpbd final : public Solver {
public:
  Xpbd(const Garment& garment, const SolverOptions& options)
      : garment_(&garment), kernel_(woven_kernel<T>()), sheet_(garment, options.passes > 1), passes_(options.passes),
        pinned_(pinned_flags(garment)), damping_(garment), seams_(garment), contacts_(garment, options, sheet_),
        search_(garment, options.swept), triangle_search_(garment, options) {
    if (options.self_collision) {
      self_ = std::make_unique<SelfCollision>(garment);
      start_.resize(garment.rest_positions.size());
      now_.resize(garment.rest_positions.size());
    }
    reset(garment.rest_positions);
  }

  void reset(std::span<const Vec3> positions) override {
    particles_.positions.assign(positions.begin(), positions.end());
    particles_.velocities.assign(positions.size(), Vec3::Zero());
    restore(particles_);
  }

  void restore(const Particles& state) override {
    if (&state != &particles_) particles_ = state;
    in_step_ = true;
    pins_.clear();
    sheet_.set(particles_.positions, particles_.velocities);
    contacts_.forget();
    search_.forget();
    if (self_) self_->forget();
    unusable_ = find_unusable(*garment_, pinned_, particles_);
  }

  std::optional<Unfinished> step(const FrameInput& input, proxies::CollisionQuery& query) override;

  /// Put together when asked for.
  const Particles& particles() const override {
    if (!in_step_) {
      sheet_.get(particles_);
      for (std::size_t k = 0; k < pins_.size(); ++k) particles_.positions[garment_->pins[k].particle] = pins_[k];
    }
    in_step_ = true;
    return particles_;
  }
  const SolverTimes& times() const override { return times_; }
  ContactCounts contact_counts() const override {
    return asks_each_ ? search_.counts() + triangle_search_.counts() : contacts_.counts();
  }
  BroadPhaseView broad_phase() const override { return asks_each_ ? search_.broad_phase() : contacts_.broad_phase(); }
  SelfCollisionCounts self_collision_counts() const override { return self_ ? self_->counts() : SelfCollisionCounts{}; }

private:
  void follow_pins(const FrameInput& input, double s, double h);
  void slow_down(const FrameInput& input, double s, double h);
  bool part_layers(double h);
  void ask_each(proxies::CollisionQuery& query, double s, double h);
  /// A substep: its number, its end in (0, 1] of the frame, and what the kernel is told of it.
  struct Substep {
    int number = 0;
    double s = 0.0, h = 0.0; ///< h in s
    const WovenStep<T>& step;
  };
  Divergence diverged(const FrameInput& input, const Substep& at, std::optional<double> speed = std::nullopt);
  Divergence diverged_in_constraints(const FrameInput& input, const Substep& at);
  Divergence diverged_at_end(const FrameInput& input, const Substep& at, bool predicted);
  void end_at(const FrameInput& input, double s);

  const Garment* garment_;
  WovenKernel<T> kernel_;
  WovenSheet<T> sheet_;
  int passes_ = 1;
  std::vector<std::uint8_t> pinned_;
  Damping damping_;
  WovenSeams<T> seams_;
  WovenContacts<T> contacts_;           ///< of whole vectors, where the backend leaves contacts to us
  ContactSearch search_;                ///< else, and
  TriangleContacts triangle_search_;    ///< between particles
  bool asks_each_ = false;              ///< it is else
  std::optional<Divergence> unusable_;  ///< of the state that was restored last
  std::vector<Vec3> pins_;              ///< where they are to the last bit; none before the first frame
  std::unique_ptr<SelfCollision> self_; ///< where asked for, with
  std::vector<Vec3> start_, now_;       ///< room for the positions it works on
  mutable Particles particles_;         ///< room for what particles() shows
  mutable bool in_step_ = false;        ///< with the sheet
  SolverTimes times_;
};

template <class T> void Xpbd<T>::follow_pins(const FrameInput& input, double s, double h) {
  for (std::size_t k = 0; k < garment_->pins.size(); ++k)
    sheet_.pin_to(garment_->pins[k].particle, (1.0 - s) * input.pins_start[k] + s * input.pins_end[k], h);
}

/// The air, in the substep that begins at `s` of the frame.
template <class T> void Xpbd<T>::slow_down(const FrameInput& input, double s, double h) {
  const AirInStep<proxies::PlainArithmetic> plain = air_in_step(*garment_->fabric.air, input.wind_at(s), h);
  WovenAir<T> air{static_cast<T>(plain.pressure), static_cast<T>(plain.lift), static_cast<T>(plain.friction)};
  for (int axis = 0; axis < 3; ++axis) air.wind[axis] = static_cast<T>(plain.wind[axis]);
  kernel_.air(sheet_.view(), air);
}

/// Self-collision. Returns false when a particle's place is no number.
template <class T> bool Xpbd<T>::part_layers(double h) {
  sheet_.get_starts(start_);
  sheet_.get_positions(now_);
  if (!self_->resolve(start_, now_, h)) return false;
  for (const int i : self_->moved()) sheet_.move_to(i, now_[i]);
  seams_.join(sheet_);
  return true;
}

/// Each particle by way of the query, and what lies between them, in double: the plain form of contact, for the
/// backends that have no other.
template <class T> void Xpbd<T>::ask_each(proxies::CollisionQuery& query, double s, double h) {
  sheet_.get_positions(particles_.positions);
  search_.for_each_contact(
      query, s, pinned_, particles_,
      [&](int i, int collider, const proxies::Contact& contact, double push) {
        std::vector<Vec3>& x = particles_.positions;
        const Vec3 out = search_.way_out(x[i], sheet_.start_position(i), collider, contact, push);
        const Vec3 moved = search_.fitted(i, out, x);
        x[i] += moved;
        sheet_.move_to(i, x[i]);
        return Response{moved, moved / h};
      },
      [&](int i, const BetweenColliders::Settled& settled) {
        Vec3& x = particles_.positions[i];
        x += settled.way;
        sheet_.move_to(i, x);
        sheet_.move_start_to(i, sheet_.start_position(i) + settled.start);
        return Response{settled.way, (settled.way - settled.start) / h};
      });
  triangle_search_.for_each_contact(query, search_, particles_, [&](const ClothContact& contact) {
    const Vec3 moved = push_out(contact, search_, search_.way().starts, particles_.positions);
    for (const int i : contact.particles) sheet_.move_to(i, particles_.positions[i]);
    return Response{moved, moved / h};
  });
}

/// From here on particles() shows the sheet, with pins to the last bit.
template <class T> void Xpbd<T>::end_at(const FrameInput& input, double s) {
  pins_.assign(input.pins_end.begin(), input.pins_end.end());
  for (std::size_t k = 0; s < 1.0 && k < pins_.size(); ++k)
    pins_[k] = (1.0 - s) * input.pins_start[k] + s * input.pins_end[k];
  in_step_ = false;
}

/// What is wrong with the sheet as it is. `speed`: of what is too fast, where it no longer shows.
template <class T>
Divergence Xpbd<T>::diverged(const FrameInput& input, const Substep& at, std::optional<double> speed) {
  end_at(input, at.s);
  std::vector<Vec3> starts(garment_->rest_positions.size());
  sheet_.get_starts(starts);
  const std::vector<Tether> tethers = sheet_.view().tethers.length ? build_tethers(*garment_) : std::vector<Tether>{};
  const double rounding = std::is_same_v<T, float> ? 1e-4 : 1e-9; // pins are shown to the last bit, and solved in T
  const Moment now{*garment_, pinned_, at.number, at.h, particles(), speed ? std::span<const Vec3>{} : starts};
  return find_trouble(now, {true, false, rounding, tethers}, speed);
}

/// The constraints change what they measure: they are solved once more, from where they began, to where they met the
/// first broken edge.
template <class T> Divergence Xpbd<T>::diverged_in_constraints(const FrameInput& input, const Substep& at) {
  kernel_.predict_again(sheet_.view(), at.step);
  follow_pins(input, at.s, at.h);
  seams_.join(sheet_);
  sheet_.get_positions(particles_.positions);
  const bool all_numbers = std::all_of(particles_.positions.begin(), particles_.positions.end(),
                                       [](const Vec3& p) { return p.allFinite(); });
  if (all_numbers) { // else what is none would only spread
    std::vector<T> room(static_cast<std::size_t>(6 * sheet_.view().block_stride));
    kernel_.constraints_to_break(sheet_.view(), at.step, room.data());
  }
  return diverged(input, at);
}

/// Contacts sent a particle away, which was noticed when velocities were found and perhaps the next step predicted:
/// where the substep ended is then what that one started from, and where it began is lost.
template <class T> Divergence Xpbd<T>::diverged_at_end(const FrameInput& input, const Substep& at, bool predicted) {
  if (!predicted) return diverged(input, at);
  sheet_.take_back();
  for (std::size_t k = 0; k < garment_->pins.size(); ++k)
    sheet_.set_velocity(garment_->pins[k].particle, (input.pins_end[k] - input.pins_start[k]) / input.seconds);
  return diverged(input, at, contacts_.fastest());
}

template <class T> std::optional<Unfinished> Xpbd<T>::step(const FrameInput& input, proxies::CollisionQuery& query) {
  times_ = {};
  if (unusable_) return *unusable_;
  auto time = Clock::now();
  asks_each_ = !query.leaves_contacts();
  sheet_.follow();
  if (asks_each_) {
    search_.begin_frame(query, input, particles());
    triangle_search_.begin_frame(query, search_, particles());
  } else {
    contacts_.begin_frame(query, input, sheet_);
  }
  time = lap(time, times_.broad);
  if (input.is_stopped()) return Stopped{0};

  const WovenSheetView<T>& view = sheet_.view();
  const double h = input.seconds / input.substeps;
  const bool has_air = garment_->fabric.air.has_value();
  WovenStep<T> step;
  step.h = static_cast<T>(h);
  for (int axis = 0; axis < 3; ++axis) step.gravity[axis] = static_cast<T>(input.gravity[axis]);
  step.kept = static_cast<T>(1.0 / (1.0 + h * (garment_->fabric.drag + input.extra_drag)));
  const DampedStep damped = damping_.at(h);
  step.taken = static_cast<T>(damped.taken);
  step.elastic = static_cast<T>(damped.elastic);
  step.fastest = static_cast<T>(k_fastest_particle);
  step.passes = passes_;
  if (has_air) slow_down(input, 0.0, h);
  kernel_.predict(view, step);
  for (int substep = 0; substep < input.substeps; ++substep) {
    const double s = static_cast<double>(substep + 1) / input.substeps;
    const Substep at{substep, s, h, step};
    follow_pins(input, s, h);
    seams_.join(sheet_); // both sides start the threads together, so that neither is torn off
    const bool whole = kernel_.constraints(view, step);
    seams_.close(sheet_);
    time = lap(time, times_.cloth);
    if (!whole) return diverged_in_constraints(input, at);
    if (self_ && !part_layers(h)) return diverged(input, at);
    if (asks_each_) {
      sheet_.get_positions(particles_.positions);
      if (!is_in_world(particles_)) return diverged(input, at);
      ask_each(query, s, h);
    } else if (!contacts_.resolve(query, kernel_, sheet_, s, h)) {
      return diverged(input, at);
    }
    time = lap(time, times_.contact);
    // The last substep's velocities are the frame's; those before are used up by the next prediction at once.
    const bool is_end = substep + 1 == input.substeps, is_last = is_end || input.is_stopped();
    const bool predicts = !is_last && !has_air; // the air needs them all
    if (!contacts_.finish(predicts ? kernel_.finish_and_predict : kernel_.finish, view, step))
      return diverged_at_end(input, at, predicts);
    if (!is_last && has_air) {
      slow_down(input, s, h);
      kernel_.predict(view, step);
    }
    time = lap(time, times_.cloth);
    if (!is_last) continue;
    end_at(input, s);
    if (!is_end) return Stopped{substep + 1};
  }
  return std::nullopt;
}

} // namespace

std::unique_ptr<Solver> make_xpbd(const Garment& garment, const SolverOptions& options) {
  if (options.double_precision) return std::make_unique<Xpbd<double>>(garment, options);
  return std::make_unique<Xpbd<float>>(garment, options);
}

} // namespace tutu::cloth
