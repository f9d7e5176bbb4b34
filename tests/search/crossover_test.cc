#include "search/evolution/crossover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <string>

namespace gauntlet {
namespace {

using ::testing::ElementsAre;

// A genome whose gene i carries `first` + i as its x.
sim::Genome Marked(double first, std::size_t genes) {
  sim::Genome genome(genes);
  for (std::size_t i = 0; i < genes; ++i) genome[i].x = first + static_cast<double>(i);
  return genome;
}

std::vector<double> Marks(const sim::Genome& genome) {
  std::vector<double> marks;
  for (const sim::ObstacleGene& gene : genome) marks.push_back(gene.x);
  return marks;
}

sim::RandomStream Random(std::uint32_t key) {
  return {1, sim::StreamPurpose::kTest, key};
}

// 'A' where the first child has its gene from the first parent, 'B' where from the second.
std::string Origins(const Offspring& offspring, double second_mark) {
  std::string origins;
  for (const sim::ObstacleGene& gene : offspring.first) origins += gene.x >= second_mark ? 'B' : 'A';
  return origins;
}

TEST(CrossoverTest, SegmentBetweenTheCutsIsExchanged) {
  const Offspring offspring = SwapSegment(Marked(0, 5), Marked(10, 5), 1, 3);
  EXPECT_THAT(Marks(offspring.first), ElementsAre(0, 11, 12, 3, 4));
  EXPECT_THAT(Marks(offspring.second), ElementsAre(10, 1, 2, 13, 14));
}

TEST(CrossoverTest, CutBeforeTheEndExchangesTheTail) {
  const Offspring offspring = SwapSegment(Marked(0, 4), Marked(10, 4), 3, 4);
  EXPECT_THAT(Marks(offspring.first), ElementsAre(0, 1, 2, 13));
  EXPECT_THAT(Marks(offspring.second), ElementsAre(10, 11, 12, 3));
}

TEST(CrossoverTest, SinglePointUsesEveryCutFrom1To7EquallyOften) {
  std::map<std::string, int> counts;
  constexpr int kDraws = 7000;
  for (std::uint32_t key = 0; key < kDraws; ++key) {
    sim::RandomStream random = Random(key);
    ++counts[Origins(Cross(CrossoverKind::kSinglePoint, Marked(0, 8), Marked(10, 8), random), 10)];
  }
  ASSERT_EQ(counts.size(), 7U);
  for (std::size_t cut = 1; cut <= 7; ++cut) {
    const std::string origins = std::string(cut, 'A') + std::string(8 - cut, 'B');
    // 5 standard deviations of a binomial(7000, 1/7) are 146.
    EXPECT_NEAR(counts[origins], 1000, 146) << origins;
  }
}

TEST(CrossoverTest, DoublePointUsesEveryPairOfDifferentCutsFrom1To8EquallyOften) {
  std::map<std::string, int> counts;
  constexpr int kDraws = 14000;
  for (std::uint32_t key = 0; key < kDraws; ++key) {
    sim::RandomStream random = Random(key);
    ++counts[Origins(Cross(CrossoverKind::kDoublePoint, Marked(0, 8), Marked(10, 8), random), 10)];
  }
  ASSERT_EQ(counts.size(), 28U);  // 8 choose 2
  for (const auto& [origins, count] : counts) {
    EXPECT_EQ(origins.front(), 'A');  // no cut stands before gene 1
    // 5 standard deviations of a binomial(14000, 1/28) are 110.
    EXPECT_NEAR(count, 500, 110) << origins;
  }
}

TEST(CrossoverTest, UniformTakesEachGeneFromEitherParentWithProbabilityOneHalf) {
  std::vector<int> from_second(8, 0);
  constexpr int kDraws = 4000;
  for (std::uint32_t key = 0; key < kDraws; ++key) {
    sim::RandomStream random = Random(key);
    const std::string origins =
        Origins(Cross(CrossoverKind::kUniform, Marked(0, 8), Marked(10, 8), random), 10);
    for (std::size_t i = 0; i < 8; ++i) from_second[i] += origins[i] == 'B';
  }
  // 5 standard deviations of a binomial(4000, 1/2) are 158.
  for (const int count : from_second) EXPECT_NEAR(count, kDraws / 2, 158);
}

TEST(CrossoverTest, OneGeneHasNoCut) {
  sim::RandomStream random = Random(0);
  for (const CrossoverKind kind : {CrossoverKind::kSinglePoint, CrossoverKind::kDoublePoint}) {
    const Offspring offspring = Cross(kind, Marked(0, 1), Marked(10, 1), random);
    EXPECT_EQ(offspring.first, Marked(0, 1));
    EXPECT_EQ(offspring.second, Marked(10, 1));
  }
}

RC_GTEST_PROP(CrossoverTest, ChildrenHaveTheGenesOfBothParentsAtTheirPlaces, ()) {
  const auto genes = *rc::gen::inRange<std::size_t>(1, 20);
  const auto kind =
      *rc::gen::element(CrossoverKind::kSinglePoint, CrossoverKind::kDoublePoint, CrossoverKind::kUniform);
  sim::RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), sim::StreamPurpose::kTest);
  const sim::Genome first = Marked(0, genes);
  const sim::Genome second = Marked(100, genes);
  const Offspring offspring = Cross(kind, first, second, random);
  RC_ASSERT(offspring.first.size() == genes);
  RC_ASSERT(offspring.second.size() == genes);
  for (std::size_t i = 0; i < genes; ++i) {
    const bool kept = offspring.first[i] == first[i] && offspring.second[i] == second[i];
    const bool exchanged = offspring.first[i] == second[i] && offspring.second[i] == first[i];
    RC_ASSERT(kept != exchanged);
  }
}

}  // namespace
}  // namespace gauntlet
