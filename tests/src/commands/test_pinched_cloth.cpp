// The shipped walk: her top has no room between arm and torso, and is not torn there.
#include "rig/io/file_io.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tutu;
using namespace tutu::test;
using nlohmann::json;

namespace {

TEST(PinchedCloth, IsNotTornUnderTheArmsOfTheWalk) {
  const auto folder = scratch_folder();
  const std::string file = (folder / "figures.json").string();
  const Outcome outcome =
      run_program({"play", TUTU_SOURCE_DIR "/assets/scenes/walk.json", "--headless", "--no-pictures", "--json", file});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const json figures = json::parse(read_file(file));
  EXPECT_LE(figures["longer_pct"]["max"].get<double>(), 20.0) << "461 where one proxy pushed after the other";
  EXPECT_LE(figures["penetration_mm"]["proxies"]["max"].get<double>(), 25.0);
  std::filesystem::remove_all(folder);
}

} // namespace
