#include "search/probability/confidence_sequence.h"

#include <gtest/gtest.h>

#include "analysis/statistics/proportions.h"
#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

TEST(ConfidenceSequenceTest, CoversAtAllTimesAtOnce) {
  constexpr int kSequences = 200;
  for (const double p : {0.3, 0.03, 1e-3}) {
    int covered = 0;
    for (std::uint32_t i = 0; i < kSequences; ++i) {
      sim::RandomStream random(i, sim::StreamPurpose::kTest, static_cast<std::uint32_t>(1.0 / p));
      std::uint64_t hits = 0;
      bool inside = true;
      for (std::uint64_t n = 1; n <= 5000; ++n) {
        hits += random.Chance(p);
        if (n % (1 + n / 20) != 0) continue;  // ends hardly move in between
        const analysis::Interval interval = ConfidenceSequence(hits, n, 0.95);
        inside = inside && interval.low <= p && p <= interval.high;
      }
      covered += inside;
    }
    EXPECT_GE(covered, 0.935 * kSequences) << p;
  }
}

TEST(ConfidenceSequenceTest, IsAtMostTwiceAsWideAsForAFixedNumber) {
  for (const std::uint64_t trials : {1000U, 10'000U, 100'000U}) {
    for (const double p : {0.3, 0.03, 0.01}) {
      const auto hits = static_cast<std::uint64_t>(p * static_cast<double>(trials));
      const analysis::Interval anytime = ConfidenceSequence(hits, trials, 0.95);
      const analysis::Interval fixed = analysis::WilsonInterval(static_cast<std::uint32_t>(hits),
                                                                static_cast<std::uint32_t>(trials), 0.95);
      EXPECT_LE(anytime.high - anytime.low, 2.001 * (fixed.high - fixed.low)) << p << " " << trials;
      EXPECT_LT(anytime.low, fixed.low);
      EXPECT_GT(anytime.high, fixed.high);
    }
  }
}

TEST(ConfidenceSequenceTest, KnowsItsEnds) {
  EXPECT_EQ(ConfidenceSequence(0, 0, 0.95).high, 1.0);
  const analysis::Interval none = ConfidenceSequence(0, 1000, 0.95);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_GT(none.high, 3.0 / 1000);  // what is sure of a fixed number (rule of three)
  EXPECT_LT(none.high, 7.4 / 1000);  // twice the two-sided one
  const analysis::Interval one = ConfidenceSequence(1, 1000, 0.95);
  EXPECT_GT(one.low, 1e-8);
  EXPECT_LT(one.low, 25e-6);  // what is sure of a fixed number: 1 - .975^(1/1000)
  const analysis::Interval all = ConfidenceSequence(1000, 1000, 0.95);
  EXPECT_EQ(all.high, 1.0);
  EXPECT_NEAR(all.low, 1.0 - none.high, 1e-9);
}

TEST(StudentQuantileTest, IsNearTheTable) {
  EXPECT_NEAR(StudentQuantile(0.975, 9), 2.262, 0.003);
  EXPECT_NEAR(StudentQuantile(0.975, 29), 2.045, 0.001);
  EXPECT_NEAR(StudentQuantile(0.995, 19), 2.861, 0.003);
}

}  // namespace
}  // namespace gauntlet
