// Edges and faces against proxies: beside a twin that asks every triangle about every proxy by search, and with input
// that no scene should have.
#include "cloth/contact/triangle_contacts.h"
#include "cloth/solver.h"
#include "src/study/bench/mesh_sheet.h"
#include "tests/support/nearest_search.h"

#include <gtest/gtest.h>
#include <random>

using namespace tutu;
using namespace tutu::cloth;

namespace {

constexpr double k_seconds = 1.0 / 60.0;

/// Irregular triangles of about 5 cm, level at y = 0; `pinned`: those of the first row are held.
Garment sheet(const Fabric& fabric, bool pinned, int cells = 4) {
  GarmentDescription description;
  description.file = "sheet";
  description.shape = app::mesh_sheet(cells, {-0.1, 0, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}, 0.25);
  description.fabric = fabric;
  if (pinned) description.attachments = {{.joint = "stage", .within = Attachment::Ball{{-0.1, 0, -0.1}, 0.12}}};
  return build_garment(description);
}

SolverOptions with(ContactFeatures features) {
  SolverOptions options;
  options.features = features;
  return options;
}

/// Every triangle about every proxy, in order: the deepest point by search, out along the normal by no more than both
/// sides moved and the push-out speed allow, corners by inverse mass times weight.
class Twin {
public:
  explicit Twin(const Garment& garment) : garment_(&garment), pinned_(pinned_flags(garment)) {}

  std::int64_t asked = 0, hits = 0;
  bool crossed = false; ///< an axis has come so near to the cloth that a search no longer knows its sides

  void particles(std::span<const proxies::Capsule> before, std::span<const proxies::Capsule> now,
                 const std::vector<Vec3>& starts, double h, std::vector<Vec3>& x) const {
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t c = 0; c < now.size(); ++c) {
        const test::Searched found = test::search_point(x[i], now[c]);
        const double needed = garment_->fabric.contact_offset() - found.distance;
        if (pinned_[i] || needed <= 0.0) continue;
        x[i] += std::min(needed, (x[i] - starts[i]).norm() + moved(before[c], now[c]) + k_push_out_speed * h) *
                found.normal;
      }
  }

  /// `free`: where the particles were before any contact.
  void triangles(std::span<const proxies::Capsule> before, std::span<const proxies::Capsule> now,
                 const std::vector<Vec3>& starts, const std::vector<Vec3>& free, double h, std::vector<Vec3>& x) {
    for (const auto& [a, b, c] : garment_->triangles) {
      if (pinned_[a] && pinned_[b] && pinned_[c]) continue;
      for (std::size_t k = 0; k < now.size(); ++k) {
        const test::Searched found = test::search_triangle({x[a], x[b], x[c]}, now[k]);
        const double needed = garment_->fabric.contact_offset() - found.distance;
        ++asked;
        if (needed <= 0.0) continue;
        ++hits;
        crossed = crossed || found.distance < 0.005 - now[k].narrowest();
        // Weights of the point, from its place.
        Eigen::Matrix<double, 4, 3> system;
        system << x[a], x[b], x[c], 1.0, 1.0, 1.0;
        const Eigen::Vector3d weights =
            system.colPivHouseholderQr().solve(Eigen::Vector4d(found.cloth.x(), found.cloth.y(), found.cloth.z(), 1.0));
        const auto at = [&](const std::vector<Vec3>& of) {
          return Vec3(weights[0] * of[a] + weights[1] * of[b] + weights[2] * of[c]);
        };
        const double allowed = moved(before[k], now[k]) + k_push_out_speed * h;
        const bool began_inside = needed > (at(free) - at(starts)).norm() + allowed;
        const double push =
            began_inside
                ? std::max(0.0, std::min(needed, allowed - std::max((found.cloth - at(free)).norm(),
                                                                    (found.cloth - at(starts)).dot(found.normal))))
                : needed;
        double sum = 0.0, most = 0.0;
        for (int j = 0; j < 3; ++j) {
          const std::uint32_t i = std::array{a, b, c}[j];
          const double w = pinned_[i] ? 0.0 : 1.0 / garment_->masses[i];
          sum += w * weights[j] * weights[j];
          most = std::max(most, w * weights[j]);
        }
        if (most < 1e-6 / garment_->masses[a]) continue; // at a pinned corner but for the search's rounding
        sum = std::max(sum, most / k_longest_lever);
        for (int j = 0; j < 3; ++j) {
          const std::uint32_t i = std::array{a, b, c}[j];
          if (!pinned_[i]) x[i] += weights[j] / garment_->masses[i] / sum * push * found.normal;
        }
      }
    }
  }

private:
  static double moved(const proxies::Capsule& before, const proxies::Capsule& now) {
    return std::max((now.a - before.a).norm(), (now.b - before.b).norm());
  }
  const Garment* garment_;
  std::vector<std::uint8_t> pinned_;
};

TEST(TriangleContacts, AreThoseOfASearchOverAllPairs) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-0.1, 0.1), radius(0.15, 0.4), speed(-1.0, 1.0);
  Fabric fabric;
  fabric.clearance = 0.003;
  constexpr int k_substeps = 6;
  std::int64_t asked = 0, hits = 0, queries = 0;
  int crossed = 0;
  for (const proxies::Backend backend : {proxies::Backend::brute, proxies::Backend::hybrid, proxies::Backend::fcl})
    for (int trial = 0; trial < 8; ++trial) {
      const Garment garment = sheet(fabric, trial % 2 == 1);
      Particles fast{garment.rest_positions, garment.rest_positions};
      for (Vec3& v : fast.velocities) v = Vec3(speed(random), 0.5 * speed(random) - 0.5, speed(random));
      Particles plain = fast;
      std::vector<proxies::Capsule> start, end; // from below; balls, capsules and cones
      for (int c = 0; c < 3; ++c) {
        const double r = radius(random);
        proxies::Capsule capsule{Vec3(place(random), -r - 0.01, place(random)), {}, r};
        capsule.b = c == 0 ? capsule.a : Vec3(capsule.a + Vec3(place(random), 0.05 * place(random), place(random)));
        if (c == 2) capsule.taper = 0.01;
        start.push_back(capsule);
        const Vec3 rise(0.0, 0.055, 0.0);
        capsule.a += rise;
        capsule.b += rise;
        end.push_back(capsule);
      }
      const proxies::SweptColliders colliders{start, end, std::nullopt};
      const auto query = proxies::make_query(backend);
      const std::vector<std::uint8_t> pinned = pinned_flags(garment);
      ContactSearch search(fabric.contact_offset()); // no threads: the twin knows no pinches
      TriangleContacts triangles(garment, with(ContactFeatures::triangles));
      Twin twin(garment);
      FrameInput input;
      input.colliders = colliders;
      input.seconds = k_seconds;
      search.begin_frame(*query, input, fast);
      triangles.begin_frame(*query, search, fast);
      std::vector<proxies::Capsule> before = start, now(3);
      for (int k = 0; k < k_substeps; ++k) {
        const double h = k_seconds / k_substeps, s = (k + 1.0) / k_substeps;
        const std::vector<Vec3> starts = fast.positions, twin_starts = plain.positions;
        for (Particles* particles : {&fast, &plain})
          for (int i = 0; i < particles->count(); ++i)
            if (!pinned[i]) particles->positions[i] += h * particles->velocities[i];
        const std::vector<Vec3> free = plain.positions;
        search.for_each_contact(
            *query, s, pinned, fast,
            [&](int i, int collider, const proxies::Contact& contact, double push) {
              const Vec3 moved = search.way_out(fast.positions[i], starts[i], collider, contact, push);
              fast.positions[i] += moved;
              return Response{moved};
            },
            [](int, const BetweenColliders::Settled&) { return Response{}; });
        triangles.for_each_contact(*query, search, fast, [&](const ClothContact& contact) {
          return Response{push_out(contact, search, starts, fast.positions)};
        });
        proxies::colliders_at(colliders, s, now);
        twin.particles(before, now, twin_starts, h, plain.positions);
        twin.triangles(before, now, twin_starts, free, h, plain.positions);
        before = now;
        if (twin.crossed) break;
        for (int i = 0; i < fast.count(); ++i)
          ASSERT_LT((fast.positions[i] - plain.positions[i]).norm(), 1e-6)
              << "trial " << trial << ", substep " << k << ", particle " << i;
        plain.positions = fast.positions;
      }
      crossed += twin.crossed;
      asked += twin.asked;
      hits += twin.hits;
      queries += triangles.counts().queries;
    }
  EXPECT_LT(crossed, 6); // of 24 trials
  EXPECT_GT(hits, 0.3 * static_cast<double>(asked));
  EXPECT_LT(hits, 0.7 * static_cast<double>(asked));
  EXPECT_LT(queries, asked); // the rest could not have met
}

/// Nothing of the cloth is deeper in a proxy than this, at 28 points of each triangle, m.
double deepest(const Garment& garment, const std::vector<Vec3>& x, std::span<const proxies::Capsule> proxies) {
  double deepest = 0.0;
  for (const auto& [a, b, c] : garment.triangles)
    for (int u = 0; u <= 6; ++u)
      for (int v = 0; u + v <= 6; ++v) {
        const Vec3 p = (x[a] * u + x[b] * v + x[c] * (6 - u - v)) / 6.0;
        for (const proxies::Capsule& proxy : proxies)
          deepest = std::max(deepest, -test::search_point(p, proxy).distance);
      }
  return deepest;
}

/// A thin limb rises through the middle of a coarse sheet that hangs between two sides.
TEST(TriangleContacts, KeepALimbOutBetweenParticlesInEverySolver_slow) {
  for (const SolverKind solver : {SolverKind::xpbd, SolverKind::mass_spring})
    for (const proxies::Backend backend : {proxies::Backend::hybrid, proxies::Backend::brute, proxies::Backend::fcl})
      for (const bool woven : {false, true}) {
        SCOPED_TRACE(std::string(k_solver_names[static_cast<int>(solver)]) + ", " +
                     std::string(proxies::k_backend_names[static_cast<int>(backend)]) + (woven ? ", grid" : ", mesh"));
        Fabric fabric;
        fabric.stretch = 100.0;
        Garment garment = sheet(fabric, true);
        if (woven) {
          GarmentDescription description;
          description.shape = GridShape{5, 5, {-0.1, 0, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}};
          description.fabric = fabric;
          description.attachments = {{.joint = "stage", .last_row = 0}};
          garment = build_garment(description);
        }
        const auto run = [&](ContactFeatures features) {
          SolverOptions options = with(features);
          options.solver = solver;
          const auto made = make_solver(garment, options);
          const auto query = proxies::make_query(backend);
          std::vector<Vec3> pins;
          for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
          FrameInput input;
          input.substeps = 32;
          input.pins_start = input.pins_end = pins;
          double worst = 0.0;
          for (int frame = 0; frame < 60; ++frame) {
            const auto at = [&](int f) {
              const double y = -0.03 + 0.05 * std::min(f, 40) / 40.0;
              return std::vector<proxies::Capsule>{{{-0.07, y, 0.015}, {0.08, y, 0.035}, 0.015}};
            };
            const auto from = at(frame), to = at(frame + 1);
            input.colliders = {from, to, std::nullopt};
            if (made->step(input, *query)) return 1.0;
            worst = std::max(worst, deepest(garment, made->particles().positions, to));
          }
          return worst;
        };
        EXPECT_GT(run(ContactFeatures::particles), 0.005);
        EXPECT_LT(run(ContactFeatures::triangles), 0.0005);
        EXPECT_LT(run(ContactFeatures::automatic), 0.0005);
      }
}

/// No room, no thickness, no friction that lets go, proxies in each other, cloth without area: met with numbers.
TEST(TriangleContacts, WhatNoSceneShouldHaveGivesNumbers) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> place(-0.1, 0.1);
  for (const double thickness : {0.0, 0.004, 0.5})
    for (const double friction : {0.0, 1e6})
      for (const bool flat : {false, true}) {
        Fabric fabric;
        fabric.thickness = thickness;
        const Garment garment = sheet(fabric, true);
        for (const SolverKind solver : {SolverKind::xpbd, SolverKind::mass_spring}) {
          SolverOptions options = with(ContactFeatures::triangles);
          options.solver = solver;
          const auto made = make_solver(garment, options);
          Particles state{garment.rest_positions, std::vector<Vec3>(garment.rest_positions.size(), Vec3::Zero())};
          if (flat)
            for (Vec3& p : state.positions) p.z() = 0.0;
          made->restore(state);
          std::vector<proxies::Capsule> from;
          for (int k = 0; k < 4; ++k) {
            const Vec3 a(place(random), 0.0, place(random)); // in the sheet's plane: crossed from the start
            from.push_back({a, k == 0 ? a : Vec3(a + Vec3(place(random), 0.0, place(random))), 0.02});
          }
          from.push_back(from.back());
          from.back().radius = 0.06; // around the one before
          std::vector<proxies::Capsule> to = from;
          for (proxies::Capsule& c : to) c.a.y() += 0.02;
          const std::vector<double> rub(from.size() + 2, friction);
          std::vector<Vec3> pins;
          for (const Pin& pin : garment.pins) pins.push_back(garment.rest_positions[pin.particle]);
          FrameInput input;
          input.substeps = 10;
          input.pins_start = input.pins_end = pins;
          input.colliders = {from, to, std::nullopt};
          input.friction = rub;
          const auto query = proxies::make_query(proxies::Backend::hybrid);
          for (int frame = 0; frame < 20; ++frame) {
            if (made->step(input, *query)) break; // told, not shown
            for (const Vec3& p : made->particles().positions) ASSERT_TRUE(p.allFinite());
            for (const Vec3& v : made->particles().velocities) ASSERT_TRUE(v.allFinite());
          }
        }
      }
}

} // namespace
