#include "controllers/flocking/flocking_metrics.h"

#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "rapidcheck/gtest.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::kPi;

double FitnessOf(const std::vector<double>& headings) {
  return FlockingFitness(AngularOrder(headings), static_cast<int>(headings.size()), 10, 5);
}

TEST(FlockingFitness, IsExactlyOneForTenAlignedBirds) {
  EXPECT_EQ(FitnessOf(std::vector<double>(10, 0.0)), 1.0);
}

// Thesis figure 4.4 (b).
TEST(FlockingFitness, IsExactlyNineTenthsWhenOneOfTenIsReversed) {
  std::vector<double> headings(10, 0.0);
  headings[3] = kPi;
  EXPECT_EQ(FitnessOf(headings), 0.9);
}

// Thesis figure 4.4 (c).
TEST(FlockingFitness, DropsALittleWhenOneOfTenTurnsByThirtyDegrees) {
  std::vector<double> headings(10, 1.0);
  headings[9] += 30.0 * kDegree;
  const double order = std::sqrt(std::pow(9.0 + std::cos(kPi / 6.0), 2) + 0.25) / 10.0;
  EXPECT_NEAR(FitnessOf(headings), (1.0 + order) / 2.0, 1e-14);
  EXPECT_NEAR(FitnessOf(headings), 0.993934, 5e-7);
}

// Thesis figure 4.4 (d).
TEST(FlockingFitness, IsExactlyNineTenthsWhenOneOfTenIsLost) {
  EXPECT_EQ(FitnessOf(std::vector<double>(9, -2.0)), 0.9);
}

TEST(FlockingFitness, IsZeroBelowTheMinimumSwarm) {
  EXPECT_EQ(FitnessOf(std::vector<double>(4, 0.0)), 0.0);
  EXPECT_EQ(FitnessOf(std::vector<double>(5, 0.0)), 0.5);
  EXPECT_EQ(FlockingFitness(0.0, 5, 10, 5), 0.25);
  EXPECT_EQ(FlockingFitness(1.0, 5, 10, 7), 0.0);
}

TEST(AngularOrder, IsZeroForOppositeHeadingsAndForNobody) {
  EXPECT_NEAR(AngularOrder(std::vector<double>{0.0, kPi / 2, kPi, -kPi / 2}), 0.0, 1e-15);
  EXPECT_EQ(AngularOrder({}), 0.0);
}

RC_GTEST_PROP(AngularOrder, AlignedBirdsHaveOrderOneWhateverTheirHeading, ()) {
  const auto birds = *rc::gen::inRange<std::size_t>(1, 30);
  const double heading = *rc::gen::inRange(-31415, 31415) / 10000.0;
  RC_ASSERT(AngularOrder(std::vector<double>(birds, heading)) == 1.0);
}

RC_GTEST_PROP(AngularOrder, OneReversedBirdCostsExactlyItsShare, ()) {
  std::vector<double> headings(10, *rc::gen::inRange(-31415, 31415) / 10000.0);
  double& reversed = headings[*rc::gen::inRange<std::size_t>(0, 10)];
  reversed = sim::WrapAngle(reversed + kPi);
  RC_ASSERT(FitnessOf(headings) == 0.9);
}

RC_GTEST_PROP(AngularOrder, AgreesWithTheFormulaAndIgnoresWhereZeroIs, ()) {
  const auto raw = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-31415, 31415)));
  std::vector<double> headings;
  double x = 0.0;
  double y = 0.0;
  for (const int value : raw) {
    headings.push_back(value / 10000.0);
    x += std::cos(headings.back());
    y += std::sin(headings.back());
  }
  RC_ASSERT(std::fabs(AngularOrder(headings) - std::hypot(x, y) / static_cast<double>(raw.size())) < 1e-13);
}

}  // namespace
}  // namespace gauntlet::controllers
