// Garments of one scene share colliders and nothing else: each in a thread of its own is each for itself. The thread
// sanitizer watches this one.
#include "cloth/recovery.h"
#include "tests/support/swinging_limbs.h"
#include "tests/support/woven_cases.h"

#include <gtest/gtest.h>
#include <thread>

using namespace tutu;
using namespace tutu::cloth;

namespace {

std::vector<std::uint64_t> hashes_of(const Garment& garment, std::size_t garments, bool side_by_side) {
  struct Own {
    GuardedSolver solver;
    std::unique_ptr<proxies::CollisionQuery> query;
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
      const auto step = [&] { EXPECT_FALSE(one.solver.step(input, *one.query).has_value()); };
      if (side_by_side) threads.emplace_back(step);
      else step();
    }
    for (std::thread& thread : threads) thread.join();
  }
  std::vector<std::uint64_t> hashes;
  for (const Own& one : own) hashes.push_back(state_hash(one.solver.particles()));
  return hashes;
}

TEST(SideBySide, GarmentsInThreadsOfTheirOwnGiveTheSameBits) {
  Garment garment = test::detail::tube(20, 45, {}, 0.8, std::nullopt);
  test::pin_first_row(garment);
  EXPECT_EQ(hashes_of(garment, 4, true), hashes_of(garment, 4, false));
}

} // namespace
