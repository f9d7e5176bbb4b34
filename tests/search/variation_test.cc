#include "search/evolution/variation.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

sim::Genome RandomGenome(const GenomeGenerator& generator, std::uint32_t key) {
  sim::RandomStream random(11, sim::StreamPurpose::kTest, key);
  return generator.RandomTestCase(random)->obstacles;
}

TEST(MutationTest, ProbabilityZeroChangesNothing) {
  const GenomeGenerator generator = MakeGenerator(ToySetup());
  const sim::Genome genome = RandomGenome(generator, 1);
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(Mutate(genome, 0.0, generator, random), genome);
}

TEST(MutationTest, ProbabilityOneRedrawsEveryGene) {
  const GenomeGenerator generator = MakeGenerator(ToySetup());
  const sim::Genome genome = RandomGenome(generator, 1);
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  const sim::Genome mutant = Mutate(genome, 1.0, generator, random);
  for (std::size_t i = 0; i < genome.size(); ++i) EXPECT_NE(mutant[i], genome[i]) << i;
}

TEST(MutationTest, GenesMutateIndependentlyWithTheGivenProbability) {
  const GenomeGenerator generator = MakeGenerator(ToySetup());
  const sim::Genome genome = RandomGenome(generator, 1);
  std::vector<int> changed(genome.size(), 0);
  constexpr int kDraws = 4000;
  for (std::uint32_t key = 0; key < kDraws; ++key) {
    sim::RandomStream random(2, sim::StreamPurpose::kTest, key);
    const sim::Genome mutant = Mutate(genome, 0.25, generator, random);
    for (std::size_t i = 0; i < genome.size(); ++i) changed[i] += mutant[i] != genome[i];
  }
  // 5 standard deviations of a binomial(4000, 1/4) are 137.
  for (const int count : changed) EXPECT_NEAR(count, kDraws / 4, 137);
}

TEST(BreedTest, WithoutCrossoverAndMutationChildrenAreCopies) {
  const GenomeGenerator generator = MakeGenerator(ToySetup());
  SearchSpec spec;
  spec.crossover_probability = 0.0;
  spec.mutation_probability = 0.0;
  const sim::Genome first = RandomGenome(generator, 1);
  const sim::Genome second = RandomGenome(generator, 2);
  for (std::uint32_t couple = 0; couple < 50; ++couple) {
    const Offspring offspring = Breed(first, second, spec, generator, {1, 2, couple});
    EXPECT_EQ(offspring.first, first);
    EXPECT_EQ(offspring.second, second);
  }
}

TEST(BreedTest, CrossoverHappensWithItsProbabilityPerCouple) {
  const GenomeGenerator generator = MakeGenerator(ToySetup());
  SearchSpec spec;
  spec.crossover = CrossoverKind::kSinglePoint;
  spec.mutation_probability = 0.0;
  const sim::Genome first = RandomGenome(generator, 1);
  const sim::Genome second = RandomGenome(generator, 2);
  for (const double probability : {0.1, 1.0}) {
    spec.crossover_probability = probability;
    int crossed = 0;
    constexpr int kCouples = 400;
    for (std::uint32_t couple = 0; couple < kCouples; ++couple) {
      crossed += Breed(first, second, spec, generator, {1, 2, couple}).first != first;
    }
    // 5 standard deviations of a binomial(400, 0.1) are 30.
    if (probability < 1.0) {
      EXPECT_NEAR(crossed, 40, 30);
    } else {
      EXPECT_EQ(crossed, kCouples);
    }
  }
}

TEST(BreedTest, SixtyPercentOfTheChildrenOfUnrelatedParentsAreClonesWithTheThesisParameters) {
  const GenomeGenerator generator = MakeGenerator(ToySetup());
  const SearchSpec spec;
  int clones = 0;
  constexpr int kCouples = 2000;
  for (std::uint32_t couple = 0; couple < kCouples; ++couple) {
    const sim::Genome first = RandomGenome(generator, couple % 50);
    const sim::Genome second = RandomGenome(generator, 50 + couple % 49);
    const Offspring offspring = Breed(first, second, spec, generator, {1, 2, couple});
    clones += (offspring.first == first) + (offspring.second == second);
  }
  // 0.9 x 0.95^8 = 0.597, and up to 0.03 more because a mutation that breaks a rule is done again, with
  // another chance to change nothing. 4 standard deviations are 0.03.
  const double clone_rate = clones / (2.0 * kCouples);
  RecordProperty("clone_rate", std::to_string(clone_rate));
  EXPECT_GT(clone_rate, 0.597 - 0.03);
  EXPECT_LT(clone_rate, 0.597 + 0.03 + 0.03);
}

TEST(BreedTest, OffspringThatStayInvalidBecomeCopies) {
  SearchSetup setup = ToySetup();
  const GenomeGenerator wide = MakeGenerator(setup);
  const sim::Genome first = RandomGenome(wide, 1);
  const sim::Genome second = RandomGenome(wide, 2);
  // Every redrawn gene fills the arena.
  setup.experiment.genome.length_min = 20.0;
  setup.experiment.genome.length_max = 20.0;
  setup.experiment.genome.width_min = 20.0;
  setup.experiment.genome.width_max = 20.0;
  const GenomeGenerator blocking = MakeGenerator(setup);
  SearchSpec spec;
  spec.crossover_probability = 0.0;
  spec.mutation_probability = 1.0;
  spec.variation_tries = 3;
  const Offspring offspring = Breed(first, second, spec, blocking, {1, 2, 0});
  EXPECT_EQ(offspring.first, first);
  EXPECT_EQ(offspring.second, second);
}

RC_GTEST_PROP(BreedTest, ChildrenOfValidParentsAreValidAndDependOnTheKeyOnly, ()) {
  const GenomeGenerator generator = MakeGenerator(ToySetup());
  SearchSpec spec;
  spec.crossover =
      *rc::gen::element(CrossoverKind::kSinglePoint, CrossoverKind::kDoublePoint, CrossoverKind::kUniform);
  spec.crossover_probability = 0.8;
  spec.mutation_probability = 0.4;
  const sim::Genome first = RandomGenome(generator, *rc::gen::inRange<std::uint32_t>(0, 1000));
  const sim::Genome second = RandomGenome(generator, *rc::gen::inRange<std::uint32_t>(0, 1000));
  const CoupleKey key{.search_seed = *rc::gen::arbitrary<std::uint64_t>(),
                      .generation = *rc::gen::inRange<std::uint32_t>(2, 100),
                      .couple = *rc::gen::inRange<std::uint32_t>(0, 10)};
  const Offspring offspring = Breed(first, second, spec, generator, key);
  RC_ASSERT(generator.Valid(offspring.first));
  RC_ASSERT(generator.Valid(offspring.second));
  const Offspring again = Breed(first, second, spec, generator, key);
  RC_ASSERT(again.first == offspring.first);
  RC_ASSERT(again.second == offspring.second);
}

}  // namespace
}  // namespace gauntlet
