// results.csv survives what happens to it: rows cut in the middle, rows that come twice, files of something else.
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/study/chart/results_file.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>
#include <random>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;
using ::testing::HasSubstr;

namespace {

Row row_named(const std::string& key, const std::string& reason = "") {
  Row row;
  row.set("key", key);
  row.set("outcome", "ok");
  row.set("reason", reason);
  row.set("ms_p99", 0.25);
  return row;
}

std::vector<std::string> keys_of(const Results& results) {
  std::vector<std::string> keys;
  for (const Row& row : results.rows) keys.push_back(row.text("key"));
  return keys;
}

class ResultsFile : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = scratch_folder();
    file_ = folder_ / "results.csv";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_, file_;
};

TEST_F(ResultsFile, ReadsBackWhatWasAdded) {
  EXPECT_THAT(read_results(file_).rows, ::testing::IsEmpty());
  add_row(file_, row_named("a", "diverged in frame 3, at \"skirt\"\nand more"));
  add_row(file_, row_named("b"));
  const Results results = read_results(file_);
  EXPECT_THAT(keys_of(results), ::testing::ElementsAre("a", "b"));
  EXPECT_THAT(results.notes, ::testing::IsEmpty());
  EXPECT_EQ(results.rows[0].text("reason"), "diverged in frame 3, at \"skirt\" and more");
  EXPECT_EQ(results.rows[0].number("ms_p99"), 0.25);
  EXPECT_EQ(results.rows[0].number("jitter"), std::nullopt);
}

TEST_F(ResultsFile, ColumnsOfAnotherVersionAreToldByTheFirstThatDiffers) {
  add_row(file_, row_named("a"));
  std::string text = read_file(file_);
  text.replace(text.find("longer_pct_max"), 14, "stretch_max");
  write_file(file_, text);
  const std::string place = std::to_string(std::find(row_columns().begin(), row_columns().end(), "longer_pct_max") -
                                           row_columns().begin() + 1);
  for (const bool adds : {false, true}) try {
      if (adds) add_row(file_, row_named("b"));
      else read_results(file_);
      ADD_FAILURE() << "an old file was taken";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(),
                  ::testing::AllOf(::testing::HasSubstr("line 1: found \"stretch_max\" as column " + place),
                                   ::testing::HasSubstr("here \"longer_pct_max\""),
                                   ::testing::HasSubstr("move the file away")));
    }
}

TEST_F(ResultsFile, CutAnywhereItLosesTheLastRowOnly) {
  for (const char* key : {"a", "b", "c"}) add_row(file_, row_named(key, "with, a comma"));
  const std::string whole = read_file(file_);
  const std::size_t last_row = whole.rfind('\n', whole.size() - 2) + 1;
  for (std::size_t size = last_row + 1; size < whole.size(); ++size) {
    write_file(file_, whole.substr(0, size));
    const Results cut = read_results(file_);
    EXPECT_THAT(keys_of(cut), ::testing::ElementsAre("a", "b")) << size;
    ASSERT_EQ(cut.notes.size(), 1u) << size;
    EXPECT_THAT(cut.notes[0], ::testing::AllOf(HasSubstr("results.csv: line 4: found a row cut off"),
                                               HasSubstr("expected " + std::to_string(row_columns().size()))));
    add_row(file_, row_named("d")); // comes on a line of its own
    const Results after = read_results(file_);
    EXPECT_THAT(keys_of(after), ::testing::ElementsAre("a", "b", "d")) << size;
    EXPECT_THAT(after.notes, ::testing::IsEmpty());
  }
}

TEST_F(ResultsFile, ACutFirstLineIsBegunAnew) {
  write_file(file_, "key,refer");
  EXPECT_THAT(read_results(file_).rows, ::testing::IsEmpty());
  add_row(file_, row_named("a"));
  EXPECT_THAT(keys_of(read_results(file_)), ::testing::ElementsAre("a"));
}

TEST_F(ResultsFile, DoublesAreIgnoredAndACrashGivesWay) {
  Row crashed = row_named("a");
  crashed.set("outcome", k_crashed);
  add_row(file_, crashed);
  add_row(file_, row_named("b", "first"));
  add_row(file_, row_named("a", "run again"));
  add_row(file_, row_named("b", "second"));
  add_row(file_, crashed);
  const Results results = read_results(file_);
  EXPECT_THAT(keys_of(results), ::testing::ElementsAre("a", "b"));
  EXPECT_EQ(results.rows[0].text("reason"), "run again");
  EXPECT_EQ(results.rows[1].text("reason"), "first");
}

TEST_F(ResultsFile, AFileOfOtherColumnsIsRefusedAndLeftAlone) {
  write_file(file_, "name,age\nx,3\n");
  for (const auto& use : {+[](const std::filesystem::path& f) { (void)read_results(f); },
                          +[](const std::filesystem::path& f) { add_row(f, row_named("a")); }}) {
    try {
      use(file_);
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(),
                  HasSubstr("results.csv: line 1: found \"name\" as column 1 of 2, expected the columns"));
    }
  }
  EXPECT_EQ(read_file(file_), "name,age\nx,3\n");
}

TEST(Csv, LinesReadBackWhateverIsInThem) {
  std::mt19937_64 random(5);
  const std::string letters = "ab,\" ;'";
  for (int round = 0; round < 500; ++round) {
    std::vector<std::string> values(1 + random() % 6);
    for (std::string& value : values)
      for (std::size_t n = random() % 6; n > 0; --n) value += letters[random() % letters.size()];
    const std::string line = csv_line(values);
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
    EXPECT_EQ(values_of_csv(line), values) << line;
  }
  EXPECT_EQ(values_of_csv("a,\"b"), std::nullopt);
}

} // namespace
