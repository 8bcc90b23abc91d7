// Garments of one scene share colliders and nothing else: each in a thread of its own is each for itself. The thread
// sanitizer watches this one.
#include "cloth/contact/contact_set.h"
#include "cloth/recovery.h"
#include "tests/support/irregular_tube.h"
#include "tests/support/swinging_limbs.h"
#include "tests/support/woven_cases.h"

#include <gtest/gtest.h>
#include <thread>

using namespace tutu;
using namespace tutu::cloth;

namespace {

/// What was kept, in its order, to the bit.
std::uint64_t hash_of(const ContactSet& kept) {
  Particles all;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const ClothContact& contact = kept[k];
    all.positions.push_back(contact.contact.closest);
    all.positions.emplace_back(contact.collider, contact.substep, contact.push);
    all.velocities.push_back(contact.moved);
    all.velocities.emplace_back(contact.particles[0], contact.particles[1], contact.particles[2]);
  }
  return state_hash(all);
}

/// Of the cloth, and of its contacts.
std::vector<std::uint64_t> hashes_of(const Garment& garment, std::size_t garments, bool side_by_side) {
  struct Own {
    GuardedSolver solver;
    std::unique_ptr<proxies::CollisionQuery> query;
    ContactSet kept = ContactSet(3000);
  };
  std::vector<Own> own;
  for (std::size_t g = 0; g < garments; ++g) {
    SolverOptions options;
    options.features = g % 2 == 0 ? ContactFeatures::automatic : ContactFeatures::triangles;
    own.push_back({GuardedSolver(make_solver(garment, options), garment),
                   proxies::make_query(g % 3 == 2 ? proxies::Backend::fcl : proxies::Backend::hybrid)});
  }
  test::SwingingLimbs limbs(garment, 40);
  for (int frame = 0; frame < 6; ++frame) {
    const FrameInput input = limbs.advance(6);
    std::vector<std::thread> threads;
    for (Own& one : own) {
      auto step = [&one, own_input = input]() mutable {
        own_input.contacts = &one.kept;
        EXPECT_FALSE(one.solver.step(own_input, *one.query).has_value());
      };
      if (side_by_side) threads.emplace_back(step);
      else step();
    }
    for (std::thread& thread : threads) thread.join();
  }
  std::vector<std::uint64_t> hashes;
  for (const Own& one : own) {
    EXPECT_GT(one.kept.size(), 100u);
    hashes.push_back(state_hash(one.solver.particles()));
    hashes.push_back(hash_of(one.kept));
  }
  return hashes;
}

TEST(SideBySide, GarmentsInThreadsOfTheirOwnGiveTheSameBits) {
  Garment garment = test::detail::tube(20, 45, {}, 0.8, std::nullopt);
  test::pin_first_row(garment);
  for (const Garment& each : {garment, test::irregular_tube(24)})
    EXPECT_EQ(hashes_of(each, 4, true), hashes_of(each, 4, false));
}

} // namespace
