// Covers: search/experiment/genome_ranges.cc
#include "search/evolution/genome_generator.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>
#include <algorithm>

#include <cmath>
#include <map>
#include <set>

#include "search/experiment/genome_ranges.h"
#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

bool InRanges(const sim::Genome& genome, const GenomeSpec& spec) {
  const auto within = [](double value, double min, double max) { return value >= min && value <= max; };
  return std::ranges::all_of(genome, [&](const sim::ObstacleGene& gene) {
    const auto position = [&](double value) { return within(value, spec.position_min, spec.position_max); };
    return position(gene.x) && position(gene.y) && within(gene.length, spec.length_min, spec.length_max) &&
           within(gene.width, spec.width_min, spec.width_max) && gene.orientation_deg >= 0.0 &&
           gene.orientation_deg < 360.0 &&
           (!gene.Moves() || within(gene.speed, spec.speed_min, spec.speed_max)) &&
           std::ranges::all_of(
               gene.path, [&](const sim::Vec2& point) { return position(point.x()) && position(point.y()); });
  });
}

GenomeGenerator Generator(const GenomeSpec& spec) {
  SearchSetup setup = ToySetup();
  setup.experiment.genome = spec;
  return MakeGenerator(setup);
}

RC_GTEST_PROP(GenomeGeneratorTest, EveryCaseIsValidInRangeAndOnTheGrid, ()) {
  const SearchSetup setup = ToySetup();
  const GenomeGenerator generator = MakeGenerator(setup);
  sim::RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), sim::StreamPurpose::kTest);
  const Result<sim::TestCase> test_case = generator.RandomTestCase(random);
  RC_ASSERT(test_case.ok());
  RC_ASSERT(test_case->obstacles.size() == 8U);
  RC_ASSERT(!sim::CheckValidity(*test_case, setup.requirements).has_value());
  RC_ASSERT(InRanges(test_case->obstacles, setup.experiment.genome));
  for (const sim::ObstacleGene& gene : test_case->obstacles) {
    for (const double value : {gene.x, gene.y, gene.length, gene.width}) {
      // One decimal says it all: JSON shows 0.3, not 0.30000000000000004.
      RC_ASSERT(fmt::format("{}", value) == fmt::format("{}", std::stod(fmt::format("{:.1f}", value))));
      RC_ASSERT(!(value == 0.0 && std::signbit(value)));
    }
    RC_ASSERT(gene.orientation_deg == std::floor(gene.orientation_deg));
  }
}

RC_GTEST_PROP(GenomeGeneratorTest, ACaseOfDrawsIsTheirFirstGenesWhereTheseFit, ()) {
  const SearchSetup setup = ToySetup();
  const GenomeGenerator generator = MakeGenerator(setup);
  sim::RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), sim::StreamPurpose::kTest);
  std::vector<GeneDraw> draws;
  for (int i = 0; i < generator.spec().genes; ++i) draws.push_back(generator.DrawGene(random));
  const sim::Genome genome = generator.CaseOf(draws).value().obstacles;
  RC_ASSERT(generator.Valid(genome));
  RC_ASSERT(generator.CaseOf(draws).value().obstacles == genome);
  sim::Genome first;
  for (const GeneDraw& draw : draws) first.push_back(draw.first);
  RC_ASSERT(!generator.Valid(first) || first == genome);
}

TEST(GenomeGeneratorTest, StepsOfAGeneStayInRangeAndAreAsProbableBackwards) {
  GenomeSpec spec;
  spec.position_min = -0.2;
  spec.position_max = 0.2;
  const GenomeGenerator generator = Generator(spec);
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  std::map<std::pair<double, double>, int> steps;
  sim::ObstacleGene gene = generator.RandomGene(random);
  for (int i = 0; i < 20'000; ++i) {
    const sim::ObstacleGene next = generator.NearGene(gene, 0.25, random);
    ASSERT_TRUE(InRanges({next}, spec));
    ++steps[{gene.x, next.x}];
    gene = next;
  }
  for (const auto& [step, count] : steps)
    EXPECT_NEAR(count, (steps[{step.second, step.first}]), 6.0 * std::sqrt(count));
  EXPECT_GT(steps.size(), 10U);
}

TEST(GenomeGeneratorTest, EveryGridPointOfEveryRangeIsDrawn) {
  const GenomeGenerator generator = Generator({});
  std::set<double> x;
  std::set<double> length;
  std::set<double> width;
  std::set<double> orientation;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  for (int i = 0; i < 5000; ++i) {
    const sim::ObstacleGene gene = generator.RandomGene(random);
    x.insert(gene.x);
    length.insert(gene.length);
    width.insert(gene.width);
    orientation.insert(gene.orientation_deg);
  }
  EXPECT_EQ(x.size(), 61U);
  EXPECT_EQ(*x.begin(), -3.0);
  EXPECT_EQ(*x.rbegin(), 3.0);
  EXPECT_TRUE(x.contains(0.3));
  EXPECT_EQ(length.size(), 17U);
  EXPECT_EQ(*length.begin(), 0.4);
  EXPECT_EQ(*length.rbegin(), 2.0);
  EXPECT_EQ(width, (std::set<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(orientation.size(), 360U);
  EXPECT_EQ(*orientation.rbegin(), 359.0);
}

TEST(GenomeGeneratorTest, StepZeroIsContinuous) {
  const GenomeGenerator generator = Generator({.step = 0.0});
  std::set<double> x;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  for (int i = 0; i < 100; ++i) {
    const sim::ObstacleGene gene = generator.RandomGene(random);
    x.insert(gene.x);
    EXPECT_TRUE(InRanges({gene}, generator.spec()));
  }
  EXPECT_EQ(x.size(), 100U);
}

TEST(GenomeGeneratorTest, OneStreamGivesOneCase) {
  const GenomeGenerator generator = Generator({});
  sim::RandomStream random(3, sim::StreamPurpose::kGenome, 1);
  sim::RandomStream again(3, sim::StreamPurpose::kGenome, 1);
  sim::RandomStream other(3, sim::StreamPurpose::kGenome, 2);
  const sim::Genome genome = generator.RandomTestCase(random)->obstacles;
  EXPECT_EQ(generator.RandomTestCase(again)->obstacles, genome);
  EXPECT_NE(generator.RandomTestCase(other)->obstacles, genome);
}

TEST(GenomeGeneratorTest, RangesThatLeaveNoRoomAreReported) {
  // Blocks larger than the arena.
  const GenomeGenerator generator = Generator({.genes = 8,
                                               .length_min = 20.0,
                                               .length_max = 20.0,
                                               .width_min = 20.0,
                                               .width_max = 20.0,
                                               .tries_per_gene = 5});
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  const Result<sim::TestCase> test_case = generator.RandomTestCase(random);
  ASSERT_FALSE(test_case.ok());
  EXPECT_EQ(test_case.error().message,
            "no valid test case found in 100 starts with genome.genes = 8, positions -3 to 3 m, lengths 20 "
            "to 20 m, widths 20 to 20 m in an arena of 6 x 6 m: use fewer or smaller obstacles");
}

TEST(GenomeGeneratorTest, AnArenaThatIsInvalidWithoutObstaclesIsReportedByItsRule) {
  SearchSetup setup = ToySetup();
  setup.requirements.start = {9.0, 9.0};
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  const Result<sim::TestCase> test_case = MakeGenerator(setup).RandomTestCase(random);
  ASSERT_FALSE(test_case.ok());
  EXPECT_EQ(test_case.error().message,
            "the arena breaks the rule start-blocked before it has any obstacle: the wall blocks the start "
            "(9, 9); a robot's centre needs 0.1 m of room there");
}

TEST(CheckGenomeSpecTest, RefusesRangesThatCannotBeDrawnFrom) {
  EXPECT_TRUE(CheckGenomeSpec({}).ok());
  EXPECT_EQ(CheckGenomeSpec({.length_min = 3.0}).error().message,
            "genome.length_min = 3 must not exceed genome.length_max = 2");
  EXPECT_EQ(CheckGenomeSpec({.step = 0.3}).error().message,
            "genome.step = 0.3 must be 0 (continuous) or a whole fraction of 1 m, such as 0.1 or 0.05");
  EXPECT_EQ(CheckGenomeSpec({.step = -0.1}).error().message,
            "genome.step = -0.1 must be 0 (continuous) or a whole fraction of 1 m, such as 0.1 or 0.05");
  EXPECT_EQ(CheckGenomeSpec({.width_min = 0.15, .width_max = 0.18}).error().message,
            "genome.width_min = 0.15 to genome.width_max = 0.18 holds no multiple of genome.step = 0.1");
  EXPECT_TRUE(CheckGenomeSpec({.width_min = 0.15, .width_max = 0.18, .step = 0.0}).ok());
}

// Thesis 7.4: the asked-for shares move and shine; without shares the draws are those of always.
TEST(GenomeGeneratorTest, SharesOfTheGenesMoveAndShine) {
  GenomeSpec spec = ToySetup().experiment.genome;
  sim::RandomStream plain_draws(1, sim::StreamPurpose::kTest);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(Generator(spec).RandomGene(plain_draws).Plain());
  spec.moving = 0.2;
  spec.lights = 0.1;
  spec.waypoints = 2;
  spec.light_color = sim::Color::kGreen;
  const GenomeGenerator generator = Generator(spec);
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  int moving = 0;
  int lit = 0;
  constexpr int kGenes = 10000;
  for (int i = 0; i < kGenes; ++i) {
    const sim::ObstacleGene gene = generator.RandomGene(random);
    moving += gene.Moves() ? 1 : 0;
    lit += gene.Lit() ? 1 : 0;
    ASSERT_TRUE(!gene.Lit() || gene.light == sim::Color::kGreen);
    ASSERT_TRUE(InRanges({gene}, spec));
    if (!gene.Moves()) continue;
    ASSERT_EQ(gene.path.size(), 2u);
    ASSERT_NEAR(gene.speed * 1000, std::round(gene.speed * 1000), 1e-9);
  }
  EXPECT_NEAR(moving / double{kGenes}, 0.2, 0.016);  // four standard deviations
  EXPECT_NEAR(lit / double{kGenes}, 0.1, 0.012);
}

TEST(CheckGenomeSpecTest, RefusesSpeedsThatCannotBeDrawn) {
  GenomeSpec spec;
  spec.speed_min = 0.0101;
  spec.speed_max = 0.0109;
  EXPECT_EQ(CheckGenomeSpec(spec).error().message,
            "genome.speed_min = 0.0101 to genome.speed_max = 0.0109 holds no multiple of 0.001 m/s");
  spec.speed_min = 0.02;
  EXPECT_EQ(CheckGenomeSpec(spec).error().message,
            "genome.speed_min = 0.02 must not exceed genome.speed_max = 0.0109");
}

// A 2 x 1 m arena whose corners lie beside the grid.
SearchSetup SetupOfRectangle() {
  SearchSetup setup = ToySetup();
  setup.experiment.arena = {
      .wall_thickness = 0.02, .x_min = 10.05, .x_max = 12.05, .y_min = -1.05, .y_max = -0.05};
  setup.experiment.genome = {.genes = 4, .length_max = 0.5, .width_max = 0.2, .moving = 0.5};
  setup.requirements.start = {10.25, -0.25};
  setup.requirements.goal = {11.75, -0.75};
  setup.requirements.inflation = 0.02;
  setup.requirements.anywhere = true;
  return setup;
}

TEST(GenomeGeneratorTest, ARectangleSaysWhereCentresAndPathsLie) {
  const GenomeGenerator generator = MakeGenerator(SetupOfRectangle());
  std::set<double> x;
  std::set<double> y;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  for (int i = 0; i < 500; ++i) {
    const sim::ObstacleGene gene = generator.RandomGene(random);
    x.insert(gene.x);
    y.insert(gene.y);
    for (const sim::Vec2& point : gene.path) {
      x.insert(point.x());
      y.insert(point.y());
    }
  }
  EXPECT_EQ(x.size(), 20U);
  EXPECT_EQ(*x.begin(), 10.1);
  EXPECT_EQ(*x.rbegin(), 12.0);
  EXPECT_EQ(y.size(), 10U);
  EXPECT_EQ(*y.begin(), -1.0);
  EXPECT_EQ(*y.rbegin(), -0.1);
  const Result<sim::TestCase> test_case = generator.RandomTestCase(random);
  ASSERT_TRUE(test_case.ok()) << test_case.error().message;
  EXPECT_EQ(test_case->center, sim::Vec2(11.05, -0.55));
  EXPECT_TRUE(generator.Valid(test_case->obstacles));
}

TEST(GenomeGeneratorTest, KeepOutsThatLeaveNoRoomAreNamed) {
  SearchSetup setup = SetupOfRectangle();
  setup.experiment.genome.tries_per_gene = 5;
  setup.requirements.keep_outs = {{{{11.0, -0.5}, {0.0, 0.0}}, 3.0}};
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  EXPECT_EQ(
      MakeGenerator(setup).RandomTestCase(random).error().message,
      "no valid test case found in 100 starts with genome.genes = 4, x 10.05 to 12.05 m, y -1.05 to -0.05 "
      "m, lengths 0.4 to 0.5 m, widths 0.1 to 0.2 m in an arena of 2 x 1 m: use fewer or smaller obstacles, "
      "or leave more room than the 1 keep-outs do");
}

}  // namespace
}  // namespace gauntlet
