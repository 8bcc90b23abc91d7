// Cloth against formulas, with default settings.
#include "src/study/bench/analytic_scenes.h"

#include <gtest/gtest.h>

using namespace tutu::app;

namespace {

void expect_all_pass(const std::vector<AnalyticFigure>& figures) {
  EXPECT_FALSE(figures.empty());
  for (const AnalyticFigure& f : figures)
    EXPECT_TRUE(f.passed()) << f.what << ": " << f.measured << " " << f.unit << ", expected " << f.expected
                            << " within " << f.tolerance;
}

TEST(Analytic, FreeFallIsExact) { expect_all_pass(free_fall({})); }
TEST(Analytic, FrictionHoldsAndSlidesWithinHalfADegree_slow) {
  for (int tenth = 1; tenth <= 10; ++tenth) expect_all_pass(slope(0.1 * tenth, {}));
}
TEST(Analytic, APendulumKeepsItsPeriodAndGainsNoEnergy) { expect_all_pass(pendulum({})); }
TEST(Analytic, ABandHangsAsACatenary) { expect_all_pass(catenary({})); }
TEST(Analytic, ASheetGivesByItsOwnWeight) { expect_all_pass(hang({})); }
TEST(Analytic, AShakenSheetGainsNoEnergy) { expect_all_pass(energy({})); }

TEST(Analytic, AFigureThatIsNoNumberFails) { EXPECT_FALSE((AnalyticFigure{"", "", std::nan(""), 0.0, 1.0}.passed())); }

} // namespace
