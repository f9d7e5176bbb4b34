#include "search/margin/margin_stages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

constexpr const char* kDrop = "noise.omnidirectional_camera.drop=0..0.5";

Experiment Flocking(const std::string& vary) {
  Experiment experiment = ParseExperiment("", "toy.toml", {"scenario=flocking"}, BuiltInCatalogue()).value();
  experiment.search.algorithm = "margin";
  experiment.margin.vary = vary;
  return experiment;
}

Result<MarginPlan> PlanOf(const Experiment& experiment, std::size_t cases = 200) {
  return MakeMarginPlan(experiment, AllKeysOf(experiment), cases);
}

using Curve = std::function<double(double value)>;

// Runs of 200 cases that fail with the curve's probability, and resemble those of the same case by `alike`
// (the correlation of a Gaussian copula).
MarginStages Simulated(const MarginPlan& plan, const Curve& curve, double alike, std::uint64_t seed) {
  MarginStages stages(plan);
  sim::RandomStream random(seed, sim::StreamPurpose::kTest);
  std::vector<double> own(plan.cases);
  for (double& one : own) one = random.Gaussian();
  for (auto runs = stages.Next(); !runs.empty(); runs = stages.Next()) {
    for (const MarginRun& run : runs) {
      const double weakness =
          std::sqrt(alike) * own[run.of_case] + std::sqrt(1.0 - alike) * random.Gaussian();
      stages.Tell(run, std::erfc(-weakness / std::sqrt(2.0)) / 2.0 < curve(run.value));
    }
  }
  return stages;
}

double Between(const std::vector<std::pair<double, double>>& points, double x) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& [x0, y0] = points[i - 1];
    const auto& [x1, y1] = points[i];
    if (x <= x1) return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
  }
  return points.back().second;
}

// The share of 250 seeds whose interval holds the crossing.
double Coverage(const MarginPlan& plan, const Curve& curve, double crossing, double alike) {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 250; ++seed) {
    const MarginEstimate found = *Simulated(plan, curve, alike, seed).Estimate();
    held += found.low <= crossing && crossing <= found.high ? 1 : 0;
  }
  return held / 250.0;
}

TEST(MarginStagesTest, HoldTheCrossingInNinetyThreeOfAHundred) {
  const MarginPlan plan = PlanOf(Flocking(kDrop)).value();
  struct Truth {
    Curve curve;
    double crossing;
  };
  const Truth truths[] = {{[](double x) {
                             return Between({{0, .24}, {.1, .44}, {.15, .57}, {.2, .92}, {.25, 1}}, x);
                           },
                           .123},
                          {[](double x) { return .1 + .9 / (1 + std::exp(-(x - .2) / .04)); }, .191},
                          {[](double x) { return .2 + 1.2 * x; }, .25},
                          {[](double x) { return x < .31 ? .05 : .95; }, .31},
                          {[](double x) { return .9 - 1.6 * x; }, .25}};
  double sum = 0.0;
  for (const auto& [curve, crossing] : truths) {
    for (const double alike : {0.0, 0.3}) {
      const double coverage = Coverage(plan, curve, crossing, alike);
      EXPECT_GE(coverage, .93) << crossing << ", alike " << alike;
      sum += coverage;
    }
  }
  RecordProperty("mean_coverage", std::to_string(sum / 10.0));
}

TEST(MarginStagesTest, CloseInOnTheCrossing) {
  const MarginPlan plan = PlanOf(Flocking(kDrop)).value();
  const MarginStages stages = Simulated(
      plan, [](double x) { return x < .2 ? .02 : .98; }, 0.0, 7);
  const MarginEstimate found = *stages.Estimate();
  EXPECT_LE(found.high - found.low, .002);
  EXPECT_NEAR(found.estimate, .2, .002);
  EXPECT_LE(stages.asked(), plan.runs);
  EXPECT_GT(stages.asked(), plan.runs - 40);
}

TEST(MarginStagesTest, TakeTheSameCasesAtEachValueOfAStage) {
  MarginStages stages(PlanOf(Flocking(kDrop)).value());
  const std::vector<MarginRun> first = stages.Next();
  ASSERT_EQ(first.size(), 120U);
  std::set<double> values;
  for (std::size_t i = 0; i < first.size(); ++i) {
    values.insert(first[i].value);
    EXPECT_EQ(first[i].of_case, i % 20);
  }
  EXPECT_THAT(values, testing::ElementsAre(0.0, 0.1, 0.2, 0.3, 0.4, 0.5));
  for (const MarginRun& run : first) stages.Tell(run, run.value > 0.25);
  EXPECT_EQ(stages.Next().front().of_case, 20U);
}

TEST(MarginStagesTest, AskForWholeNumbersOfRobotsAndSeeThatFailuresBecomeRarer) {
  const MarginPlan plan = PlanOf(Flocking("scenario_parameters.birds=3..12")).value();
  const MarginStages stages = Simulated(
      plan, [](double birds) { return birds < 6 ? .9 : .1; }, 0.0, 3);
  const MarginEstimate found = *stages.Estimate();
  EXPECT_TRUE(found.falls);
  EXPECT_EQ(found.low, 5.0);
  EXPECT_EQ(found.high, 6.0);
  for (const MarginLevel& level : found.levels) EXPECT_EQ(level.value, std::floor(level.value));
}

TEST(MarginStagesTest, SayThatTheShareIsNotCrossed) {
  const MarginPlan plan = PlanOf(Flocking(kDrop)).value();
  const auto below = *Simulated(
                          plan, [](double) { return .1; }, 0.0, 1)
                          .Estimate();
  const auto above = *Simulated(
                          plan, [](double) { return .9; }, 0.0, 1)
                          .Estimate();
  EXPECT_TRUE(below.low == .5 || below.high == 0.0) << below.low << " to " << below.high;
  EXPECT_TRUE(above.low == .5 || above.high == 0.0) << above.low << " to " << above.high;
}

TEST(MarginStagesTest, LeaveOutRunsWithoutAResult) {
  MarginStages stages(PlanOf(Flocking(kDrop)).value());
  for (const MarginRun& run : stages.Next()) stages.Tell(run, std::nullopt);
  EXPECT_EQ(stages.without_result(), 120);
  EXPECT_FALSE(stages.Estimate());
  EXPECT_TRUE(stages.Next().empty());
}

TEST(MakeMarginPlanTest, RefusesWhatIsNoMargin) {
  const auto message = [](const Experiment& experiment, std::size_t cases = 200) {
    const auto plan = PlanOf(experiment, cases);
    return plan.ok() ? std::string("accepted") : plan.error().message;
  };
  EXPECT_EQ(message(Flocking("physics=impulse|box2d")),
            "--vary physics=impulse|box2d: a margin is looked for along the numbers of a range, as in "
            "physics=LOW..HIGH");
  EXPECT_EQ(message(Flocking("genome.length_max=1..3")),
            "--vary genome.length_max=1..3: genome.length_max says how cases are made, and the cases are the "
            "same at every value");
  EXPECT_EQ(message(Flocking("noise.wheels.uniform=0.2..0.2")),
            "--vary noise.wheels.uniform=0.2..0.2: 0.2 is not below 0.2");
  EXPECT_EQ(message(Flocking("scenario_parameters.birds=3.5..8")),
            "--vary scenario_parameters.birds=3.5..8: scenario_parameters.birds is a whole number, 1 to "
            "100, and 3.5 is none");
  Experiment few = Flocking(kDrop);
  few.margin.runs = 100;
  EXPECT_EQ(message(few), "100 runs are too few for an interval: at least 200 are needed");
  EXPECT_EQ(message(Flocking(kDrop), 1), "1 case for a failure rate: at least 20 are needed");
}

}  // namespace
}  // namespace gauntlet
