// The converged truth: made once, shown converged, kept, gone on with after an interrupt, and never taken for
// another's.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/scene/load.h"
#include "src/study/chart/reference.h"
#include "src/study/chart/reference_file.h"
#include "tests/support/paths.h"
#include "tests/support/small_scene.h"

#include <gmock/gmock.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

namespace fs = std::filesystem;

class ReferenceRuns : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = scratch_folder();
    cache_ = folder_ / "cache";
    scene_ = load_scene(read_scene(write_small_scene(folder_)));
    plan_.substeps = {4, 8, 16};
    plan_.protocol = {6, 3, 3, 3};
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::optional<Reference> obtain(const std::function<bool()>& go_on = [] { return true; }) {
    return obtain_reference(
        scene_, plan_, cache_, 2,
        [&]() -> std::optional<GarmentPositions> {
          ++made_;
          return GarmentPositions{scene_.garments[0].rest_positions};
        },
        go_on);
  }
  std::string fingerprint() const { return reference_fingerprint(scene_, plan_); }
  std::vector<std::string> cached() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(cache_)) names.push_back(entry.path().filename().string());
    return names;
  }
  void expect_refused(const ::testing::Matcher<std::string>& message) {
    try {
      obtain();
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), message);
    }
  }

  fs::path folder_, cache_;
  LoadedScene scene_;
  ReferencePlan plan_;
  int made_ = 0;
};

TEST_F(ReferenceRuns, IsRefinedTwiceAndComesCloser) {
  for (cloth::Garment& garment : scene_.garments) garment.fabric.damping = 0.02; // the fabric's in all these substeps
  const auto reference = obtain();
  ASSERT_TRUE(reference.has_value());
  ASSERT_EQ(reference->refinements.size(), 2u);
  const Refinement &first = reference->refinements[0], &second = reference->refinements[1];
  EXPECT_EQ(first.from, 4);
  EXPECT_EQ(second.to, 16);
  EXPECT_GT(first.trajectory_rms, 0.0);
  EXPECT_LT(second.trajectory_rms, 0.8 * first.trajectory_rms);
  EXPECT_LE(second.trajectory_rms, second.trajectory_max);
  EXPECT_EQ(reference->trajectory.moments.size(), 2u);
  EXPECT_THAT(convergence_text(*reference), HasSubstr("8 to   16 substeps"));
}

TEST_F(ReferenceRuns, IsMadeOnceAndReadsBackTheSame) {
  const auto made = obtain();
  const auto kept = obtain();
  ASSERT_TRUE(made && kept);
  EXPECT_EQ(made_, 1);
  EXPECT_THAT(cached(), ::testing::ElementsAre("small-" + fingerprint() + ".json")); // no level, no temporary
  ASSERT_EQ(kept->trajectory.moments.size(), made->trajectory.moments.size());
  for (std::size_t m = 0; m < made->trajectory.moments.size(); ++m) {
    EXPECT_EQ(kept->trajectory.moments[m].touching, made->trajectory.moments[m].touching);
    for (std::size_t i = 0; i < made->start[0].size(); ++i)
      EXPECT_LT((kept->trajectory.moments[m].positions[0][i] - made->trajectory.moments[m].positions[0][i]).norm(),
                1e-6);
  }
  EXPECT_EQ(kept->start, made->start);
  EXPECT_EQ(kept->refinements[1].drape_rms, made->refinements[1].drape_rms);
}

TEST_F(ReferenceRuns, InterruptedItGoesOnWithTheLevelThatIsMissing) {
  int asked = 0;
  // One after the other, the longest first: 12 frames of 16 substeps, then some of 8.
  const auto stop_in_the_second = [&] { return ++asked <= 18; };
  const auto none = obtain_reference(
      scene_, plan_, cache_, 1, [&] { return std::optional(GarmentPositions{scene_.garments[0].rest_positions}); },
      stop_in_the_second);
  EXPECT_FALSE(none.has_value());
  EXPECT_THAT(cached(), ::testing::ElementsAre("small-" + fingerprint() + ".level-16.json"));
  int frames = 0;
  const auto whole = obtain_reference(
      scene_, plan_, cache_, 1, [&] { return std::optional(GarmentPositions{scene_.garments[0].rest_positions}); },
      [&] { return ++frames > 0; });
  EXPECT_TRUE(whole.has_value());
  EXPECT_EQ(frames, 2 * (12 + 1)); // two levels
  EXPECT_THAT(cached(), ::testing::ElementsAre("small-" + fingerprint() + ".json"));
}

TEST_F(ReferenceRuns, OfAnotherSceneItIsRefused) {
  const LoadedScene other = load_scene(read_scene(write_small_scene(folder_, "other", 0.3)));
  ASSERT_TRUE(obtain().has_value());
  const fs::path mine = reference_path(cache_, scene_, plan_), wanted = reference_path(cache_, other, plan_);
  EXPECT_NE(mine, wanted);
  fs::copy_file(mine, wanted);
  scene_ = other;
  expect_refused(AllOf(HasSubstr(wanted.string() + ": /fingerprint: found a reference of small"),
                       HasSubstr("expected that of other")));
}

TEST_F(ReferenceRuns, KnowsWhatItDependsOn) {
  const std::string before = fingerprint();
  plan_.protocol.every = 2;
  EXPECT_NE(fingerprint(), before);
  plan_.protocol.every = 3;
  EXPECT_EQ(fingerprint(), before);
  scene_.garments[0].fabric.thickness *= 2.0;
  EXPECT_NE(fingerprint(), before);
}

TEST_F(ReferenceRuns, MadeUpOfOtherGarmentsItIsRefusedThoughItsChecksumFits) {
  const Reference whole = *obtain();
  const fs::path file = reference_path(cache_, scene_, plan_);
  const auto refused = [&](const std::function<void(Reference&)>& change, const std::string& message) {
    Reference other = whole;
    change(other);
    write_reference(other, file);
    expect_refused(HasSubstr(message));
  };
  refused([](Reference& r) { r.trajectory.moments[1].positions.clear(), r.trajectory.moments[1].touching.clear(); },
          "/moments/1/positions_um: found [] particles, expected [81]");
  refused([](Reference& r) { r.start[0].pop_back(); }, "/start: found positions of other garments");
  refused([](Reference& r) { r.start.clear(); }, "/start: found 0 garments, expected 1");
  refused(
      [](Reference& r) {
        for (Trajectory::Moment& moment : r.trajectory.moments)
          moment.positions[0].pop_back(), moment.touching[0].pop_back();
        r.trajectory.drape[0].pop_back();
      },
      "/drape_um: found positions of other garments, expected those of small");
}

TEST_F(ReferenceRuns, DamagedItIsToldWithItsPlace) {
  ASSERT_TRUE(obtain().has_value());
  const fs::path file = reference_path(cache_, scene_, plan_);
  const std::string whole = read_file(file);
  write_file(file, whole.substr(0, whole.size() / 2));
  expect_refused(AllOf(HasSubstr(file.string()), HasSubstr("line 1")));
  std::string changed = whole;
  const std::size_t digit = changed.find_first_of("123456789", changed.find("\"drape_um\":[[") + 13);
  changed[digit] = changed[digit] == '1' ? '2' : '1';
  write_file(file, changed);
  expect_refused(AllOf(HasSubstr(": /checksum: found "), HasSubstr("delete the file")));
  std::string shorter = whole;
  const std::size_t flags = shorter.find("\"touching\":[\"") + 13;
  shorter.erase(flags, 1);
  write_file(file, shorter);
  expect_refused(AllOf(HasSubstr("/moments/0/touching/0: found 80 characters, expected 81")));
}

} // namespace
