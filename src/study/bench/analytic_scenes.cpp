#include "src/study/bench/analytic_scenes.h"

#include "src/study/bench/stand.h"
#include "src/study/bench/swing.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <random>

namespace tutu::app {
namespace {

constexpr double k_frame = Stand::k_frame, k_gravity = Stand::k_gravity;

/// How far the sheet's centre has slid down a slope after 2 s, m.
double slide(double angle, double friction, const RunSettings& setup) {
  const Vec3 downhill(0.0, -std::sin(angle), std::cos(angle)), normal(0.0, std::cos(angle), std::sin(angle));
  const cloth::Fabric fabric = airless(40.0);
  const cloth::GridShape shape{8, 8, fabric.contact_offset() * normal, {0.3, 0, 0}, 0.3 * downhill};
  const cloth::Garment garment = sheet(shape, fabric);
  Stand stand(garment, setup);
  stand.input().colliders.ground = proxies::Plane{normal, 0.0};
  const std::vector<double> coefficients = {friction};
  stand.input().friction = coefficients;
  for (int frame = 0; frame < 120; ++frame)
    if (!stand.advance()) return k_nothing;
  Vec3 moved = Vec3::Zero();
  for (int i = 0; i < garment.particle_count(); ++i)
    moved += (stand.solver().particles().positions[i] - garment.rest_positions[i]) / garment.particle_count();
  return moved.dot(downhill);
}

} // namespace

bool AnalyticFigure::passed() const { return std::abs(measured - expected) <= tolerance; }

std::vector<AnalyticFigure> free_fall(const RunSettings& setup) {
  const cloth::Garment garment = sheet({8, 8, {-0.15, 2, 0}, {0.3, 0, 0}, {0, -0.3, 0}}, airless(40.0));
  Stand stand(garment, setup);
  constexpr int k_frames = 30;
  bool held = true;
  for (int frame = 0; frame < k_frames && held; ++frame) held = stand.advance();
  double fallen = k_nothing, speed = k_nothing, bent = k_nothing;
  if (held) {
    fallen = speed = bent = 0.0;
    const cloth::Particles& particles = stand.solver().particles();
    for (int i = 0; i < garment.particle_count(); ++i) {
      fallen += (garment.rest_positions[i].y() - particles.positions[i].y()) / garment.particle_count();
      speed -= particles.velocities[i].y() / garment.particle_count();
    }
    for (int i = 0; i < garment.particle_count(); ++i)
      bent = std::max(bent, (particles.positions[i] + Vec3(0, fallen, 0) - garment.rest_positions[i]).norm());
  }
  // Velocities first: after n substeps h, g h^2 n (n + 1) / 2, which is g t^2 / 2 and half a substep's speed more.
  const double h = k_frame / setup.substeps, n = static_cast<double>(k_frames) * setup.substeps;
  return {{"way after 0.5 s", "m", fallen, k_gravity * h * h * n * (n + 1) / 2, 1e-4},
          {"speed after 0.5 s", "m/s", speed, k_gravity * n * h, 1e-3},
          {"particles out of shape", "m", bent, 0.0, 1e-4}};
}

std::vector<AnalyticFigure> slope(double friction, const RunSettings& setup) {
  constexpr double k_half_degree = 0.5 * std::numbers::pi / 180.0, k_seconds = 2.0;
  const double angle = std::atan(friction), steep = angle + k_half_degree;
  const double way = 0.5 * k_gravity * (std::sin(steep) - friction * std::cos(steep)) * k_seconds * k_seconds;
  return {{fmt::format("friction {:.1f}, half a degree below", friction), "m",
           slide(angle - k_half_degree, friction, setup), 0.0, 1e-3},
          {fmt::format("friction {:.1f}, half a degree above", friction), "m", slide(steep, friction, setup), way,
           0.05 * way + 1e-3}};
}

std::vector<AnalyticFigure> pendulum(const RunSettings& setup) {
  constexpr double k_length = 0.5, k_amplitude = 0.5;
  constexpr int k_swings = 5;
  cloth::Fabric fabric = airless(1e4);
  fabric.bend = 0.0;
  const Vec3 along(0, -k_length * std::cos(k_amplitude), k_length * std::sin(k_amplitude));
  const cloth::Garment garment = sheet({2, 2, {0, 1, 0}, {0.1, 0, 0}, along}, fabric, {{"stage", 0, 0, 0, -1}});
  Stand stand(garment, setup);
  const double start = stand.total_energy();
  double lowest = 0.0; // energy at rest, straight down
  for (int i = 0; i < garment.particle_count(); ++i)
    lowest += garment.masses[i] * k_gravity * (i < garment.columns ? 1.0 : 1.0 - k_length);
  std::vector<double> energies = {start}, passages; // s at which it goes through the middle backwards
  const double a2 = k_amplitude * k_amplitude;
  const double period =
      2.0 * std::numbers::pi * std::sqrt(k_length / k_gravity) * (1.0 + a2 / 16.0 + 11.0 * a2 * a2 / 3072.0);
  const auto swing = [&] { return stand.solver().particles().positions[garment.columns].z(); };
  double z = swing();
  for (int frame = 0; frame * k_frame < (k_swings + 1) * period; ++frame) {
    if (!stand.advance()) return {{"period", "s", k_nothing, period, 0.0}};
    const double next = swing();
    if (z > 0.0 && next <= 0.0) passages.push_back((frame + z / (z - next)) * k_frame);
    z = next;
    energies.push_back(stand.total_energy());
  }
  const double measured =
      static_cast<int>(passages.size()) > k_swings ? (passages[k_swings] - passages[0]) / k_swings : k_nothing;
  const double share = 100.0 / (start - lowest);
  // Its energy is told by velocities of half a substep ago: a part of what goes to and fro shows as growth.
  return {{"period", "s", measured, period, 0.01 * period},
          {"growth of energy", "%", share * greatest_rise(energies), 0.0, 2.0},
          {"loss of energy in six swings", "%", share * (start - energies.back()), 0.0, 1.0}};
}

namespace {

/// The sag of the band with its long side along warp or weft.
AnalyticFigure catenary_along(bool warp, const RunSettings& setup) {
  constexpr double k_span = 1.0, k_length = 1.2;
  constexpr int k_particles = 61;
  const Vec3 along(k_length, 0, 0), width(0, 0, 0.02), corner(-0.5 * k_length, 1, 0);
  cloth::Fabric fabric = airless(2000.0);
  fabric.bend = 0.0;
  fabric.shear = 1.0;
  const cloth::Garment garment =
      warp ? sheet({k_particles, 2, corner, width, along}, fabric, {{"left", 0, 0, 0, -1}, {"right", -1, -1, 0, -1}})
           : sheet({2, k_particles, corner, along, width}, fabric, {{"left", 0, -1, 0, 0}, {"right", 0, -1, -1, -1}});
  // a cosh(x / a) through both points with length 2 a sinh(span / 2a): longer the smaller a is.
  double low = 0.01, high = 100.0;
  for (int k = 0; k < 200; ++k) {
    const double a = 0.5 * (low + high);
    (2.0 * a * std::sinh(0.5 * k_span / a) > k_length ? low : high) = a;
  }
  const double a = 0.5 * (low + high), sag = a * (std::cosh(0.5 * k_span / a) - 1.0);

  // From a parabola of about the right sag, so that it comes to rest soon.
  Stand stand(garment, setup);
  std::vector<Vec3> start = garment.rest_positions;
  for (Vec3& p : start) {
    const double u = p.x() / (0.5 * k_length);
    p = Vec3(0.5 * k_span * u, 1.0 - 0.8 * sag * (1.0 - u * u), p.z());
  }
  stand.solver().reset(start);
  for (std::size_t k = 0; k < garment.pins.size(); ++k) stand.pins()[k] = start[garment.pins[k].particle];
  stand.input().extra_drag = 3.0;
  const std::string what = warp ? "sag along the warp" : "sag along the weft";
  for (int frame = 0; frame < 480; ++frame)
    if (!stand.advance()) return {what, "m", k_nothing, sag, 0.0};
  double lowest = 1.0;
  for (const Vec3& p : stand.solver().particles().positions) lowest = std::min(lowest, p.y());
  return {what, "m", 1.0 - lowest, sag, 0.02 * sag};
}

} // namespace

std::vector<AnalyticFigure> catenary(const RunSettings& setup) {
  return {catenary_along(true, setup), catenary_along(false, setup)};
}

std::vector<AnalyticFigure> hang(const RunSettings& setup) {
  constexpr int k_side = 20;
  cloth::Fabric fabric = airless(60.0);
  fabric.density = 0.2;
  fabric.shear = 0.01;
  fabric.bend = 0.0;
  const cloth::Garment garment =
      sheet({k_side, k_side, {-0.25, 1, 0}, {0.5, 0, 0}, {0, -0.5, 0}}, fabric, {{"stage", 0, 0, 0, -1}});
  double expected = 0.0; // mean over the columns
  for (const cloth::Spring& spring : garment.springs) {
    if (spring.kind != cloth::SpringKind::structural || spring.j != spring.i + k_side) continue;
    double below = 0.0; // kg
    for (int i = spring.j; i < garment.particle_count(); i += k_side) below += garment.masses[i];
    expected += below * k_gravity / spring.stiffness / k_side;
  }
  Stand stand(garment, setup);
  stand.input().extra_drag = 5.0;
  for (int frame = 0; frame < 300; ++frame)
    if (!stand.advance()) return {{"elongation", "m", k_nothing, expected, 0.0}};
  double give = 0.0;
  for (int column = 0; column < k_side; ++column) {
    const int last = (k_side - 1) * k_side + column;
    give += (garment.rest_positions[last].y() - stand.solver().particles().positions[last].y()) / k_side;
  }
  return {{"elongation", "m", give, expected, 0.02 * expected}};
}

std::vector<AnalyticFigure> energy(const RunSettings& setup) {
  const cloth::Garment garment =
      sheet({12, 12, {-0.25, 1, 0}, {0.5, 0, 0}, {0, -0.5, 0}}, airless(40.0), {{"stage", 0, 0, 0, -1}});
  Stand stand(garment, setup);
  std::mt19937_64 random(3);
  const auto shift = [&] { return 0.02 * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5); };
  std::vector<Vec3> shaken = garment.rest_positions;
  const std::vector<std::uint8_t> pinned = cloth::pinned_flags(garment);
  for (std::size_t i = 0; i < shaken.size(); ++i) {
    const double x = shift(), y = shift(), z = shift();
    if (!pinned[i]) shaken[i] += Vec3(x, y, z);
  }
  stand.solver().reset(shaken);
  std::vector<double> energies = {stand.total_energy()};
  for (int frame = 0; frame < 240; ++frame) {
    if (!stand.advance()) return {{"growth of energy", "%", k_nothing, 0.0, 0.0}};
    energies.push_back(stand.total_energy());
  }
  const double lost = energies.front() - energies.back();
  return {{"growth of energy, of what was lost", "%", 100.0 * greatest_rise(energies) / lost, 0.0, 0.1}};
}

namespace {

std::vector<AnalyticFigure> slopes(const RunSettings& setup) {
  std::vector<AnalyticFigure> figures;
  for (int tenth = 1; tenth <= 10; ++tenth) {
    const std::vector<AnalyticFigure> more = slope(0.1 * tenth, setup);
    figures.insert(figures.end(), more.begin(), more.end());
  }
  return figures;
}

} // namespace

const std::vector<AnalyticFamily>& analytic_families() {
  static const std::vector<AnalyticFamily> families = {
      {"drop", "free fall, and a sheet on a slope about the angle of friction",
       [](const RunSettings& setup) {
         std::vector<AnalyticFigure> figures = free_fall(setup);
         const std::vector<AnalyticFigure> more = slopes(setup);
         figures.insert(figures.end(), more.begin(), more.end());
         return figures;
       }},
      {"slope", "the slopes of drop alone", slopes},
      {"pendulum", "period and energy of a swing", pendulum},
      {"catenary", "the sag of a hanging band", catenary},
      {"hang", "how far a sheet gives by its own weight", hang},
      {"swing", "how fast sheets come to rest, which substeps must not change",
       [](const RunSettings& setup) { return swing(setup); }},
      {"swing-mesh", "swing, of irregular triangles", [](const RunSettings& setup) { return swing(setup, true); }},
      {"energy", "a shaken sheet left alone never gains energy", energy},
  };
  return families;
}

} // namespace tutu::app
