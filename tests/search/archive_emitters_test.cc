// Covers: search/archive/layout_proposer.cc
#include "search/archive/archive_emitters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;

const Way kDiagonal{{2.5, 2.5}, {-2.5, -2.5}};

TEST(ArchiveEmittersTest, ObstaclesAreOrderedByTheirNearestPoint) {
  const sim::Genome obstacles = {{.x = 2.0, .y = 0.0, .length = 0.4, .width = 0.1},
                                 {.x = 2.5, .y = 0.0, .length = 2.0, .width = 0.1},
                                 {.x = 0.0, .y = 1.0, .length = 0.4, .width = 0.1}};
  EXPECT_THAT(ByDistance(obstacles, {0.0, 0.0}), ElementsAre(2, 1, 0));
  EXPECT_THAT(ByDistanceToWay(obstacles, kDiagonal), ElementsAre(2, 1, 0));
  EXPECT_THAT(ByDistanceToWay(obstacles, {{0.0, -2.0}, {2.0, -0.1}}), ElementsAre(0, 1, 2));
}

TEST(ArchiveEmittersTest, PartsKeepTheOrderOfTheLayout) {
  const sim::Genome obstacles = {{.x = 0.0}, {.x = 1.0}, {.x = 2.0}};
  EXPECT_EQ(Keep(obstacles, {2, 0}), (sim::Genome{{.x = 0.0}, {.x = 2.0}}));
  EXPECT_EQ(Without(obstacles, 1), (sim::Genome{{.x = 0.0}, {.x = 2.0}}));
}

TEST(ArchiveEmittersTest, MirroringInTheDiagonalExchangesTheCoordinates) {
  const SearchSetup setup = ToySetup();
  const GenomeGenerator generator = MakeGenerator(setup);
  const sim::Genome obstacles = {{.x = -1.5, .y = 0.7, .length = 1.2, .width = 0.2, .orientation_deg = 30.0}};
  const auto mirrored = Mirrored(obstacles, kDiagonal, generator);
  ASSERT_TRUE(mirrored.has_value());
  EXPECT_EQ(mirrored->front(),
            (sim::ObstacleGene{.x = 0.7, .y = -1.5, .length = 1.2, .width = 0.2, .orientation_deg = 60.0}));
}

TEST(ArchiveEmittersTest, MirroringTwiceGivesBackEveryRandomCase) {
  const SearchSetup setup = ToySetup();
  const GenomeGenerator generator = MakeGenerator(setup);
  for (const Way& way : {kDiagonal, Way{{0.0, -2.0}, {0.0, 2.0}}}) {
    for (std::uint64_t id = 1; id <= 20; ++id) {
      sim::RandomStream random = GenomeStream(1, id);
      const sim::Genome obstacles = generator.RandomTestCase(random).value().obstacles;
      const auto once = Mirrored(obstacles, way, generator);
      if (!once) continue;  // start and goal of the toy do not lie mirrored
      EXPECT_NE(*once, obstacles);
      EXPECT_EQ(Mirrored(*once, way, generator), obstacles);
    }
  }
}

TEST(ArchiveEmittersTest, WhatIsDrawnIsValidAndOnTheGridOfTheGenome) {
  const SearchSetup setup = ToySetup();
  const GenomeSpec& spec = setup.experiment.genome;
  const GenomeGenerator generator = MakeGenerator(setup);
  sim::RandomStream random = GenomeStream(1, 1);
  const Way way = {{2.5, 2.5}, {-2.5, -2.5}};
  int valid = 0;
  for (int i = 0; i < 200; ++i) {
    const auto drawn = Across({1.0, 1.0}, 1, way, generator, random);
    if (!drawn) continue;
    ++valid;
    ASSERT_EQ(drawn->size(), 1U);
    EXPECT_NEAR(drawn->front().x, 1.0, 1.0);
    EXPECT_GE(drawn->front().length, 1.6);
    EXPECT_LE(drawn->front().length, spec.length_max);
    EXPECT_DOUBLE_EQ(drawn->front().x * 10.0, std::round(drawn->front().x * 10.0));
    const auto jittered = Jittered(*drawn, generator, random);
    if (jittered) {
      EXPECT_TRUE(generator.Valid(*jittered));
      EXPECT_LE(jittered->front().length, spec.length_max);
    }
  }
  EXPECT_GT(valid, 100);
}

TEST(ArchiveEmittersTest, TheLongestStandsWhereItWasAndIsTurnedALittle) {
  const SearchSetup setup = ToySetup();
  const GenomeSpec& spec = setup.experiment.genome;
  const GenomeGenerator generator = MakeGenerator(setup);
  const sim::ObstacleGene gene = {.x = 0.3, .y = -0.4, .length = 0.5, .width = 0.2, .orientation_deg = 90.0};
  sim::RandomStream random = GenomeStream(1, 1);
  double turn = 0.0;
  for (int i = 0; i < 100; ++i) {
    const auto longest = Longest({gene}, generator, random);
    ASSERT_TRUE(longest.has_value());
    const sim::ObstacleGene& made = longest->front();
    EXPECT_EQ(made.x, gene.x);
    EXPECT_EQ(made.y, gene.y);
    EXPECT_GE(made.length, 1.8);
    EXPECT_LE(made.length, spec.length_max);
    turn = std::max(turn, std::abs(made.orientation_deg - gene.orientation_deg));
  }
  EXPECT_GT(turn, 20.0);
  EXPECT_LT(turn, 90.0);
  EXPECT_EQ(Longest({{.x = 2.5, .y = 2.5}}, generator, random), std::nullopt) << "where the swarm starts";
}

TEST(ArchiveEmittersTest, ARowLiesAcrossTheWay) {
  const SearchSetup setup = ToySetup();
  const GenomeGenerator generator = MakeGenerator(setup);
  const Way way = {{-2.0, 0.0}, {2.0, 0.0}};
  sim::RandomStream random = GenomeStream(1, 1);
  int valid = 0;
  double lean = 0.0;
  for (int i = 0; i < 100; ++i) {
    const auto row = Across({0.0, 0.0}, 3, way, generator, random);
    if (!row) continue;
    ++valid;
    ASSERT_EQ(row->size(), 3U);
    for (std::size_t k = 1; k < 3; ++k) {
      EXPECT_NEAR((*row)[k].x, (*row)[k - 1].x, 1e-9);
      EXPECT_NEAR((*row)[k].y, (*row)[k - 1].y + 1.5, 0.1 + 1e-9);
    }
    EXPECT_NEAR((*row)[1].orientation_deg, 90.0, 60.0);
    lean = std::max(lean, std::abs((*row)[0].orientation_deg - (*row)[2].orientation_deg));
  }
  EXPECT_GT(valid, 50);
  EXPECT_GT(lean, 60.0);
}

TEST(ArchiveEmittersTest, WhatIsMovedStaysInARectangleWhoseEndsLieBesideTheGrid) {
  SearchSetup setup = ToySetup();
  setup.experiment.arena = {.x_min = 1.05, .x_max = 4.05, .y_min = -0.95, .y_max = 2.05};
  setup.requirements = {.inflation = 0.02, .asks_for_path = false, .anywhere = true};
  const GenomeGenerator generator = MakeGenerator(setup);
  sim::RandomStream random = GenomeStream(1, 1);
  const sim::Genome corners = {{1.1, -0.9, 0.5, 0.1, 0.0}, {4.0, 2.0, 0.5, 0.1, 0.0}};
  int at_the_end = 0;
  for (int i = 0; i < 100; ++i) {
    const auto jittered = Jittered(corners, generator, random);
    ASSERT_TRUE(jittered.has_value());
    for (const sim::ObstacleGene& gene : *jittered) {
      ASSERT_GE(gene.x, 1.1);
      ASSERT_LE(gene.x, 4.0);
      ASSERT_GE(gene.y, -0.9);
      ASSERT_LE(gene.y, 2.0);
      at_the_end += gene.x == 4.0 ? 1 : 0;
    }
  }
  EXPECT_GT(at_the_end, 10);
}

}  // namespace
}  // namespace gauntlet
