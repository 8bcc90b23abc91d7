// Garments on a character that somebody else moves: what an engine calls each frame. No clip, no files, no window.
//
//   Runtime runtime(wearer);                    // a Wearer from descriptions in memory, or load_scene()
//   runtime.start(joints, drape(...).positions);
//   every frame:  runtime.step(joints, seconds); ... runtime.positions(g) ... runtime.normals(g, out)
//
// World space: y up, m, kg, s. Joints are world_from_joint transforms in the order of Skeleton's joints.
#pragma once

#include "cloth/adaptive_substeps.h"
#include "cloth/recovery.h"
#include "proxies/motion/collider_set.h"
#include "src/base/workers.h"
#include "src/run/garment_pins.h"

#include <atomic>
#include <memory>
#include <optional>
#include <span>
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

/// Why a run stopped.
struct RunFailure {
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
struct RunRecovery {
  std::string garment;
  cloth::Recovery recovery;
  int frame = 0;
  double time = 0.0; ///< s, of the substep that was bad first

  std::string message() const; ///< one sentence, with what was found first
};

/// What had to be done beyond taking each frame as asked, since start().
struct RunTroubles {
  int recoveries = 0;                        ///< frames of a garment
  std::vector<RunRecovery> first_recoveries; ///< the first k_kept of them
  int teleports = 0;                         ///< frames that were taken for a jump
  int frames_split = 0;                      ///< into more substeps than asked
  cloth::SubstepPlan worst_split;            ///< of the frame with the most substeps,
  int worst_split_frame = 0;                 ///< that frame, and
  int worst_split_garment = 0;               ///< whose it was

  static constexpr std::size_t k_kept = 16;
};

/// m/s. A joint that holds a garment and is faster than this has jumped: a cut in the motion, not a motion. Twice the
/// fastest kick of a human, and slow enough that adaptive substeps still follow what is below it.
inline constexpr double k_teleport_speed = 60.0;

/// s; no frame is longer: after a hitch an engine takes several, or jumps.
inline constexpr double k_longest_frame = 1.0;

/// The wearer must outlive it. Garments do not meet each other, so that a frame's may be stepped side by side; whatever
/// the number of threads, the bits are the same. A frame without trouble allocates nothing.
class Runtime {
public:
  /// In the rest pose, garments as they are built.
  explicit Runtime(const Wearer& wearer);

  /// At `time`, with the joints there; garments at rest at these positions, one vector a garment (world, m).
  void start(std::span<const Transform> world_from_joint, const GarmentPositions& garment_positions, double time = 0.0);

  /// Jumps: the joints are there, and each garment is carried along rigidly with the joint that holds it and is at
  /// rest, so that the jump is never seen as a velocity. After a failure the start is carried there.
  void jump(std::span<const Transform> world_from_joint, double time);

  /// One frame of `seconds`, at whose end the joints are there; with more drag (1/s) where garments are to settle. In
  /// as many substeps as the settings ask for in the same time. Where the joints that hold garments are too fast for
  /// any motion, garments are carried along as in jump(). Does nothing once it has failed or was stopped. Throws
  /// std::invalid_argument for another number of joints, and for seconds not above 0 or above k_longest_frame.
  void step(std::span<const Transform> world_from_joint, double seconds, double extra_drag = 0.0);

  /// From now on, in place of the wearer's. Throws std::invalid_argument for a wind, or gusts, beyond
  /// cloth::k_fastest_wind, and for gusts shorter than cloth::k_shortest_gust.
  void set_wind(const cloth::Wind& wind);

  /// From now on a frame ends early once `*stop` is true, between two substeps: stopped(). Not owned; null: never.
  void stop_when(const std::atomic<bool>* stop) { stop_ = stop; }

  /// Of garment `g` in the order of Wearer::garments, world, m, a particle each. Good until the next step.
  std::span<const Vec3> positions(int g) const { return garments_[g].particles().positions; }
  /// Unit normals of its vertices, a particle each: those of its triangles, weighted by area. +Y where there are none.
  void normals(int g, std::span<Vec3> out) const;

  /// Skins the body at the present pose; adds to times().skin. Positions and normals are good until the next call.
  void skin_body();

  int frame() const { return frame_; }                                             ///< frames done since start()
  double time() const { return start_time_ + (frame_ - start_frame_) * seconds_; } ///< s
  const std::optional<RunFailure>& failure() const { return failure_; }
  /// The last frame was not taken: frame() does not count it, garments are as at its start, while joints and colliders
  /// are already at its end. Not a failure; start() and jump() go on from it.
  bool stopped() const { return stopped_; }
  const RunTroubles& troubles() const { return troubles_; }
  std::string worst_split_reason() const; ///< in words; "" where no frame was split
  const FrameTimes& times() const { return times_; }
  std::span<const Transform> world_from_joint() const { return world_; }
  const proxies::ColliderSet& colliders() const { return colliders_; }
  /// Those that garment `g` meets; the others are ignored.
  proxies::SweptColliders colliders_of(int g) const {
    proxies::SweptColliders colliders = colliders_.swept();
    colliders.ignored = ignored_[g];
    return colliders;
  }
  const cloth::GuardedSolver& garment(int g) const { return garments_[g]; }
  bool collides_with_body() const { return wearer_->collides_with_body(); }
  /// Signed distance of a point from what garment `g` collided with last, at the pose of the frame's end. Only where
  /// it collides with the body, after a frame.
  proxies::Contact contact_with_body(int g, const Vec3& point) const {
    return queries_[g]->contact(point, proxies::SweptColliders{}.body_index());
  }
  std::span<const Vec3f> body_positions() const { return body_positions_; }
  std::span<const Vec3f> body_normals() const { return body_normals_; }
  std::string_view backend() const {
    return proxies::k_backend_names[static_cast<std::size_t>(wearer_->settings.backend)];
  }
  int threads() const { return workers_.count(); }
  std::uint64_t state_hash() const;

protected:
  FrameTimes times_;

private:
  void set_pose(std::span<const Transform> world_from_joint);
  void count_from(double time, double seconds);
  /// With the backend that collides with the true body: skins it at the present pose, which is the frame's end.
  void follow_body();
  /// The same where there is no motion: both ends of the frame.
  void reset_body();
  void place_pins(GarmentPositions& targets);
  /// Nothing has moved: both ends of the frame are the present pose.
  void stand_still();
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

  const Wearer* wearer_;
  std::vector<Transform> world_;
  GarmentPins pins_;
  proxies::ColliderSet colliders_;
  std::vector<std::vector<std::uint8_t>> ignored_;                ///< [garment][collider] (met_colliders.h)
  std::vector<std::unique_ptr<proxies::CollisionQuery>> queries_; ///< [garment]: one serves one thread
  std::vector<cloth::GuardedSolver> garments_;
  std::vector<GarmentFrame> garment_frames_; ///< [garment], the last
  cloth::Wind wind_;
  Vec3 wind_start_ = Vec3::Zero(), wind_end_ = Vec3::Zero(); ///< of the frame, m/s
  Workers workers_;
  std::vector<double> friction_;     ///< of each collider, then the ground, then the true body
  GarmentPositions start_positions_; ///< of start(), and the joints then
  std::vector<Transform> start_world_;
  std::vector<Transform> world_before_;    ///< at the frame's start
  GarmentPositions pins_start_, pins_end_; ///< [garment][pin], world, m
  std::vector<Vec3> carried_;
  std::vector<rig::SkinMatrix> palette_;
  std::vector<Vec3f> body_positions_, body_normals_;
  std::vector<Vec3f> body_start_; ///< at the frame's start; with the backend mesh only, as is:
  std::vector<Vec3f> body_end_;
  std::optional<RunFailure> failure_;
  RunTroubles troubles_;
  const std::atomic<bool>* stop_ = nullptr;
  bool stopped_ = false;
  bool frame_is_split_ = false;
  double start_time_ = 0.0; ///< s, of frame start_frame_,
  int start_frame_ = 0;     ///< since when all frames
  double seconds_ = 0.0;    ///< have been of this length, s
  int substeps_ = 0;        ///< asked for in a frame of it
  int frame_ = 0;
};

} // namespace tutu::app
