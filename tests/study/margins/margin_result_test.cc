#include "study/margins/margin_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

// A margin whose crossing is known to lie between two values of 0..1.
Margin Found(const std::string& key, double low, double high, double estimate, bool falls = false) {
  Experiment experiment = ParseExperiment("", "toy.toml", {"scenario=flocking"}, BuiltInCatalogue()).value();
  experiment.margin.vary = key + "=0..1";
  Margin margin{.experiment = experiment,
                .plan = MakeMarginPlan(experiment, AllKeysOf(experiment), 200).value(),
                .runs = 600,
                .finished = true};
  margin.estimate = {.falls = falls,
                     .low = low,
                     .high = high,
                     .estimate = estimate,
                     .levels = {{0.0, 10, 1, 0.1}, {1.0, 10, 9, 0.9}}};
  return margin;
}

TEST(RankMarginsTest, GivesOverlappingIntervalsOneRank) {
  std::vector<Margin> margins = {Found("noise.proximity.gaussian", 0.5, 0.6, 0.55),
                                 Found("noise.wheels.gaussian", 0.1, 0.3, 0.2),
                                 Found("noise.omnidirectional_camera.drop", 0.25, 0.4, 0.3),
                                 Found("noise.wheels.uniform", 1.0, Crossing::kAbove, Crossing::kAbove)};
  RankMargins(margins);
  EXPECT_EQ(margins[0].rank, 2);
  EXPECT_EQ(margins[1].rank, 1);
  EXPECT_EQ(margins[2].rank, 1);
  EXPECT_EQ(margins[3].rank, 3);
}

TEST(RankMarginsTest, CountsFromTheSideOnWhichTheSwarmDoesWell) {
  std::vector<Margin> margins = {Found("noise.wheels.gaussian", 0.8, 0.9, 0.85),
                                 Found("noise.wheels.uniform", 0.8, 0.9, 0.85, /*falls=*/true)};
  RankMargins(margins);
  EXPECT_EQ(margins[0].rank, 2);
  EXPECT_EQ(margins[1].rank, 1);
}

TEST(MarginOutcomeTest, SaysWhereOrOnWhichSide) {
  const std::string key = "noise.wheels.gaussian";
  EXPECT_EQ(OutcomeOf(Found(key, 0.1, 0.3, 0.2)),
            "Failures cross 50 % where noise.wheels.gaussian is about 0.2 (0.1 to 0.3, 95 %).");
  EXPECT_EQ(
      OutcomeOf(Found(key, 1.0, Crossing::kAbove, Crossing::kAbove)),
      "Fewer than 50 % of the runs fail all along noise.wheels.gaussian from 0 to 1 (they go from 10 % to "
      "90 %).");
  EXPECT_EQ(
      OutcomeOf(Found(key, Crossing::kBelow, 0.0, Crossing::kBelow)),
      "More than 50 % of the runs fail all along noise.wheels.gaussian from 0 to 1 (they go from 10 % to "
      "90 %).");
  EXPECT_EQ(
      OutcomeOf(Found(key, 1.0, Crossing::kAbove, Crossing::kAbove, /*falls=*/true)),
      "More than 50 % of the runs fail all along noise.wheels.gaussian from 0 to 1 (they go from 10 % to "
      "90 %).");
  EXPECT_EQ(
      OutcomeOf(Found(key, 0.4, Crossing::kAbove, 0.9)),
      "Whether failures cross 50 % within noise.wheels.gaussian from 0 to 1 is not decided: the crossing "
      "may be at 0.4 or more (they go from 10 % to 90 %).");
  Margin nothing = Found(key, 0.1, 0.3, 0.2);
  nothing.estimate.reset();
  EXPECT_EQ(OutcomeOf(nothing), "noise.wheels.gaussian: no run has a result.");
}

}  // namespace
}  // namespace gauntlet
