#include "src/study/bench/dancer_skirt.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

namespace tutu::app {
namespace {

constexpr double k_waist_height = 0.10, k_hem_height = -0.50; // in the pelvis frame
constexpr double k_waist_radius = 0.20, k_hem_radius = 0.42;

constexpr double k_pi = std::numbers::pi;

/// S(f, p) of the motion law: a swing of f Hz, phase p.
double swing(double f, double t, double p) { return std::sin(2.0 * k_pi * f * t + p); }

double thread_cpu_ms() {
  std::timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Takes proxies in the pelvis frame and puts them in the world, one after the other.
class ProxyWriter {
public:
  ProxyWriter(const Transform& world_from_pelvis, std::span<proxies::Capsule> out)
      : world_from_pelvis_(world_from_pelvis), out_(out) {}

  void capsule(const Vec3& a, const Vec3& b, double radius) {
    out_[next_++] = {world_from_pelvis_ * a, world_from_pelvis_ * b, radius};
  }
  void sphere(const Vec3& centre, double radius) { capsule(centre, centre, radius); }

private:
  const Transform& world_from_pelvis_;
  std::span<proxies::Capsule> out_;
  std::size_t next_ = 0;
};

/// The left limbs are on +X; the right ones swing half a period later.
struct Side {
  double sx, phase;
};
constexpr std::array<Side, 2> k_sides = {Side{1.0, 0.0}, Side{-1.0, k_pi}};

struct Leg {
  Vec3 hip, knee, ankle, toe;
};

Leg leg_at(const Side& side, double t, double w) {
  constexpr double k_spread = 0.10; // rad that a thigh stands out sideways
  constexpr double k_step_rate = 0.75;
  const double thigh = w * (0.15 + 0.75 * swing(k_step_rate, t, side.phase));
  const double bend = 0.5 * w * (1.0 - std::cos(2.0 * k_pi * k_step_rate * t + side.phase));
  Leg leg;
  leg.hip = {0.10 * side.sx, -0.05, 0.0};
  leg.knee = leg.hip + 0.42 * Vec3(side.sx * std::sin(k_spread), -std::cos(k_spread) * std::cos(thigh),
                                   std::cos(k_spread) * std::sin(thigh));
  leg.ankle = leg.knee + 0.40 * Vec3(0.0, -std::cos(thigh - bend), std::sin(thigh - bend));
  leg.toe = leg.ankle + Vec3(0.0, -0.04, 0.14);
  return leg;
}

void add_torso(ProxyWriter& writer) {
  const std::array<Vec3, 4> corners = {Vec3(0.08, 0.0, 0.0), Vec3(-0.08, 0.0, 0.0), Vec3(0.09, 0.36, 0.0),
                                       Vec3(-0.09, 0.36, 0.0)};
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = i + 1; j < corners.size(); ++j) writer.capsule(corners[i], corners[j], 0.11);
}

void add_leg(ProxyWriter& writer, const Leg& leg) {
  constexpr double k_radius = 0.07;
  writer.capsule(leg.hip, leg.knee, k_radius);
  writer.capsule(leg.knee, leg.ankle, k_radius);
  writer.capsule(leg.ankle, leg.toe, k_radius);
}

void add_arm(ProxyWriter& writer, const Side& side, double t, double w) {
  constexpr double k_radius = 0.045;
  const double lift = w * swing(1.0, t, side.phase);
  const Vec3 shoulder(0.19 * side.sx, 0.40, 0.0);
  const Vec3 elbow(0.42 * side.sx, 0.34 + 0.05 * lift, 0.0);
  const Vec3 wrist(0.60 * side.sx, 0.45 + 0.12 * lift, 0.05);
  writer.capsule(shoulder, elbow, k_radius);
  writer.capsule(elbow, wrist, k_radius);
  writer.capsule(wrist, wrist + Vec3(0.08 * side.sx, 0.03, 0.0), k_radius);
}

/// The scene gives a shape and a mass; the rest is this solver's choice. Stretch holds the hanging weight (2.3 N per
/// metre of waist) at 0.6 %; shear is low and bending free, since the cloth
/// of the scene is only its grid edges.
cloth::Fabric skirt_fabric() {
  cloth::Fabric fabric;
  fabric.stretch = 400.0;
  fabric.shear = 6.0;
  fabric.bend = 0.0;
  fabric.bend_springs = 0.5;
  fabric.drag = 0.5;
  fabric.thickness = 0.004;
  return fabric;
}

} // namespace

double motion_weight(double t, DancerMotion motion) {
  if (motion == DancerMotion::still) return 0.0;
  const double u = std::clamp(t, 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

Transform dancer_pelvis(double t, DancerMotion motion) {
  const double w = motion_weight(t, motion);
  const double yaw = 0.8 * w * swing(0.5, t, 0.0), roll = 0.12 * w * swing(1.0, t, 0.0);
  Transform world_from_pelvis;
  world_from_pelvis.translation = {0.10 * w * swing(0.5, t, 0.0), 1.0 + 0.02 * w * swing(1.0, t, 0.0),
                                   0.05 * w * swing(0.25, t, 0.0)};
  world_from_pelvis.rotation =
      Quat(Eigen::AngleAxisd(yaw, Vec3::UnitY())) * Quat(Eigen::AngleAxisd(roll, Vec3::UnitZ()));
  return world_from_pelvis;
}

void pose_dancer(double t, DancerMotion motion, std::span<proxies::Capsule> out) {
  const double w = motion_weight(t, motion);
  const Transform world_from_pelvis = dancer_pelvis(t, motion);
  ProxyWriter writer(world_from_pelvis, out);
  const std::array<Leg, 2> legs = {leg_at(k_sides[0], t, w), leg_at(k_sides[1], t, w)};

  add_torso(writer);
  for (const Leg& leg : legs) add_leg(writer, leg);
  for (const Side& side : k_sides) add_arm(writer, side, t, w);
  writer.capsule({0.0, 0.46, 0.0}, {0.0, 0.56, 0.0}, 0.05);
  writer.capsule({0.0, 0.62, 0.0}, {0.0, 0.70, 0.01}, 0.09);

  for (const Side& side : k_sides) writer.sphere({0.07 * side.sx, -0.06, -0.06}, 0.11);
  writer.sphere({0.0, 0.06, 0.04}, 0.11);
  writer.sphere({0.0, 0.28, -0.04}, 0.10);
  for (const Side& side : k_sides) writer.sphere({0.08 * side.sx, 0.28, 0.08}, 0.07);
  for (const Leg& leg : legs) writer.sphere(leg.knee, 0.08);
}

cloth::Garment dancer_skirt(int n) {
  // At t = 0 the pelvis frame is the world's, moved.
  const Vec3 pelvis = dancer_pelvis(0.0, DancerMotion::dance).translation;
  cloth::TubeShape tube;
  tube.rows = tube.columns = n;
  tube.rings = {{pelvis.y() + k_waist_height, k_waist_radius, k_waist_radius, pelvis.x(), pelvis.z()},
                {pelvis.y() + k_hem_height, k_hem_radius, k_hem_radius, pelvis.x(), pelvis.z()}};
  cloth::GarmentDescription description;
  description.name = "skirt";
  description.shape = tube;
  description.fabric = skirt_fabric();
  description.attachments = {{"pelvis", 0, 0, 0, -1}};
  cloth::Garment skirt = cloth::build_garment(description);
  skirt.masses.assign(skirt.masses.size(), k_dancer_skirt_mass / skirt.particle_count());
  return skirt;
}

void dancer_pins(const cloth::Garment& skirt, double t, DancerMotion motion, std::span<Vec3> out) {
  const Transform moved = dancer_pelvis(t, motion) * dancer_pelvis(0.0, motion).inverse();
  for (std::size_t k = 0; k < skirt.pins.size(); ++k) out[k] = moved * skirt.rest_positions[skirt.pins[k].particle];
}

int default_substeps(cloth::SolverKind solver, int n) {
  const double at_thirty = solver == cloth::SolverKind::xpbd ? 2.34 : 32.0;
  return static_cast<int>(std::ceil(at_thirty * n / 30.0));
}

DancerSkirt::DancerSkirt(const DancerSkirtSetup& setup)
    : setup_(setup), skirt_(std::make_unique<const cloth::Garment>(dancer_skirt(setup.n))),
      solver_(cloth::make_solver(*skirt_, setup)), query_(proxies::make_query(setup.backend)),
      pins_start_(skirt_->pins.size()), pins_end_(skirt_->pins.size()) {
  pose_dancer(0.0, setup_.motion, proxies_end_);
  dancer_pins(*skirt_, 0.0, setup_.motion, pins_end_);
  if (setup_.uneven_mm == 0.0) return;
  std::vector<Vec3> start = skirt_->rest_positions;
  std::mt19937_64 random(static_cast<std::uint64_t>(setup_.seed));
  cloth::make_uneven(*skirt_, 1e-3 * setup_.uneven_mm, random, start);
  solver_->reset(start);
}

std::optional<cloth::Divergence> DancerSkirt::advance() {
  const double before = thread_cpu_ms();
  const double end = static_cast<double>(frame_ + 1) / k_dancer_frames_per_second;
  proxies_start_ = proxies_end_;
  pose_dancer(end, setup_.motion, proxies_end_);
  pins_start_.swap(pins_end_);
  dancer_pins(*skirt_, end, setup_.motion, pins_end_);

  cloth::FrameInput input;
  input.colliders = {proxies_start_, proxies_end_, std::nullopt};
  input.pins_start = pins_start_;
  input.pins_end = pins_end_;
  static const std::array<double, k_dancer_proxies + 1> friction = [] {
    std::array<double, k_dancer_proxies + 1> all{};
    all.fill(k_dancer_friction);
    return all;
  }();
  input.friction = friction;
  input.seconds = 1.0 / k_dancer_frames_per_second;
  input.substeps = setup_.substeps;
  const auto unfinished = solver_->step(input, *query_);
  cpu_ms_ = thread_cpu_ms() - before;
  if (!unfinished) ++frame_;
  return unfinished ? std::optional(*cloth::divergence_of(unfinished)) : std::nullopt; // nobody asks it to stop
}

} // namespace tutu::app
