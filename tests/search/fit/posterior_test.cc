#include "search/fit/posterior.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/search/fit/toy_fit.h"

namespace gauntlet {
namespace {

using testing::DoubleNear;

std::vector<FitTarget> Targets(const std::string& text) {
  return ParseFitTargets(text, *controllers::FindScenario("flocking")).value();
}

// Against the textbook: the mean of n values has variance s^2 / n; mean and standard deviation of a normal
// distribution do not covary.
TEST(StatisticsOfTest, CovariancesAreThoseOfResampledRuns) {
  const auto targets = Targets(
      "metric=fitness value=0 n=10; statistic=sd metric=fitness value=0 n=10; "
      "cases=empty metric=birds_left value=0 n=10");
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  std::vector<double> normal;
  for (int i = 0; i < 2000; ++i) normal.push_back(2.0 * random.Gaussian());
  const SettingStatistics ours = StatisticsOf({}, targets, {normal, normal, normal}, random);
  EXPECT_NEAR(ours.covariance(0, 0), 4.0, 1.5);
  EXPECT_NEAR(ours.covariance(1, 1), 2.0, 0.8);
  EXPECT_NEAR(ours.covariance(0, 1), 0.0, 1.0);
  EXPECT_EQ(ours.covariance(0, 2), 0.0);
  EXPECT_EQ(ours.runs, (std::vector<double>{2000, 2000, 2000}));
}

TEST(StatisticsOfTest, AShareOfNoneIsNotCertain) {
  const auto targets = Targets("statistic=share value=0 n=10 formula=birds_left == 0");
  const SettingStatistics ours =
      StatisticsOf({}, targets, {std::vector<double>(40, 0.0)}, {1, sim::StreamPurpose::kTest});
  EXPECT_NEAR(ours.covariance(0, 0), 0.5 / 41.0, 1e-3);
}

// A median of equal numbers, and a flag that nobody ever raised, are not exact.
TEST(StatisticsOfTest, FewDifferentValuesAreNotCertain) {
  const auto targets =
      ParseFitTargets("statistic=median metric=splits value=1 n=20; metric=total_failure value=0.1 n=20",
                      *controllers::FindScenario("flocking"))
          .value();
  std::vector<double> splits(20, 3.0);
  splits.front() = 9.0;
  const SettingStatistics statistics =
      StatisticsOf({0.5}, targets, {splits, std::vector<double>(20, 0.0)}, {1, sim::StreamPurpose::kTest});
  // 2 * 1.8 / 21, of a variance of 1.8; half of 21 runs.
  EXPECT_NEAR(statistics.covariance(0, 0), 2.0 * 1.8 / 21.0, 1e-9);
  EXPECT_NEAR(statistics.covariance(1, 1), 0.5 / 21.0 * (20.5 / 21.0), 1e-9);
}

TEST(MisfitOfTest, CountsStandardErrors) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1) * 0.04;
  EXPECT_NEAR(MisfitOf(Targets("metric=fitness value=1 n=10")[0], std::vector{1.4}, one), 2.0, 1e-6);
  EXPECT_NEAR(MisfitOf(Targets("metric=fitness at_most=1 n=10")[0], std::vector{1.4}, one), 2.0, 1e-6);
  EXPECT_EQ(MisfitOf(Targets("metric=fitness at_least=1 n=10")[0], std::vector{1.4}, one), 0.0);
  // 99 of 100 in each of 100: e^-1.
  EXPECT_NEAR(MisfitOf(Targets("statistic=every runs=100 formula=fitness > 0")[0], std::vector{0.99}, one),
              std::sqrt(-200.0 * std::log(0.99)), 1e-9);
  EXPECT_TRUE(
      std::isinf(MisfitOf(Targets("metric=fitness value=1 n=10")[0], std::vector{kNotMeasured}, one)));
}

class FitPosteriorTest : public testing::Test {
 protected:
  // Even settings over the ranges, 40 runs each.
  void Simulate(const std::string& targets, const std::string& vary = kToyVary) {
    plan_ = ToyPlan({.vary = vary, .targets = targets, .runs = 4800}).value();
    sim::RandomStream random(3, sim::StreamPurpose::kTest);
    for (std::size_t i = 0; i < 120; ++i) {
      SettingsPoint place;
      for (std::size_t key = 0; key < plan_.varied.size(); ++key) place.push_back(random.Uniform());
      SettingsPoint at = place;
      at.resize(3, 0.5);
      settings_.push_back(
          StatisticsOf(place, plan_.targets, ToyValues(plan_.targets, at, 40, random), random));
    }
  }
  std::vector<SettingsPoint> Draws(const FitPosterior::Allowed& allowed = Everywhere) {
    sim::RandomStream random(4, sim::StreamPurpose::kTest);
    return FitPosterior(plan_.varied, plan_.targets, settings_).Draw(600, allowed, random);
  }

  FitPlan plan_;
  std::vector<SettingStatistics> settings_;
};

double Quantile(std::vector<SettingsPoint> draws, std::size_t key, double quantile) {
  std::ranges::sort(draws, {}, [&](const SettingsPoint& place) { return place[key]; });
  return draws[static_cast<std::size_t>(quantile * static_cast<double>(draws.size() - 1))][key];
}

TEST_F(FitPosteriorTest, WhatNoTargetDependsOnStaysOpen) {
  // The mean does not know speed, which widens the spread.
  Simulate("metric=fitness value=1.5 n=100");
  const auto draws = Draws();
  EXPECT_GT(Quantile(draws, 1, 0.95) - Quantile(draws, 1, 0.05), 0.8);
  EXPECT_LT(Quantile(draws, 0, 0.95) - Quantile(draws, 0, 0.05), 0.6);
}

TEST_F(FitPosteriorTest, ABoundCutsTheRangeAndWeighsNothingBelow) {
  Simulate("metric=fitness at_most=1");
  const auto draws = Draws();
  // 3 x^2 + sin 2c at most 1: x at most .58.
  EXPECT_LT(Quantile(draws, 0, 0.95), 0.62);
  EXPECT_LT(Quantile(draws, 0, 0.05), 0.1);
}

TEST_F(FitPosteriorTest, WhatEveryRunHasToKeepsToWhereItIsLikely) {
  Simulate("statistic=every runs=20 formula=birds_left == 10");
  const auto draws = Draws();
  EXPECT_LT(Quantile(draws, 0, 0.9), 0.6);
}

TEST_F(FitPosteriorTest, DrawsOnlyWhatIsAllowed) {
  Simulate("metric=fitness value=1.5 n=100");
  const auto low = [](const SettingsPoint& place) { return place[1] < 0.3; };
  EXPECT_THAT(Draws(low), testing::Each(testing::Truly(low)));
  EXPECT_TRUE(Draws([](const SettingsPoint&) { return false; }).empty());
}

TEST_F(FitPosteriorTest, TargetsThatContradictEachOtherAreFarFromBothAtEveryPlace) {
  // The share of the lost grows with the fitness: 2.8 is reached where they are many.
  Simulate("metric=fitness value=3 n=100; statistic=share value=0.05 n=100 formula=birds_left == 0");
  const FitPosterior posterior(plan_.varied, plan_.targets, settings_);
  double best = 1e9;
  double alone = 1e9;
  for (const SettingsPoint& place : Draws()) {
    best = std::min(best, std::hypot(posterior.Misfit(place, 0), posterior.Misfit(place, 1)));
    alone = std::min(alone, posterior.Misfit(place, 0));
  }
  sim::RandomStream random(4, sim::StreamPurpose::kTest);
  const std::vector<std::size_t> first = {0};
  for (const SettingsPoint& place : posterior.Draw(200, Everywhere, random, first))
    alone = std::min(alone, posterior.Misfit(place, 0));
  EXPECT_GT(best, 3.0);
  EXPECT_LT(alone, 1.0);
}

// A large number that is the same in all runs of a setting.
TEST(FitPosteriorOfExactRunsTest, TellsPlacesApart) {
  const FitPlan plan = ToyPlan({.vary = kToyVary,
                                .targets = "metric=fitness value=500000 n=10; metric=splits value=1 n=10",
                                .runs = 4800})
                           .value();
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  std::vector<SettingStatistics> settings;
  for (int i = 0; i < 40; ++i) {
    const SettingsPoint place = {random.Uniform(), random.Uniform(), random.Uniform()};
    settings.push_back({.place = place,
                        .values = {1e6 * place[0], 1.0},
                        .covariance = Eigen::MatrixXd::Zero(2, 2),
                        .runs = {20.0, 20.0}});
  }
  const FitPosterior posterior(plan.varied, plan.targets, settings);
  const double far = posterior.LogLikelihood({0.9, 0.5, 0.5});
  EXPECT_GT(far, -1e29);
  EXPECT_GT(posterior.LogLikelihood({0.5, 0.5, 0.5}), far);
}

TEST_F(FitPosteriorTest, AChoiceIsLearntToo) {
  Simulate("metric=fitness value=1.5 n=100",
           "controller_parameters.turn_rate=0.5..1.5 physics=impulse|box2d");
  // The toy takes the choice's place as a number: impulse is .25, box2d .75.
  const auto draws = Draws();
  ASSERT_FALSE(draws.empty());
  const FitPosterior posterior(plan_.varied, plan_.targets, settings_);
  EXPECT_THAT(posterior.ExpectedAt({0.5, 0.1})[0], DoubleNear(posterior.ExpectedAt({0.5, 0.4})[0], 1e-9));
}

}  // namespace
}  // namespace gauntlet
