#include "src/study/bench/stability_scenes.h"

#include "cloth/garment/uneven.h"
#include "src/study/bench/mesh_sheet.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <random>

namespace tutu::app {
namespace {

using proxies::Capsule;

constexpr double k_pi = std::numbers::pi;

/// A fabric as garments have it; the air takes more, so that what is to come to rest does so within seconds.
cloth::Fabric stage_fabric() {
  cloth::Fabric fabric;
  fabric.drag = 2.0;
  return fabric;
}

constexpr double k_irregular = 0.25; // of a side

/// A square of n x n particles, or about as many, from `corner` along `across` and `down`. Nothing holds it.
cloth::GarmentDescription sheet(int n, const Vec3& corner, const Vec3& across, const Vec3& down, Weave weave) {
  cloth::GarmentDescription description;
  description.name = "sheet";
  description.fabric = stage_fabric();
  if (weave == Weave::mesh) description.shape = mesh_sheet(n - 1, corner, across, down, k_irregular);
  else description.shape = cloth::GridShape{n, n, corner, across, down};
  return description;
}

/// The same in the plane z = 0, about x = 0, hanging down from `top`; the first row is held.
cloth::Garment hanging_sheet(int n, double size, double top, Weave weave) {
  cloth::GarmentDescription description = sheet(n, {-0.5 * size, top, 0}, Vec3(size, 0, 0), Vec3(0, -size, 0), weave);
  cloth::Attachment& upper = description.attachments.emplace_back("stage");
  upper.last_column = -1;
  if (weave == Weave::mesh) upper.above = top;
  return cloth::build_garment(description);
}

const char* suffix_of(Weave weave) { return weave == Weave::mesh ? "-mesh" : ""; }

struct TubeEnds {
  double top, top_radius, bottom, bottom_radius;
};

/// `columns` around the axis x = z = 0, or about as many; its upper end is held, or both are.
cloth::Garment tube(int rows, int columns, const TubeEnds& ends, bool both_held, Weave weave,
                    double bend = cloth::Fabric().bend) {
  cloth::GarmentDescription description;
  description.name = "tube";
  description.fabric = stage_fabric();
  description.fabric.bend = bend;
  cloth::Attachment upper{"stage"}, lower{"stage", -1, -1};
  if (weave == Weave::mesh) {
    const double length = (rows - 1) * std::sqrt(0.75) / columns; // of near to equilateral triangles
    description.shape = mesh_tube(columns, length, k_irregular, [&](double u, double v) {
      const double radius = std::lerp(ends.top_radius, ends.bottom_radius, v), angle = 2.0 * k_pi * u;
      return Vec3(radius * std::sin(angle), std::lerp(ends.top, ends.bottom, v), radius * std::cos(angle));
    });
    upper.above = ends.top;
    lower.within = cloth::Attachment::Ball{{0, ends.bottom, 0}, ends.bottom_radius + 1e-6};
  } else {
    cloth::TubeShape shape;
    shape.rows = rows;
    shape.columns = columns;
    shape.rings = {{ends.top, ends.top_radius, ends.top_radius, 0, 0},
                   {ends.bottom, ends.bottom_radius, ends.bottom_radius, 0, 0}};
    description.shape = shape;
  }
  description.attachments = {upper};
  if (both_held) description.attachments.push_back(lower);
  return cloth::build_garment(description);
}

std::vector<Vec3> pins_at_rest(const cloth::Garment& garment) {
  std::vector<Vec3> pins;
  for (const cloth::Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
  return pins;
}

/// At rest, the free particles off by up to k_stability_uneven.
std::vector<Vec3> uneven(const cloth::Garment& garment, std::mt19937_64& random) {
  std::vector<Vec3> positions = garment.rest_positions;
  cloth::make_uneven(garment, k_stability_uneven, random, positions);
  return positions;
}

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Goes from 0 to 1 between the times, at constant speed.
double ramp(double t, double from, double to) { return std::clamp((t - from) / (to - from), 0.0, 1.0); }
/// The same, starting and ending softly.
double soft_ramp(double t, double from, double to) {
  const double u = ramp(t, from, to);
  return u * u * (3.0 - 2.0 * u);
}

} // namespace

StabilityScene fast_leg(const FastLeg& leg, std::uint64_t seed) {
  constexpr double k_top = 1.6;
  // 0.3 m below the held row: at the end sqrt(0.3^2 + 0.25^2) = 0.39 m of the sheet lead to the leg, and what hangs
  // beyond keeps it there, so that the sheet need not slip off around its hem.
  static constexpr double k_leg_y = k_top - 0.3;
  constexpr double k_from = -0.3, k_to = 0.25, k_begin = 0.1;
  std::mt19937_64 random(seed);
  StabilityScene scene;
  scene.name = fmt::format("fast-leg{} {:g} m/s", suffix_of(leg.weave), leg.speed);
  if (leg.radius != FastLeg().radius || leg.thickness != FastLeg().thickness)
    scene.name += fmt::format(", {:g} mm into {:g} mm", 1e3 * leg.radius, 1e3 * leg.thickness);
  scene.garment = hanging_sheet(24, 0.6, k_top, leg.weave);
  scene.garment.fabric.thickness = leg.thickness;
  scene.start = uneven(scene.garment, random);
  const double end = k_begin + (k_to - k_from) / leg.speed;
  scene.seconds = end + 4.0; // it swings on: the air alone brings it to rest
  scene.looks = static_cast<int>(std::ceil(leg.speed / k_stability_frames_per_second / leg.radius));
  scene.pose = [end, radius = leg.radius, pinned = pins_at_rest(scene.garment)](
                   double t, std::vector<Capsule>& capsules, std::vector<Vec3>& pins) {
    const double z = std::lerp(k_from, k_to, ramp(t, k_begin, end));
    capsules = {{{-0.5, k_leg_y, z}, {0.5, k_leg_y, z}, radius}};
    pins = pinned;
  };
  return scene;
}

StabilityScene fast_leg(double speed, std::uint64_t seed, Weave weave) {
  FastLeg leg{speed};
  leg.weave = weave;
  return fast_leg(leg, seed);
}

StabilityScene coarse_cells(const CoarseCells& cells, std::uint64_t seed) {
  constexpr int k_particles = 6; // a side: five cells, so that the middle of the sheet is the middle of a cell
  constexpr double k_speed = 1.0, k_begin = 0.1;
  const double size = (k_particles - 1) * cells.cell;
  const double top = size + 1.0, from = -cells.radius - 0.05, to = 0.25 * size, end = k_begin + (to - from) / k_speed;
  std::mt19937_64 random(seed);
  StabilityScene scene;
  scene.name = fmt::format("coarse-cells{} {:g} {}", suffix_of(cells.weave), cells.cell / (2.0 * cells.radius),
                           cells.along_warp ? "along" : "across");
  scene.garment = hanging_sheet(k_particles, size, top, cells.weave);
  scene.start = uneven(scene.garment, random);
  scene.seconds = end + 3.0;
  const double middle = top - 0.5 * size;
  const Vec3 a = cells.along_warp ? Vec3(0, top - 0.3 * size, 0) : Vec3(-0.7 * size, middle, 0);
  const Vec3 b = cells.along_warp ? Vec3(0, top - 1.3 * size, 0) : Vec3(0.7 * size, middle, 0);
  scene.pose = [=, radius = cells.radius, pinned = pins_at_rest(scene.garment)](
                   double t, std::vector<Capsule>& capsules, std::vector<Vec3>& pins) {
    const Vec3 at(0, 0, std::lerp(from, to, ramp(t, k_begin, end)));
    capsules = {{a + at, b + at, radius}};
    pins = pinned;
  };
  return scene;
}

StabilityScene coarse_cells(double cells, bool along_warp, std::uint64_t seed, Weave weave) {
  CoarseCells what;
  what.weave = weave;
  what.cell = cells * 2.0 * what.radius;
  what.along_warp = along_warp;
  return coarse_cells(what, seed);
}

StabilityScene start_inside(const StartInside& arm, std::uint64_t seed) {
  const double tube_radius = std::max(0.12, 2.4 * arm.radius), off_the_wall = arm.radius - arm.depth;
  std::mt19937_64 random(seed);
  StabilityScene scene;
  scene.name = fmt::format("start-inside{}, arm {}", suffix_of(arm.weave), arm.axis_within ? "within" : "outside");
  scene.garment = tube(20, 32, {1.5, tube_radius, 1.0, tube_radius}, false, arm.weave);
  scene.start = uneven(scene.garment, random);
  const double angle = 2.0 * k_pi * unit(random);
  const double from_axis = tube_radius + (arm.axis_within ? -off_the_wall : off_the_wall);
  const Vec3 foot(from_axis * std::sin(angle), 0, from_axis * std::cos(angle));
  scene.pose = [foot, radius = arm.radius, pinned = pins_at_rest(scene.garment)](double, std::vector<Capsule>& capsules,
                                                                                 std::vector<Vec3>& pins) {
    capsules = {{foot + Vec3(0, 1.35, 0), foot + Vec3(0, 0.8, 0), radius}};
    pins = pinned;
  };
  return scene;
}

StabilityScene start_inside(bool axis_within, std::uint64_t seed, Weave weave) {
  StartInside arm;
  arm.weave = weave;
  arm.axis_within = axis_within;
  return start_inside(arm, seed);
}

StabilityScene teleport(bool told, std::uint64_t seed, Weave weave) {
  constexpr int k_frame = 30;
  const Vec3 jump(5, 0, 0);
  std::mt19937_64 random(seed);
  StabilityScene scene;
  scene.name = fmt::format("teleport{}, {}", suffix_of(weave), told ? "told" : "not told");
  scene.garment = tube(20, 40, {1.0, 0.16, 0.5, 0.30}, false, weave);
  scene.start = uneven(scene.garment, random);
  scene.seconds = 3.0;
  scene.limits.crossings = told; // what flies through the air at 300 m/s may pass on either side
  if (told) scene.told_jump_frame = k_frame;
  scene.jump = jump;
  scene.pose = [jump, pinned = pins_at_rest(scene.garment)](double t, std::vector<Capsule>& capsules,
                                                            std::vector<Vec3>& pins) {
    const bool there = t > (k_frame + 0.5) / k_stability_frames_per_second;
    const Vec3 at = there ? jump : Vec3(Vec3::Zero());
    capsules = {{Vec3(-0.03, 1.02, 0) + at, Vec3(0.03, 1.02, 0) + at, 0.11},
                {Vec3(0.09, 0.9, 0) + at, Vec3(0.09, 0.1, 0) + at, 0.07},
                {Vec3(-0.09, 0.9, 0) + at, Vec3(-0.09, 0.1, 0) + at, 0.07}};
    pins = pinned;
    for (Vec3& pin : pins) pin += at;
  };
  return scene;
}

namespace {

/// Nothing but cloth and what holds it.
void stand_alone(StabilityScene& scene) {
  scene.pose = [pinned = pins_at_rest(scene.garment)](double, std::vector<Capsule>&, std::vector<Vec3>& pins) {
    pins = pinned;
  };
}

} // namespace

StabilityScene randomised(std::uint64_t seed, Weave weave) {
  constexpr double k_size = 0.6, k_top = 1.6;
  std::mt19937_64 random(seed);
  StabilityScene scene;
  scene.name = fmt::format("randomised{}", suffix_of(weave));
  scene.garment = hanging_sheet(20, k_size, k_top, weave);
  scene.start = scene.garment.rest_positions;
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(scene.garment);
  for (std::size_t i = 0; i < scene.start.size(); ++i) {
    const double x = unit(random), y = unit(random), z = unit(random);
    if (!pinned[i]) scene.start[i] = Vec3(k_size * (x - 0.5), k_top - k_size * y, k_size * (z - 0.5));
  }
  scene.seconds = 4.0;
  stand_alone(scene);
  return scene;
}

StabilityScene flattened(bool upright, std::uint64_t seed, Weave weave) {
  constexpr double k_top = 1.5;
  std::mt19937_64 random(seed);
  StabilityScene scene;
  scene.name = fmt::format("flattened{} {}", suffix_of(weave), upright ? "upright" : "level");
  scene.garment = tube(20, 32, {k_top, 0.12, 1.0, 0.2}, false, weave);
  // Along the wall first, across it not at all: in one plane to the bit.
  scene.start = uneven(scene.garment, random);
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(scene.garment);
  for (std::size_t i = 0; i < scene.start.size(); ++i) {
    if (pinned[i]) continue;
    if (upright) scene.start[i].z() = 0.0;
    else scene.start[i].y() = k_top;
  }
  scene.seconds = 4.0;
  stand_alone(scene);
  return scene;
}

StabilityScene twist(std::uint64_t seed, Weave weave) {
  constexpr double k_turns = 3.0, k_top = 1.6, k_length = 0.6, k_drawn_up = 0.15;
  std::mt19937_64 random(seed);
  StabilityScene scene;
  scene.name = fmt::format("twist{}", suffix_of(weave));
  // As stiff as denim. A limp tube turned into a rope passes through itself, and keeps two turns that undo each other
  // (some 10 % of stretch) for ever.
  constexpr double k_bend = 1e-4; // N m
  scene.garment = tube(24, 32, {k_top, 0.1, k_top - k_length, 0.1}, true, weave, k_bend);
  scene.start = uneven(scene.garment, random);
  scene.seconds = 7.0;
  scene.pose = [pinned = pins_at_rest(scene.garment)](double t, std::vector<Capsule>&, std::vector<Vec3>& pins) {
    const double turned = soft_ramp(t, 0.0, 2.0) - soft_ramp(t, 2.0, 4.0);
    const Eigen::AngleAxisd turn(2.0 * k_pi * k_turns * turned, Vec3::UnitY());
    pins = pinned;
    for (Vec3& pin : pins)
      if (pin.y() < k_top - 0.5 * k_length) pin = turn * pin + Vec3(0, k_drawn_up * std::sqrt(turned), 0);
  };
  return scene;
}

/// Shut at the bottom: cloth as thin as this slips through a ring, as silk does.
StabilityScene funnel(std::uint64_t seed, Weave weave) {
  constexpr int k_staves = 16;
  std::mt19937_64 random(seed);
  StabilityScene scene;
  scene.name = fmt::format("funnel{}", suffix_of(weave));
  scene.garment = cloth::build_garment(sheet(26, {-0.25, 1.05, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}, weave));
  scene.start = uneven(scene.garment, random);
  scene.friction = 0.5;
  scene.seconds = 5.0;
  scene.pose = [](double, std::vector<Capsule>& capsules, std::vector<Vec3>&) {
    capsules.clear();
    for (int k = 0; k < k_staves; ++k) {
      const double angle = 2.0 * k_pi * k / k_staves;
      const Vec3 outward(std::sin(angle), 0, std::cos(angle));
      capsules.push_back({0.35 * outward + Vec3(0, 1.0, 0), 0.03 * outward + Vec3(0, 0.6, 0), 0.03});
    }
  };
  return scene;
}

StabilityScene rotating_sphere(double friction, std::uint64_t seed, Weave weave) {
  constexpr double k_radius = 0.2;
  std::mt19937_64 random(seed);
  StabilityScene scene;
  scene.name = fmt::format("rotating-sphere{}, friction {:g}", suffix_of(weave), friction);
  cloth::GarmentDescription description =
      sheet(24, {-0.2, 1.0 + k_radius + 0.003, -0.2}, {0.4, 0, 0}, {0, 0, 0.4}, weave);
  description.fabric.drag = 0.2; // the air stands still and would hold the cloth back
  scene.garment = cloth::build_garment(description);
  scene.start = uneven(scene.garment, random);
  scene.friction = friction;
  // Without friction the sheet glides off in the end: it is judged while it lies on top.
  scene.seconds = friction > 0.0 ? 4.0 : 1.0;
  scene.limits.speed = 3.0; // it turns
  scene.limits.turn_rate = friction > 0.0 ? std::pair(0.9 * k_sphere_turn_rate, 1.1 * k_sphere_turn_rate)
                                          : std::pair(-0.1 * k_sphere_turn_rate, 0.1 * k_sphere_turn_rate);
  scene.spin = {Vec3(0, k_sphere_turn_rate, 0)};
  scene.pose = [](double, std::vector<Capsule>& capsules, std::vector<Vec3>&) {
    capsules = {{Vec3(0, 1, 0), Vec3(0, 1, 0), k_radius}};
  };
  return scene;
}

namespace {

using Builder = std::function<StabilityScene(std::uint64_t)>;

/// A builder for each of these values.
template <class Value, class Build> std::vector<Builder> variants(std::initializer_list<Value> values, Build build) {
  std::vector<Builder> builders;
  for (const Value& value : values) builders.push_back([=](std::uint64_t seed) { return build(value, seed); });
  return builders;
}

void add_families(Weave weave, std::vector<StabilityFamily>& families) {
  const auto add = [&](const char* name, const char* what, std::vector<Builder> builders) {
    families.push_back({std::string(name) + suffix_of(weave),
                        std::string(what) + (weave == Weave::mesh ? ", of irregular triangles" : ""),
                        std::move(builders)});
  };
  const auto both = [weave](StabilityScene (*build)(bool, std::uint64_t, Weave)) {
    return variants({true, false}, [=](bool which, std::uint64_t seed) { return build(which, seed, weave); });
  };
  const auto only = [weave](StabilityScene (*build)(std::uint64_t, Weave)) {
    return std::vector<Builder>{[=](std::uint64_t seed) { return build(seed, weave); }};
  };
  std::vector<Builder> cells;
  for (const bool along : {false, true})
    for (int k = 1; k <= 6; ++k)
      cells.push_back([=](std::uint64_t seed) { return coarse_cells(k, along, seed, weave); });
  add("fast-leg", "a leg goes through a hanging sheet at 1 to 30 m/s",
      variants({1.0, 2.0, 5.0, 10.0, 20.0, 30.0},
               [=](double speed, std::uint64_t seed) { return fast_leg(speed, seed, weave); }));
  add("thin-leg", "a leg as thin as a hand goes through cloth of 4 to 32 mm",
      variants({0.004, 0.008, 0.016, 0.032}, [=](double thickness, std::uint64_t seed) {
        return fast_leg({5.0, 0.012, thickness, weave}, seed);
      }));
  add("coarse-cells", "cells 1 to 6 times as large as the limb that pushes into them", cells);
  add("start-inside", "an arm is in the wall of a tube at frame 0", both(start_inside));
  add("teleport", "everything jumps by 5 m in one frame", both(teleport));
  add("randomised", "particles begin anywhere in a cube", only(randomised));
  add("flattened", "a tube begins in one plane", both(flattened));
  add("twist", "one end of a tube is turned three times round and back", only(twist));
  add("funnel", "a sheet falls into a funnel of sixteen capsules", only(funnel));
  add("rotating-sphere", "a sheet on a ball that turns", variants({0.8, 0.0}, [=](double friction, std::uint64_t seed) {
        return rotating_sphere(friction, seed, weave);
      }));
}

} // namespace

const std::vector<StabilityFamily>& stability_families() {
  static const std::vector<StabilityFamily> families = [] {
    std::vector<StabilityFamily> all;
    for (const Weave weave : {Weave::threads, Weave::mesh}) add_families(weave, all);
    return all;
  }();
  return families;
}

} // namespace tutu::app
