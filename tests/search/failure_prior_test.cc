#include "search/archive/failure_prior.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace gauntlet {
namespace {

// So many first runs, and second runs of layouts that failed their first one; how many failed.
FailurePrior PriorOf(int first_failures, int first_runs, int second_failures, int second_runs) {
  const FailureTally passed{.passes = 1};
  const FailureTally failed{.failures = 1};
  FailurePrior prior;
  for (int i = 0; i < first_runs; ++i) prior.Learn({}, i < first_failures ? failed : passed);
  for (int i = 0; i < second_runs; ++i) prior.Learn(failed, i < second_failures ? failed : passed);
  return prior;
}

TEST(FailurePriorTest, BeginsWithOneOfThreeFirstRunsAndTwoOfThreeSecondOnes) {
  const FailurePrior prior;  // Beta(1/3, 2/3)
  EXPECT_DOUBLE_EQ(prior.Expected({}), 1.0 / 3);
  EXPECT_DOUBLE_EQ(prior.Expected({.failures = 1}), 2.0 / 3);
  EXPECT_DOUBLE_EQ(prior.Expected({.failures = 3}), (1.0 / 3 + 3) / 4);
  EXPECT_DOUBLE_EQ(prior.Expected({.failures = 4, .passes = 1, .errors = 1}), (1.0 / 3 + 4) / 7);
}

TEST(FailurePriorTest, ThreeFailuresAreLuckWhereLayoutsFailNowAndThenAndNoneWhereTheyRepeat) {
  // Beta(0.5, 1.5): a quarter fails, of these half again.
  const FailurePrior now_and_then = PriorOf(249, 997, 123, 247);
  EXPECT_NEAR(now_and_then.Expected({.failures = 3}), 3.5 / 5, 1e-9);
  EXPECT_NEAR(now_and_then.Expected({.failures = 5, .passes = 3}), 5.5 / 10, 1e-9);
  // Beta(0.125, 0.125): half fail, of these nine of ten again.
  const FailurePrior always = PriorOf(499, 997, 898, 997);
  EXPECT_NEAR(always.Expected({.failures = 3}), 3.125 / 3.25, 1e-9);
}

TEST(FailurePriorTest, LearnsFromFirstRunsAndFromSecondOnesOfWhatFailed) {
  FailurePrior prior;
  const double before = prior.Expected({});
  prior.Learn({.passes = 1}, {.failures = 1});
  prior.Learn({.failures = 2}, {.passes = 1});
  EXPECT_EQ(prior.Expected({}), before);
  prior.Learn({}, {.passes = 1, .errors = 1});
  EXPECT_DOUBLE_EQ(prior.Expected({}), 0.2) << "(1 + 0) / (3 + 2)";
}

TEST(FailurePriorTest, SurvivesBeingSaved) {
  const FailurePrior prior = PriorOf(3, 7, 2, 3);
  CanonicalEncoder encoder;
  prior.Save(encoder);
  CanonicalDecoder decoder(encoder.bytes());
  FailurePrior restored;
  restored.Restore(decoder);
  EXPECT_TRUE(decoder.ok() && decoder.AtEnd());
  EXPECT_EQ(restored.Expected({.failures = 1}), prior.Expected({.failures = 1}));
}

RC_GTEST_PROP(FailurePriorProperty, IsAProbabilityThatRisesWithFailuresAndFallsWithPasses, ()) {
  const int first = *rc::gen::inRange(0, 100);
  const int second = *rc::gen::inRange(0, 100);
  const FailurePrior prior =
      PriorOf(*rc::gen::inRange(0, first + 1), first, *rc::gen::inRange(0, second + 1), second);
  const FailureTally tally{.failures = *rc::gen::inRange(0, 10), .passes = *rc::gen::inRange(0, 10)};
  const double expected = prior.Expected(tally);
  RC_ASSERT(expected > 0.0 && expected < 1.0);
  RC_ASSERT(prior.Expected({.failures = tally.failures + 1, .passes = tally.passes}) > expected);
  RC_ASSERT(prior.Expected({.failures = tally.failures, .passes = tally.passes + 1}) < expected);
}

}  // namespace
}  // namespace gauntlet
