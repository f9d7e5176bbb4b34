#include "analysis/statistics/distributions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gauntlet::analysis {
namespace {

TEST(NormalDistribution, KeepsItsDigitsFarOutInTheTail) {
  EXPECT_EQ(NormalUpperTail(0.0), 0.5);
  EXPECT_NEAR(NormalUpperTail(10.0) / 7.619853024160527e-24, 1.0, 1e-13);  // R's pnorm
  EXPECT_NEAR(NormalQuantile(0.975), 1.9599639845400536, 1e-14);           // R's qnorm
  EXPECT_NEAR(NormalUpperTail(NormalQuantile(0.999)), 0.001, 1e-15);
}

TEST(StudentDistribution, AgreesWithTablesAndClosedForms) {
  // Critical values of printed tables.
  EXPECT_NEAR(StudentUpperTail(1.770933, 13), 0.05, 1e-7);
  EXPECT_NEAR(StudentUpperTail(2.228139, 10), 0.025, 1e-7);
  EXPECT_NEAR(StudentUpperTail(1.644854, 1e9), 0.05, 1e-6);
  EXPECT_NEAR(StudentUpperQuantile(0.025, 10), 2.228139, 1e-6);
  for (const double t : {0.0, 0.3, 1.0, 4.0, 50.0}) {
    EXPECT_NEAR(StudentUpperTail(t, 1), 0.5 - std::atan(t) / M_PI, 1e-12);  // Cauchy
    EXPECT_NEAR(StudentUpperTail(t, 2), 0.5 - t / (2.0 * std::sqrt(2.0 + t * t)), 1e-12);
    EXPECT_NEAR(StudentUpperTail(-t, 5), 1.0 - StudentUpperTail(t, 5), 1e-15);
  }
}

}  // namespace
}  // namespace gauntlet::analysis
