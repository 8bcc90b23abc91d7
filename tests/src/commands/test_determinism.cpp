// Same input, same bits: run after run, and in another process on any number of threads.
#include "src/study/bench/dancer_skirt.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"

#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

TEST(Determinism, DancerSkirtRunAfterRun) {
  std::uint64_t hashes[2] = {};
  for (std::uint64_t& hash : hashes) {
    DancerSkirt scene{DancerSkirtSetup{}};
    for (int frame = 0; frame < 90; ++frame) ASSERT_FALSE(scene.advance().has_value());
    hash = cloth::state_hash(scene.particles());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Determinism, TheDanceInAnotherProcess) {
  const auto folder = scratch_folder();
  std::vector<std::string> hashes;
  for (const char* threads : {"1", "1", "2", "4"}) {
    const std::string json = (folder / "run.json").string();
    const Outcome outcome = run_program({"play", source_file("assets/scenes/dance.json").string(), "--no-pictures",
                                         "--frames", "40", "--threads", threads, "--json", json});
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    std::ifstream file(json);
    hashes.push_back(nlohmann::json::parse(file).at("state_hash").get<std::string>());
    EXPECT_EQ(hashes.back(), hashes.front()) << threads << " threads";
  }
}

} // namespace
