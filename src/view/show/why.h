// Why a particle is where it is: what it touches, what pulls on it, and when it first went wrong.
#pragma once

#include "src/run/frame_state.h"

#include <nlohmann/json.hpp>

namespace tutu::app {

/// A particle counts as wrong when one of its springs is longer than at rest by more than this, or when it is inside a
/// collider by more than k_inside_depth (cloth_depths.h).
inline constexpr double k_wrong_longer = 0.10;

struct WhyContact {
  std::string collider;  ///< a proxy's name, or "ground"
  double distance = 0.0; ///< m, signed, at the frame's end
  double depth = 0.0;    ///< m, >= 0: nearer than the garment's gap by so much
  Vec3 normal = Vec3::UnitY();
  /// What the collider did to it in the frame, taken as one step: from its last place, with its last velocity and
  /// gravity, it would have come to x* = x + h v + h^2 g. Of the whole frame; solvers take it in substeps, between
  /// which constraints pull as well. 0 without a frame before.
  double projection = 0.0; ///< m, >= 0: x* was nearer to the collider's end pose than the gap by so much
  double cancelled = 0.0;  ///< m/s, >= 0: of v + h g against the surface's own motion, what went into it
};

struct WhyConstraint {
  cloth::SpringKind kind = cloth::SpringKind::structural;
  int other = 0;       ///< the particle at its other end
  double rest = 0.0;   ///< m
  double length = 0.0; ///< m
  double strain() const { return length / rest - 1.0; }
};

/// The first frame of a recording in which a particle went wrong.
struct FirstWrong {
  int frame = 0;
  std::string what;   ///< "longer", or the collider it was inside of
  double value = 0.0; ///< strain, or depth in m
};

struct Why {
  std::string garment;
  int particle = 0, frame = 0;
  double time = 0.0; ///< s
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
  bool pinned = false;
  std::vector<WhyContact> contacts;       ///< within the gap and k_touch_slack, or met on the way; nearest first
  std::vector<WhyConstraint> constraints; ///< the longest beside its rest length first
  std::optional<FirstWrong> first_wrong;
};

/// `before`: the frame before `now`, or null. first_wrong is left empty.
Why explain(const Scene& scene, std::size_t garment, int particle, const FrameState& now, const FrameState* before);

/// What is wrong with the particle in this frame: the deeper collider before the longer thread.
std::optional<FirstWrong> wrong_in(const Scene& scene, std::size_t garment, int particle, const FrameState& now);

nlohmann::json json_of(const Why& why); ///< lengths in mm where the name says so

/// The same for a person, a line each.
std::vector<std::string> text_of(const Why& why);

/// What a proxy does to the garments in a frame.
struct WhyProxy {
  std::string name;
  int frame = 0;
  double speed = 0.0;                  ///< m/s, of the end of its axis that goes farther in the frame
  int touching = 0;                    ///< particles of all garments (find_touches)
  std::string garment;                 ///< of the particle that is deepest in the garment's gap; "" when none is
  int particle = -1;                   ///< that one
  double depth = 0.0;                  ///< m, > 0 where there is one
  std::vector<std::string> ignored_by; ///< garments
};
WhyProxy explain_proxy(const Scene& scene, int collider, const FrameState& now);
nlohmann::json json_of(const WhyProxy& why);
std::vector<std::string> text_of(const WhyProxy& why);

/// "skirt:12@340": a particle of a garment in a frame.
struct WhyAddress {
  std::size_t garment = 0;
  int particle = 0, frame = 0;
};
/// Throws InputError where there is none such, up to frame `most`.
WhyAddress why_address(const Scene& scene, const std::string& text, int most);

} // namespace tutu::app
