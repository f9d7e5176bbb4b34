#include "search/evolution/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

// Individuals 1, 2, ... with these fitness values.
std::vector<Individual> WithFitness(const std::vector<double>& values) {
  std::vector<Individual> individuals;
  for (const double fitness : values) {
    Individual& one = individuals.emplace_back();
    one.id = individuals.size();
    one.fitness = fitness;
  }
  return individuals;
}

std::vector<IndividualId> IdsOf(const std::vector<Individual>& individuals) {
  std::vector<IndividualId> ids;
  for (const Individual& one : individuals) ids.push_back(one.id);
  return ids;
}

TEST(SelectionTest, LowerFitnessIsFitter) {
  std::vector<Individual> individuals = WithFitness({0.9, 0.1, 0.5, 0.3});
  EXPECT_THAT(TwoFittest(individuals), ElementsAre(1, 3));
  KeepFittest(individuals, 2);
  EXPECT_THAT(IdsOf(individuals), ElementsAre(2, 4));
}

TEST(SelectionTest, TheYoungerOfEqualsStaysAndBecomesAParent) {
  std::vector<Individual> individuals = WithFitness({0.5, 0.5, 0.5, 0.5});
  EXPECT_THAT(TwoFittest(individuals), ElementsAre(3, 2));
  KeepFittest(individuals, 3);
  EXPECT_THAT(IdsOf(individuals), ElementsAre(2, 3, 4));
}

TEST(SelectionTest, IndividualsWithoutFitnessGoFirst) {
  std::vector<Individual> individuals = WithFitness({0.9, std::numeric_limits<double>::infinity(), 0.5});
  KeepFittest(individuals, 2);
  EXPECT_THAT(IdsOf(individuals), ElementsAre(1, 3));
}

TEST(SelectionTest, TwoAtRandomAreDifferentAndEveryPairIsEquallyLikely) {
  std::map<std::pair<std::size_t, std::size_t>, int> counts;
  constexpr int kDraws = 12000;
  for (std::uint32_t key = 0; key < kDraws; ++key) {
    sim::RandomStream random(1, sim::StreamPurpose::kTest, key);
    const auto [first, second] = TwoAtRandom(4, random);
    ASSERT_NE(first, second);
    ++counts[{first, second}];
  }
  ASSERT_EQ(counts.size(), 12U);
  // 5 standard deviations of a binomial(12000, 1/12) are 151.
  for (const auto& [pair, count] : counts) EXPECT_NEAR(count, 1000, 151);
}

TEST(SelectionTest, ShuffleIsAPermutationAndEveryOrderIsEquallyLikely) {
  std::map<std::vector<std::size_t>, int> counts;
  constexpr int kDraws = 6000;
  for (std::uint32_t key = 0; key < kDraws; ++key) {
    sim::RandomStream random(1, sim::StreamPurpose::kTest, key);
    const std::vector<std::size_t> order = Shuffled(3, random);
    ASSERT_THAT(order, UnorderedElementsAre(0, 1, 2));
    ++counts[order];
  }
  ASSERT_EQ(counts.size(), 6U);
  // 5 standard deviations of a binomial(6000, 1/6) are 144.
  for (const auto& [order, count] : counts) EXPECT_NEAR(count, 1000, 144);
}

}  // namespace
}  // namespace gauntlet
