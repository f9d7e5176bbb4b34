#include "sim/random/random_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace gauntlet::sim {
namespace {

using ::testing::ElementsAre;

RandomStream TestStream(std::uint64_t seed, std::uint32_t a = 0, std::uint32_t b = 0) {
  return RandomStream(seed, StreamPurpose::kTest, a, b);
}

double Correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    syy += y[i] * y[i];
    sxy += x[i] * y[i];
  }
  return (n * sxy - sx * sy) / std::sqrt((n * sxx - sx * sx) * (n * syy - sy * sy));
}

// The known answers that Random123 publishes for philox4x32, 10 rounds: zeros, ones, digits of pi.
TEST(PhiloxTest, GivesThePublishedAnswers) {
  EXPECT_THAT(Philox4x32({0, 0, 0, 0}, {0, 0}), ElementsAre(0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_THAT(Philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
              ElementsAre(0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd));
  EXPECT_THAT(Philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              ElementsAre(0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1));
}

TEST(RandomStreamTest, HandsOutTheWordsOfItsBlocksInOrder) {
  constexpr std::uint64_t kSeed = 0x1122334455667788;
  RandomStream random(kSeed, StreamPurpose::kController, 5, 6);
  for (std::uint32_t block = 0; block < 3; ++block) {
    for (const std::uint32_t word : Philox4x32({block, 2, 5, 6}, {0x55667788, 0x11223344})) {
      EXPECT_EQ(random.NextUint32(), word);
    }
  }
}

TEST(RandomStreamTest, ACopyContinuesFromTheSamePlace) {
  RandomStream random = TestStream(1);
  random.NextUint32();
  RandomStream copy = random;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(copy.NextUint64(), random.NextUint64());
}

TEST(RandomStreamTest, EveryPartOfTheNameGivesAnotherStream) {
  std::set<std::uint64_t> firsts;
  for (const std::uint64_t seed : {0ULL, 1ULL, 1ULL << 32, 1ULL << 63}) {
    for (const StreamPurpose purpose : {StreamPurpose::kSpawn, StreamPurpose::kController}) {
      for (const std::uint32_t a : {0u, 1u, 7u}) {
        for (const std::uint32_t b : {0u, 1u, 7u})
          firsts.insert(RandomStream(seed, purpose, a, b).NextUint64());
      }
    }
  }
  EXPECT_EQ(firsts.size(), 4u * 2u * 3u * 3u);
}

// Stored runs depend on these very numbers.
TEST(RandomStreamTest, NumbersNeverChange) {
  RandomStream random(1, StreamPurpose::kSpawn, 2, 3);
  EXPECT_EQ(random.NextUint32(), 0x32f35f1au);
  EXPECT_EQ(random.NextUint32(), 0x264fb795u);
  EXPECT_EQ(random.NextUint32(), 0x6b4fc739u);
  EXPECT_EQ(random.NextUint32(), 0x0c3c3c5cu);
  EXPECT_EQ(random.Uniform(), 0.83540900527382156);
  EXPECT_EQ(random.Uniform(-3.0, 3.0), -1.9852021272600793);
  EXPECT_EQ(random.Below(360), 340u);
  EXPECT_EQ(random.Gaussian(), -1.6960301821592167);
}

RC_GTEST_PROP(RandomStreamTest, UniformStaysInItsRange, (std::uint64_t seed)) {
  const double low = static_cast<double>(*rc::gen::inRange(-1000, 1000)) / 7.0;
  const double width = std::pow(10.0, *rc::gen::inRange(-15, 5));
  RandomStream random = TestStream(seed);
  for (int i = 0; i < 50; ++i) {
    const double value = random.Uniform(low, low + width);
    RC_ASSERT(value >= low);
    RC_ASSERT(value < low + width || low + width == low);
    const double unit = random.Uniform();
    RC_ASSERT(unit >= 0.0 && unit < 1.0);
  }
}

TEST(RandomStreamTest, AnEmptyRangeGivesItsOnlyPoint) {
  EXPECT_EQ(TestStream(3).Uniform(2.5, 2.5), 2.5);
}

TEST(RandomStreamTest, ARangeOfTwoNeighboursNeverGivesTheUpperOne) {
  const double high = std::nextafter(1.0, 2.0);
  RandomStream random = TestStream(3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(random.Uniform(1.0, high), 1.0);
}

// Pearson's chi-square over `bound` cells; for many cells it is normal with mean k - 1 and variance 2 (k -
// 1).
TEST(RandomStreamTest, BelowIsUniform) {
  for (const std::uint32_t bound : {2u, 3u, 10u, 360u, 1000u}) {
    constexpr int kDraws = 400'000;
    std::vector<int> counts(bound, 0);
    RandomStream random = TestStream(11, bound);
    for (int i = 0; i < kDraws; ++i) {
      const std::uint32_t value = random.Below(bound);
      ASSERT_LT(value, bound);
      ++counts[value];
    }
    const double expected = static_cast<double>(kDraws) / bound;
    double chi_square = 0.0;
    for (const int count : counts) chi_square += (count - expected) * (count - expected) / expected;
    const double freedom = bound - 1.0;
    EXPECT_LT(chi_square, freedom + 4.0 * std::sqrt(2.0 * freedom)) << bound;
    EXPECT_GT(chi_square, freedom - 4.0 * std::sqrt(2.0 * freedom)) << bound;
  }
}

// With 3 * 2^30 values, taking a 32-bit word modulo the bound would give the lower third twice as often.
TEST(RandomStreamTest, BelowHasNoBiasForLargeBounds) {
  constexpr std::uint32_t kBound = 3u << 30;
  constexpr int kDraws = 90'000;
  int lower_third = 0;
  RandomStream random = TestStream(12);
  for (int i = 0; i < kDraws; ++i) lower_third += random.Below(kBound) < (kBound / 3) ? 1 : 0;
  // Standard deviation: sqrt(n p (1 - p)) = 141.
  EXPECT_NEAR(lower_third, kDraws / 3, 4 * 141);
}

TEST(RandomStreamTest, BelowOneIsAlwaysZero) {
  RandomStream random = TestStream(13);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(random.Below(1), 0u);
}

TEST(RandomStreamTest, ChanceHappensAsOftenAsAsked) {
  RandomStream random = TestStream(14);
  int happened = 0;
  for (int i = 0; i < 100'000; ++i) happened += random.Chance(0.05) ? 1 : 0;
  EXPECT_NEAR(happened, 5000, 4 * 69);
  EXPECT_FALSE(random.Chance(0.0));
  EXPECT_TRUE(random.Chance(1.0));
}

TEST(RandomStreamTest, GaussianHasTheMomentsAndTailsOfTheNormalDistribution) {
  constexpr int kDraws = 400'000;
  RandomStream random = TestStream(15);
  double sum = 0, squares = 0, cubes = 0, fourth = 0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double g = random.Gaussian();
    sum += g;
    squares += g * g;
    cubes += g * g * g;
    fourth += g * g * g * g;
    beyond_two += std::fabs(g) > 2.0 ? 1 : 0;
  }
  const double root = std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(sum / kDraws, 0.0, 4.0 / root);
  EXPECT_NEAR(squares / kDraws, 1.0, 4.0 * std::sqrt(2.0) / root);
  EXPECT_NEAR(cubes / kDraws, 0.0, 4.0 * std::sqrt(15.0) / root);
  EXPECT_NEAR(fourth / kDraws, 3.0, 4.0 * std::sqrt(96.0) / root);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kDraws, 0.0455003, 4.0 * 0.2084 / root);
}

TEST(RandomStreamTest, NeighbouringStreamsAreUncorrelated) {
  constexpr int kDraws = 20'000;
  const auto draw = [](RandomStream random) {
    std::vector<double> values(kDraws);
    for (double& value : values) value = random.Uniform();
    return values;
  };
  const std::vector<double> base = draw(TestStream(100, 4, 9));
  const double limit = 4.0 / std::sqrt(static_cast<double>(kDraws));
  EXPECT_LT(std::fabs(Correlation(base, draw(TestStream(101, 4, 9)))), limit) << "next seed";
  EXPECT_LT(std::fabs(Correlation(base, draw(TestStream(100, 5, 9)))), limit) << "next robot";
  EXPECT_LT(std::fabs(Correlation(base, draw(TestStream(100, 4, 10)))), limit) << "next tick";
  EXPECT_LT(std::fabs(Correlation(base, draw(RandomStream(100, StreamPurpose::kStatistics, 4, 9)))), limit);
  std::vector<double> shifted(base.begin() + 1, base.end());
  shifted.push_back(base.front());
  EXPECT_LT(std::fabs(Correlation(base, shifted)), limit) << "next draw";
}

// A robot draws few numbers in a tick: the first numbers of consecutive ticks must be as good as one stream.
TEST(RandomStreamTest, FirstNumbersOfConsecutiveTicksAreUniformAndUncorrelated) {
  constexpr int kTicks = 50'000;
  std::vector<double> first;
  std::vector<int> counts(100, 0);
  for (std::uint32_t tick = 0; tick < kTicks; ++tick) {
    first.push_back(RandomStream(1, StreamPurpose::kController, 3, tick).Uniform());
    ++counts[static_cast<std::size_t>(first.back() * 100.0)];
  }
  double chi_square = 0.0;
  for (const int count : counts) chi_square += (count - 500.0) * (count - 500.0) / 500.0;
  EXPECT_LT(chi_square, 99.0 + 4.0 * std::sqrt(198.0));
  std::vector<double> next(first.begin() + 1, first.end());
  next.push_back(first.front());
  EXPECT_LT(std::fabs(Correlation(first, next)), 4.0 / std::sqrt(static_cast<double>(kTicks)));
}

TEST(DeriveSeedTest, IsDistinctOverALargeGridOfArguments) {
  std::vector<std::uint64_t> seeds;
  for (const std::uint64_t campaign : {0ULL, 1ULL, 2ULL, 1ULL << 40}) {
    for (int purpose = 1; purpose <= 5; ++purpose) {
      for (std::uint32_t search = 0; search < 5; ++search) {
        for (std::uint64_t individual = 0; individual < 200; ++individual) {
          for (std::uint32_t evaluation = 0; evaluation < 5; ++evaluation) {
            for (std::uint32_t replicate = 0; replicate < 10; ++replicate) {
              seeds.push_back(DeriveSeed(campaign, static_cast<SeedPurpose>(purpose), search,
                                         individual << (individual % 33), evaluation, replicate));
            }
          }
        }
      }
    }
  }
  const std::size_t all = seeds.size();
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  // individual << (individual % 33) meets itself a few times; count how many different ones there are.
  std::set<std::uint64_t> individuals;
  for (std::uint64_t i = 0; i < 200; ++i) individuals.insert(i << (i % 33));
  EXPECT_EQ(all, 1'000'000u);
  EXPECT_EQ(seeds.size(), 5000u * individuals.size());
}

// Stored runs depend on these very numbers.
TEST(DeriveSeedTest, NumbersNeverChange) {
  EXPECT_EQ(DeriveSeed(1, SeedPurpose::kSearch, 0, 0, 0, 0), 0x2b1b4fce3e68da7fu);
  EXPECT_EQ(DeriveSeed(1, SeedPurpose::kSearch, 0, 0, 0, 1), 0x82205aa4b9655ea4u);
  EXPECT_EQ(DeriveSeed(1, SeedPurpose::kSearch, 0, 1, 0, 0), 0x1c872b9281f836cau);
  EXPECT_EQ(DeriveSeed(1, SeedPurpose::kSearch, 1, 0, 0, 0), 0x67ced99875b70acdu);
  EXPECT_EQ(DeriveSeed(1, SeedPurpose::kConfirm, 0, 0, 0, 0), 0x36106cb8f1cf8249u);
  EXPECT_EQ(DeriveSeed(2, SeedPurpose::kSearch, 0, 0, 0, 0), 0x2859a41115a2568fu);
  EXPECT_EQ(DeriveSeed(0xffffffffffffffff, SeedPurpose::kEvaluate, 7, 0x0123456789abcdef, 3, 9),
            0xebde8a5c90283b88u);
}

}  // namespace
}  // namespace gauntlet::sim
