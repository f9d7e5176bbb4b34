#include "analysis/statistics/survival.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace gauntlet::analysis {
namespace {

constexpr bool kCutOff = false;

// Weeks until a relapse of leukaemia (Miller 1981, p. 49), the example of R's survfit: `aml`.
const std::vector<Duration> kMaintained = {{9},  {13}, {13, kCutOff}, {18}, {23},          {28, kCutOff},
                                           {31}, {34}, {45, kCutOff}, {48}, {161, kCutOff}};
const std::vector<Duration> kNotMaintained = {{5},  {5},  {8},  {8},  {12}, {16, kCutOff},
                                              {23}, {27}, {30}, {33}, {43}, {45}};

// What summary(survfit(Surv(time, status) ~ x, data = aml)) prints.
TEST(KaplanMeierTest, AgreesWithRsExample) {
  const SurvivalCurve curve = KaplanMeier(kMaintained, 0.95);
  struct Printed {
    double time;
    std::size_t at_risk;
    double survival;
    double low;
    double high;
  };
  const std::vector<Printed> printed = {{9, 11, 0.909, 0.7541, 1.000}, {13, 10, 0.818, 0.6192, 1.000},
                                        {18, 8, 0.716, 0.4884, 1.000}, {23, 7, 0.614, 0.3769, 0.999},
                                        {31, 5, 0.491, 0.2549, 0.946}, {34, 4, 0.368, 0.1549, 0.875},
                                        {48, 2, 0.184, 0.0359, 0.944}};
  ASSERT_EQ(curve.steps.size(), printed.size());
  for (std::size_t i = 0; i < printed.size(); ++i) {
    EXPECT_EQ(curve.steps[i].time, printed[i].time);
    EXPECT_EQ(curve.steps[i].at_risk, printed[i].at_risk);
    EXPECT_EQ(curve.steps[i].happened, 1U);
    EXPECT_NEAR(curve.steps[i].survival, printed[i].survival, 5.1e-4);
    EXPECT_NEAR(curve.steps[i].interval.low, printed[i].low, 5.1e-5);
    EXPECT_NEAR(curve.steps[i].interval.high, printed[i].high, 5.1e-4);
  }
  EXPECT_EQ(curve.median, 31);
  EXPECT_EQ(curve.median_low, 18);
  EXPECT_EQ(curve.median_high, std::nullopt);

  const SurvivalCurve other = KaplanMeier(kNotMaintained, 0.95);
  EXPECT_EQ(other.median, 23);
  EXPECT_EQ(other.median_low, 8);
  EXPECT_EQ(other.median_high, std::nullopt);
  EXPECT_EQ(other.steps.back().survival, 0.0);
}

// Ties of both kinds, in full: survfit of the R package survival 3.5-3, R 4.2.2.
TEST(KaplanMeierTest, AgreesWithRToTheLastDigitsWithTies) {
  const std::vector<Duration> runs = {
      {12}, {30}, {30},           {45, kCutOff},  {60},           {60},          {60, kCutOff},
      {75}, {90}, {120, kCutOff}, {120, kCutOff}, {120, kCutOff}, {120, kCutOff}};
  const std::vector<SurvivalStep> expected = {
      {12, 13, 1, 0.92307692307692313, {0.78901857586524304, 1.0}},
      {30, 12, 2, 0.76923076923076927, {0.57114956567098019, 1.0}},
      {60, 9, 2, 0.59829059829059839, {0.37810226281637677, 0.94670589204264921}},
      {75, 6, 1, 0.49857549857549865, {0.27861187385558550, 0.89220004998298685}},
      {90, 5, 1, 0.39886039886039892, {0.19250170250516352, 0.82643226376041656}}};
  const SurvivalCurve curve = KaplanMeier(runs, 0.95);
  ASSERT_EQ(curve.steps.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(curve.steps[i].time, expected[i].time);
    EXPECT_EQ(curve.steps[i].at_risk, expected[i].at_risk);
    EXPECT_EQ(curve.steps[i].happened, expected[i].happened);
    EXPECT_NEAR(curve.steps[i].survival, expected[i].survival, 1e-12);
    EXPECT_NEAR(curve.steps[i].interval.low, expected[i].interval.low, 1e-12);
    EXPECT_NEAR(curve.steps[i].interval.high, expected[i].interval.high, 1e-12);
  }
  EXPECT_EQ(curve.median, 75);
  EXPECT_EQ(curve.median_low, 60);
  EXPECT_EQ(curve.median_high, std::nullopt);
}

TEST(KaplanMeierTest, WithoutCutTimesTheMedianIsThatOfTheValues) {
  EXPECT_EQ(KaplanMeier(std::vector<Duration>{{3}, {1}, {2}}, 0.95).median, 2);
  EXPECT_EQ(KaplanMeier(std::vector<Duration>{{3}, {1}, {2}, {6}}, 0.95).median, 2.5);
  EXPECT_EQ(KaplanMeier(std::vector<Duration>{{4}}, 0.95).median, 4);
}

// Runs of an hour of which fewer than half converge: all that is known is "longer than an hour".
TEST(KaplanMeierTest, HasNoMedianWhereFewerThanHalfHappened) {
  const std::vector<Duration> runs = {{900}, {1200}, {3600, kCutOff}, {3600, kCutOff}, {3600, kCutOff}};
  const SurvivalCurve curve = KaplanMeier(runs, 0.95);
  EXPECT_EQ(curve.median, std::nullopt);
  EXPECT_EQ(curve.steps.size(), 2U);
  EXPECT_NEAR(curve.steps.back().survival, 0.6, 1e-12);
  EXPECT_EQ(KaplanMeier(std::vector<Duration>{{3600, kCutOff}}, 0.95).steps.size(), 0U);
}

// One that is cut off at the time of an event was still at risk at it.
TEST(KaplanMeierTest, EventsComeBeforeCutsOfTheSameTime) {
  const SurvivalCurve curve = KaplanMeier(std::vector<Duration>{{5, kCutOff}, {5}, {7}}, 0.95);
  EXPECT_EQ(curve.steps.front().at_risk, 3U);
  EXPECT_NEAR(curve.steps.front().survival, 2.0 / 3.0, 1e-12);
}

}  // namespace
}  // namespace gauntlet::analysis
