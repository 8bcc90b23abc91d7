// Cloth comes to rest as its fabric says, in any number of substeps.
#include "src/study/bench/swing.h"

#include <gtest/gtest.h>

namespace tutu::app {
namespace {

void expect_all(bool is_double, int substeps) {
  RunSettings setup;
  setup.substeps = substeps;
  setup.double_precision = is_double;
  for (const AnalyticFigure& figure : swing(setup)) {
    EXPECT_TRUE(figure.passed()) << figure.what << ": " << figure.measured << " " << figure.unit << ", expected "
                                 << figure.expected << " within " << figure.tolerance;
  }
}

TEST(Swing, DecaysAlikeInAnyNumberOfSubsteps_slow) {
  for (const int substeps : {12, 24}) // in 9 a shear and a swing are 11 and 12 % off, in 6 all more
    for (const bool is_double : {false, true}) {
      SCOPED_TRACE(std::to_string(substeps) + (is_double ? " substeps, double" : " substeps, float"));
      expect_all(is_double, substeps);
    }
}

} // namespace
} // namespace tutu::app
