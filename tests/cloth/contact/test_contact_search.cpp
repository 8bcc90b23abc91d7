#include "cloth/contact/contact_search.h"
#include "proxies/distance/signed_distance.h"

#include <gtest/gtest.h>
#include <random>

using namespace tutu;
using namespace tutu::cloth;

namespace {

/// The report's response without any memory: every particle against every collider, in order; out by no more than both
/// have moved in the substep of h seconds, and the push-out speed.
void respond_plainly(std::span<const proxies::Capsule> before, std::span<const proxies::Capsule> colliders,
                     double offset, const std::vector<Vec3>& starts, double h, Particles& particles) {
  for (int i = 0; i < particles.count(); ++i)
    for (std::size_t c = 0; c < colliders.size(); ++c) {
      const proxies::Contact contact = proxies::signed_distance(particles.positions[i], colliders[c]);
      if (contact.distance >= offset) continue;
      const double most = (particles.positions[i] - starts[i]).norm() +
                          (std::max((colliders[c].a - before[c].a).norm(), (colliders[c].b - before[c].b).norm()) +
                           h * k_push_out_speed);
      particles.positions[i] += std::min(offset - contact.distance, most) * contact.normal;
      Vec3& v = particles.velocities[i];
      v -= v.dot(contact.normal) * contact.normal;
    }
}

/// The report's response: on the surface, without normal velocity.
void respond(ContactSearch& search, proxies::CollisionQuery& query, double s, std::span<const std::uint8_t> pinned,
             Particles& particles) {
  search.for_each_contact(
      query, s, pinned, particles,
      [&](int i, int, const proxies::Contact& contact, double push) {
        particles.positions[i] += push * contact.normal;
        Vec3& v = particles.velocities[i];
        v -= v.dot(contact.normal) * contact.normal;
        return Response{};
      },
      [](int, const BetweenColliders::Settled&) { return Response{}; });
}

void begin_frame(ContactSearch& search, proxies::CollisionQuery& query, const proxies::SweptColliders& colliders,
                 const Particles& particles, double seconds) {
  FrameInput input;
  input.colliders = colliders;
  input.seconds = seconds;
  search.begin_frame(query, input, particles);
}

proxies::Capsule random_capsule(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-0.5, 0.5), size(0.02, 0.15);
  const auto point = [&] { return Vec3(place(random), place(random), place(random)); };
  return {point(), point(), size(random)};
}

TEST(ContactSearch, IsThePlainSearchToTheBit) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-0.7, 0.7), speed(-2, 2);
  const double offset = 0.002, seconds = 1.0 / 60.0;
  const int substeps = 10;
  for (const proxies::Backend backend : {proxies::Backend::brute, proxies::Backend::hybrid, proxies::Backend::fcl}) {
    const auto query = proxies::make_query(backend);
    std::int64_t contacts = 0, queries = 0;
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<proxies::Capsule> start, end, placed(8);
      for (int c = 0; c < 8; ++c) {
        start.push_back(random_capsule(random));
        end.push_back(start.back());
        const Vec3 shift = 0.03 * Vec3(speed(random), speed(random), speed(random));
        end.back().a += shift;
        end.back().b -= 0.5 * shift;
      }
      Particles fast;
      for (int i = 0; i < 300; ++i) {
        fast.positions.emplace_back(place(random), place(random), place(random));
        fast.velocities.emplace_back(speed(random), speed(random), speed(random));
      }
      Particles plain = fast;
      const std::vector<std::uint8_t> pinned(300, 0);
      const proxies::SweptColliders colliders{start, end, std::nullopt};
      ContactSearch search(offset);
      begin_frame(search, *query, colliders, fast, seconds);
      std::vector<proxies::Capsule> before = start;
      for (int k = 0; k < substeps; ++k) {
        const double s = (k + 1.0) / substeps, h = (s - static_cast<double>(k) / substeps) * seconds;
        const std::vector<Vec3> starts = plain.positions;
        for (Particles* particles : {&fast, &plain})
          for (int i = 0; i < 300; ++i) particles->positions[i] += particles->velocities[i] * (seconds / substeps);
        respond(search, *query, s, pinned, fast);
        proxies::colliders_at(colliders, s, placed);
        respond_plainly(before, placed, offset, starts, h, plain);
        before = placed;
      }
      for (int i = 0; i < 300; ++i) {
        if (backend != proxies::Backend::fcl) {
          ASSERT_EQ(fast.positions[i], plain.positions[i]) << "trial " << trial << " particle " << i;
          ASSERT_EQ(fast.velocities[i], plain.velocities[i]);
        } else {
          ASSERT_LT((fast.positions[i] - plain.positions[i]).norm(), 1e-9) << "trial " << trial << " particle " << i;
        }
      }
      contacts += search.counts().contacts;
      queries += search.counts().queries;
    }
    EXPECT_GT(contacts, 2000);
    EXPECT_LT(queries, 20LL * 300 * 8 * substeps / 2);
  }
}

TEST(ContactSearch, ProjectsOntoSphereAndRoundedCylinder) {
  const auto query = proxies::make_query(proxies::Backend::fcl);
  const std::vector<proxies::Capsule> colliders = {{Vec3::Zero(), Vec3::Zero(), 0.1}, {{1, 0, 0}, {1, 1, 0}, 0.2}};
  Particles particles;
  particles.positions = {{0.05, 0, 0}, {1.1, 0.5, 0}, {1, 1.1, 0}, {1, 0.5, 0}, {3, 0, 0}, {0, 0, 0}};
  particles.velocities.assign(6, Vec3(-1, -2, 0.5));
  const std::vector<std::uint8_t> pinned = {0, 0, 0, 0, 0, 0};
  ContactSearch search(0.0);
  begin_frame(search, *query, {colliders, colliders, std::nullopt}, particles, 1.0); // time enough to come out
  respond(search, *query, 1.0, pinned, particles);
  EXPECT_LT((particles.positions[0] - Vec3(0.1, 0, 0)).norm(), 1e-14);
  EXPECT_LT((particles.velocities[0] - Vec3(0, -2, 0.5)).norm(), 1e-14);
  EXPECT_LT((particles.positions[1] - Vec3(1.2, 0.5, 0)).norm(), 1e-14);
  EXPECT_LT((particles.positions[2] - Vec3(1, 1.2, 0)).norm(), 1e-14);
  EXPECT_NEAR((particles.positions[3] - Vec3(1, 0.5, 0)).norm(), 0.2, 1e-14) << "on the axis: out sideways";
  EXPECT_NEAR(particles.positions[3].y(), 0.5, 1e-14);
  EXPECT_EQ(particles.positions[4], Vec3(3, 0, 0));
  EXPECT_EQ(particles.velocities[4], Vec3(-1, -2, 0.5));
  EXPECT_LT((particles.positions[5] - Vec3(0, 0.1, 0)).norm(), 1e-14) << "in the centre: up";
}

TEST(ContactSearch, PinnedParticlesAreLeftAlone) {
  const auto query = proxies::make_query(proxies::Backend::brute);
  const std::vector<proxies::Capsule> colliders = {{Vec3::Zero(), Vec3::Zero(), 0.1}};
  Particles particles;
  particles.positions = {{0.05, 0, 0}};
  particles.velocities = {{1, 2, 3}};
  ContactSearch search(0.0);
  begin_frame(search, *query, {colliders, colliders, std::nullopt}, particles, 1.0 / 60);
  respond(search, *query, 1.0, std::vector<std::uint8_t>{1}, particles);
  EXPECT_EQ(particles.positions[0], Vec3(0.05, 0, 0));
  EXPECT_EQ(particles.velocities[0], Vec3(1, 2, 3));
}

TEST(ContactSearch, ASpinningSurfaceMovesByItsShareOfTheFrame) {
  const auto query = proxies::make_query(proxies::Backend::brute);
  const std::vector<proxies::Capsule> colliders = {{Vec3::Zero(), Vec3::Zero(), 0.1}};
  const std::vector<Vec3> spin = {Vec3(0.02, 0, 0)};
  Particles particles;
  particles.positions = {{0, 0.1, 0}};
  particles.velocities = {Vec3::Zero()};
  ContactSearch search(0.0);
  begin_frame(search, *query, {colliders, colliders, std::nullopt, spin}, particles, 1.0 / 60);
  for (const double s : {0.25, 1.0}) {
    respond(search, *query, s, std::vector<std::uint8_t>{0}, particles);
    const double part = s == 0.25 ? 0.25 : 0.75;
    EXPECT_LT((search.surface_motion(0, Vec3(0, 0.1, 0)) - Vec3(0, 0, part * 0.02 * 0.1)).norm(), 1e-18);
  }
}

TEST(ContactSearch, TheGroundHoldsEvenWhatFallsFromFarAway) {
  const auto query = proxies::make_query(proxies::Backend::fcl);
  Particles particles;
  particles.positions = {{0, 5, 0}};
  particles.velocities = {{0, -1, 0}};
  ContactSearch search(0.001);
  begin_frame(search, *query, {{}, {}, proxies::Plane{Vec3::UnitY(), 0.0}}, particles, 1.0 / 60);
  particles.positions[0].y() = -3.0; // much farther than its speed promised
  respond(search, *query, 1.0, std::vector<std::uint8_t>{0}, particles);
  EXPECT_NEAR(particles.positions[0].y(), 0.001, 1e-15);
}

} // namespace
