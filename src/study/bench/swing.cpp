#include "src/study/bench/swing.h"

#include "src/study/bench/mesh_sheet.h"
#include "src/study/bench/stand.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>

namespace tutu::app {
namespace {

constexpr double k_top = 1.0, k_side = 0.6; // m
constexpr int k_particles = 20;             // a side
const Vec3 k_corner(-0.5 * k_side, k_top, 0.0), k_across(k_side, 0.0, 0.0), k_down(0.0, -k_side, 0.0);

cloth::Garment woven_sheet() {
  return sheet({k_particles, k_particles, k_corner, k_across, k_down}, airless(40.0), {{"stage", 0, 0, 0, -1}});
}

cloth::Garment irregular_sheet() {
  cloth::GarmentDescription description;
  description.name = "sheet";
  description.shape = mesh_sheet(k_particles - 1, k_corner, k_across, k_down, 0.3);
  description.fabric = airless(40.0);
  description.attachments = {{.joint = "stage", .above = k_top - 1e-6}};
  return cloth::build_garment(description);
}

using Shape = std::function<Vec3(const Vec3&)>; // where a place at rest is let go

struct Decay {
  double rate = k_nothing; ///< 1/s, of amplitude
  double rise = k_nothing; ///< of energy, of that at the start
};

/// Lets a sheet go from where `shape` puts what hangs at rest.
Decay decay_of(const Shape& shape, double seconds, bool of_triangles, const RunSettings& setup) {
  const cloth::Garment garment = of_triangles ? irregular_sheet() : woven_sheet();
  Stand stand(garment, setup);
  stand.input().extra_drag = 8.0;
  for (int frame = 0; frame < 600; ++frame)
    if (!stand.advance()) return {};
  stand.input().extra_drag = 0.0;
  const double lowest = stand.total_energy();
  std::vector<Vec3> start = stand.solver().particles().positions;
  for (Vec3& p : start) p = shape(p);
  for (std::size_t k = 0; k < garment.pins.size(); ++k) start[garment.pins[k].particle] = stand.pins()[k];
  stand.solver().reset(start);
  std::vector<double> energies = {stand.total_energy() - lowest};
  for (int frame = 0; frame * Stand::k_frame < seconds; ++frame) {
    if (!stand.advance()) return {};
    energies.push_back(stand.total_energy() - lowest);
  }
  return {-0.5 * std::log(energies.back() / energies.front()) / seconds, greatest_rise(energies) / energies.front()};
}

/// Angular momentum that a sheet in empty space has kept after a second at 10 rad/s about its normal.
double spin_kept(const RunSettings& setup) {
  constexpr double k_spin = 10.0, k_width = 0.3; // rad/s, m
  constexpr int k_few = 12;                      // particles a side
  const cloth::Garment garment =
      sheet({k_few, k_few, {-0.5 * k_width, 0.5 * k_width, 0}, {k_width, 0, 0}, {0, -k_width, 0}}, airless(40.0));
  Stand stand(garment, setup);
  stand.input().gravity = Vec3::Zero();
  cloth::Particles state{garment.rest_positions, garment.rest_positions};
  for (Vec3& v : state.velocities) v = Vec3(0, 0, k_spin).cross(v);
  stand.solver().restore(state);
  const auto momentum = [&](const cloth::Particles& particles) {
    double sum = 0.0;
    for (int i = 0; i < particles.count(); ++i)
      sum += garment.masses[i] * particles.positions[i].cross(particles.velocities[i]).z();
    return sum;
  };
  const double start = momentum(state);
  for (int frame = 0; frame < 60; ++frame)
    if (!stand.advance()) return k_nothing;
  return momentum(stand.solver().particles()) / start;
}

} // namespace

std::vector<AnalyticFigure> swing(const RunSettings& setup, bool of_triangles) {
  struct Mode {
    const char* name;
    std::function<Decay(const RunSettings&)> decay;
  };
  const auto let_go = [=](double seconds, const Shape& shape) {
    return [=](const RunSettings& s) { return decay_of(shape, seconds, of_triangles, s); };
  };
  constexpr double k_angle = 80.0 * std::numbers::pi / 180.0;
  const Mode modes[] = {
      {"swing", let_go(2.0,
                       [](const Vec3& p) {
                         const double l = k_top - p.y();
                         return Vec3(p.x(), k_top - l * std::cos(k_angle), p.z() + l * std::sin(k_angle));
                       })},
      {"bounce", let_go(0.3, [](const Vec3& p) { return Vec3(p.x(), k_top + 1.01 * (p.y() - k_top), p.z()); })},
      {"shear",
       let_go(2.0, [](const Vec3& p) { return Vec3(p.x() + 0.02 * (k_top - p.y()) / k_side, p.y(), p.z()); })}};
  RunSettings fine = setup;
  fine.substeps = std::max(k_swing_substeps, 2 * setup.substeps);
  fine.double_precision = true; // in 96 substeps float's rounding damps too
  std::vector<AnalyticFigure> figures;
  for (const Mode& mode : modes) {
    const Decay decay = mode.decay(setup), truth = mode.decay(fine);
    figures.push_back({fmt::format("decay of a {}", mode.name), "1/s", decay.rate, truth.rate,
                       k_swing_tolerance * std::abs(truth.rate)});
    // Its energy is told by velocities of half a substep ago: a part of what goes to and fro shows as growth.
    if (&mode == modes) figures.push_back({"growth of its energy", "%", 100.0 * decay.rise, 0.0, 2.0});
  }
  figures.push_back({"angular momentum after a second's spin", "%", 100.0 * spin_kept(setup), 100.0, k_spin_tolerance});
  return figures;
}

} // namespace tutu::app
