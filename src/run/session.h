// A scene in motion: poses the body, follows it with colliders and pins, moves the garments, one frame at a time.
#pragma once

#include "cloth/adaptive_substeps.h"
#include "cloth/recovery.h"
#include "proxies/motion/collider_set.h"
#include "src/base/workers.h"
#include "src/run/garment_pins.h"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tutu::app {

/// Milliseconds of the last frame, a stage each.
struct FrameTimes {
  double pose = 0.0;    ///< sampling and forward kinematics
  double proxies = 0.0; ///< colliders and pins
  double broad = 0.0, cloth = 0.0, contact = 0.0;
  double skin = 0.0; ///< vertices of the body
  double total() const { return pose + proxies + broad + cloth + contact + skin; }
};

/// Why a session stopped.
struct SessionFailure {
  std::string garment;
  cloth::Divergence divergence;
  int frame = 0;
  double time = 0.0;     ///< s, of the substep
  int tries = 0;         ///< to take the frame again, all in vain,
  int last_substeps = 0; ///< the last with so many substeps a frame
  bool worn_out = false; ///< but for the last, as in so many frames before that this was the end: Recovery::worn_out
  int substeps = 0;      ///< a frame, of the first try; 0: not told

  /// One sentence: garment, frame, time, substep, what was found and where, what brought it about, tries.
  std::string message() const;
};

/// A frame that diverged and was carried after all.
struct SessionRecovery {
  std::string garment;
  cloth::Recovery recovery;
  int frame = 0;
  double time = 0.0; ///< s, of the substep that was bad first

  std::string message() const; ///< one sentence, with what was found first
};

/// What a session had to do beyond taking each frame as asked, since start().
struct SessionTroubles {
  int recoveries = 0;                            ///< frames of a garment
  std::vector<SessionRecovery> first_recoveries; ///< the first k_kept of them
  int teleports = 0;                             ///< frames that were taken for a jump
  int frames_split = 0;                          ///< into more substeps than asked
  cloth::SubstepPlan worst_split;                ///< of the frame with the most substeps, and
  int worst_split_frame = 0;                     ///< that frame,
  std::string worst_split_reason;                ///< in words

  static constexpr std::size_t k_kept = 16;
};

/// m/s. A joint that holds a garment and is faster than this has jumped: a cut in the clip, not a motion. Twice the
/// fastest kick of a human, and slow enough that adaptive substeps still follow what is below it.
inline constexpr double k_teleport_speed = 60.0;

/// The scene must outlive it. Drawing reads from it and never changes it. Garments do not meet each other, so that a
/// frame's may be stepped side by side; whatever the number of threads, the bits are the same.
class Session {
public:
  explicit Session(const Scene& scene);

  /// Back to time 0 (the clip's start); garments at rest at these positions, one vector a garment (world, m).
  void start(const GarmentPositions& garment_positions);

  /// Jumps to `time`: the body takes its pose there, and each garment is carried along rigidly with the joint that
  /// holds it and is at rest, so that the jump is never seen as a velocity. After a failure the start is carried there.
  void jump(double time);

  /// From now on a frame ends early once `*stop` is true, between two substeps: stopped(). Not owned; null: never.
  void stop_when(const std::atomic<bool>* stop) { stop_ = stop; }

  /// One frame of the clip. Does nothing once it has failed or was stopped. Where the joints that hold garments jump (a
  /// cut in the clip), garments are carried along as in jump().
  void advance();

  /// One frame towards a given pose (parent_from_joint), with more drag (1/s): how garments are draped.
  void advance_to(std::span<const Transform> local, double extra_drag);

  /// Skins the body at the present pose; adds to times().skin. Positions and normals are good until the next call.
  void skin_body();

  const Scene& scene() const { return *scene_; }
  int frame() const { return frame_; } ///< frames done since start()
  double frame_seconds() const { return scene_->settings.frame_seconds(); }
  double time() const { return start_time_ + frame_ * frame_seconds(); } ///< s since the clip's start
  const std::optional<SessionFailure>& failure() const { return failure_; }
  /// The last frame was not taken: frame() does not count it, garments are as at its start, while joints and colliders
  /// are already at its end. Not a failure; start() and jump() go on from it.
  bool stopped() const { return stopped_; }
  const SessionTroubles& troubles() const { return troubles_; }
  const FrameTimes& times() const { return times_; }
  std::span<const Transform> world_from_joint() const { return world_; }
  const proxies::ColliderSet& colliders() const { return colliders_; }
  const cloth::GuardedSolver& garment(int g) const { return garments_[g]; } ///< in the order of Scene::garments
  bool collides_with_body() const { return scene_->collides_with_body(); }
  /// Signed distance of a point from what garment `g` collided with last, at the pose of the frame's end. Only where
  /// it collides with the body, after a frame.
  proxies::Contact contact_with_body(int g, const Vec3& point) const {
    return queries_[g]->contact(point, proxies::SweptColliders{}.body_index());
  }
  std::span<const Vec3f> body_positions() const { return body_positions_; }
  std::span<const Vec3f> body_normals() const { return body_normals_; }
  std::string_view backend() const {
    return proxies::k_backend_names[static_cast<std::size_t>(scene_->settings.backend)];
  }
  int threads() const { return workers_.count(); }
  std::uint64_t state_hash() const;

private:
  void pose_at(double time);
  /// With the backend that collides with the true body: skins it at the present pose, which is the frame's end.
  void follow_body();
  /// The same where there is no motion: both ends of the frame.
  void reset_body();
  void place_pins(GarmentPositions& targets);
  /// The joint that carries a garment along when there is a jump.
  int holding_joint(std::size_t g) const;
  bool has_jumped() const;
  /// All garments rigidly from where their joints were to where they are, at rest.
  void carry_along(std::span<const Transform> before);
  void advance_garments(double extra_drag);
  /// What one garment takes from a frame; touches nothing of another's.
  struct GarmentFrame {
    cloth::SubstepPlan plan;
    double planning = 0.0; ///< ms
    std::optional<cloth::Unfinished> end;
  };
  void advance_garment(std::size_t g, double extra_drag);
  void note_garment(std::size_t g);
  void note_split(std::size_t g, const cloth::SubstepPlan& plan);

  const Scene* scene_;
  std::vector<Transform> local_, world_;
  GarmentPins pins_;
  proxies::ColliderSet colliders_;
  std::vector<std::unique_ptr<proxies::CollisionQuery>> queries_; ///< [garment]: one serves one thread
  std::vector<cloth::GuardedSolver> garments_;
  std::vector<GarmentFrame> garment_frames_; ///< [garment], the last
  Workers workers_;
  std::vector<double> friction_;     ///< of each collider, then the ground, then the true body
  GarmentPositions start_positions_; ///< of start(), and the joints then
  std::vector<Transform> start_world_;
  std::vector<Transform> world_before_;    ///< at the frame's start
  GarmentPositions pins_start_, pins_end_; ///< [garment][pin], world, m
  std::vector<rig::SkinMatrix> palette_;
  std::vector<Vec3f> body_positions_, body_normals_;
  std::vector<Vec3f> body_start_; ///< at the frame's start; with the backend mesh only, as is:
  std::vector<Vec3f> body_end_;
  FrameTimes times_;
  std::optional<SessionFailure> failure_;
  SessionTroubles troubles_;
  const std::atomic<bool>* stop_ = nullptr;
  bool stopped_ = false;
  bool frame_is_split_ = false;
  double start_time_ = 0.0;
  int frame_ = 0;
};

} // namespace tutu::app
