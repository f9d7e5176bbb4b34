// What is observed of a program, without leases.
#include "master/dispatch/trust/reproducibility.h"

#include <gtest/gtest.h>

namespace gauntlet {
namespace {

TEST(ReproducibilityTest, OfGauntletsOwnRunsNothingIsObserved) {
  Reproducibility seen(Reproducible::kPromised);
  EXPECT_FALSE(seen.observed());
  EXPECT_FALSE(seen.first_ending_counts());
  EXPECT_FALSE(seen.Check(1, "a"));
}

TEST(ReproducibilityTest, ThreeRunsThatEndTheSameMakeItYesAndNameTheHosts) {
  Reproducibility seen(Reproducible::kUnknown);
  for (const proto::RunId run : {4U, 2U, 9U}) EXPECT_TRUE(seen.Check(run, "b"));
  EXPECT_FALSE(seen.Check(10, "b")) << "three are enough";
  seen.Same(2, "a");
  seen.Same(2, "a");
  seen.Same(77, "z");
  seen.Same(4, "b");
  EXPECT_EQ(seen.state(), Reproducible::kUnknown);
  EXPECT_TRUE(seen.first_ending_counts());
  EXPECT_FALSE(seen.TakeNews());
  seen.Same(9, "a");
  EXPECT_EQ(seen.state(), Reproducible::kYes);
  EXPECT_FALSE(seen.first_ending_counts());
  const auto news = seen.TakeNews();
  ASSERT_TRUE(news);
  EXPECT_EQ(news->text, "hosts a, b");
  EXPECT_FALSE(seen.TakeNews());
}

TEST(ReproducibilityTest, TheFirstDifferenceMakesItNoForGood) {
  for (const Reproducible known : {Reproducible::kUnknown, Reproducible::kYes}) {
    Reproducibility seen(known);
    for (const proto::RunId run : {1U, 2U, 3U}) seen.Check(run, "a");
    seen.Differs(17, "b");
    for (const proto::RunId run : {1U, 2U, 3U}) seen.Same(run, "a");
    EXPECT_EQ(seen.state(), Reproducible::kNo);
    EXPECT_TRUE(seen.first_ending_counts());
    const auto news = seen.TakeNews();
    ASSERT_TRUE(news);
    EXPECT_EQ(news->state, Reproducible::kNo);
    EXPECT_EQ(news->text, "run 17 ended differently when it was simulated again on b");
    seen.Differs(18, "c");
    EXPECT_FALSE(seen.TakeNews()) << "the first one is told";
    EXPECT_FALSE(seen.Check(4, "a"));
  }
}

TEST(ReproducibilityTest, OneHostAloneIsNamedToo) {
  Reproducibility seen(Reproducible::kUnknown);
  for (const proto::RunId run : {1U, 2U, 3U}) seen.Check(run, "a");
  for (const proto::RunId run : {1U, 2U, 3U}) seen.Same(run, "a");
  EXPECT_EQ(seen.TakeNews()->text, "host a");
}

}  // namespace
}  // namespace gauntlet
