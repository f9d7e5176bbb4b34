#include "search/fit/fit_rounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/search/fit/toy_fit.h"

namespace gauntlet {
namespace {

using testing::Each;
using testing::SizeIs;

FitRounds RoundsOf(const std::string& targets, std::uint64_t seed, const std::string& vary = kToyVary) {
  return {ToyPlan({.vary = vary, .targets = targets, .runs = 4000, .judged = 400}).value(), seed, Everywhere};
}

// How many of the hidden places the 90 % intervals of `repeats` fits hold, for each key.
std::vector<int> HeldByIntervals(int repeats) {
  std::vector<int> held(3, 0);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    sim::RandomStream random(1000 + static_cast<std::uint64_t>(repeat), sim::StreamPurpose::kTest);
    const SettingsPoint hidden = {random.Uniform(), random.Uniform(), random.Uniform()};
    FitRounds rounds = RoundsOf(ToyMeasured(hidden, random), static_cast<std::uint64_t>(repeat));
    Finish(rounds, random);
    const auto draws = rounds.Accepted(*rounds.Posterior());
    EXPECT_THAT(draws, SizeIs(FitRounds::kAccepted));
    for (std::size_t key = 0; key < 3; ++key) {
      std::vector<double> places;
      for (const SettingsPoint& draw : draws) places.push_back(draw[key]);
      std::ranges::sort(places);
      const bool inside = hidden[key] >= places[places.size() / 20] &&
                          hidden[key] <= places[places.size() - 1 - places.size() / 20];
      held[key] += inside ? 1 : 0;
    }
  }
  return held;
}

// 13.5 of 15 are expected of each key (standard deviation 1.2), 40.5 of all (2.0).
TEST(FitRoundsTest, IntervalsHoldTheHiddenSettingsAsOftenAsTheyClaim) {
  const std::vector<int> held = HeldByIntervals(15);
  EXPECT_THAT(held, Each(testing::Ge(10)));
  EXPECT_GE(held[0] + held[1] + held[2], 35);
}

TEST(FitRoundsTest, TheChosenSettingMeetsTheTargetsOnFreshRuns) {
  sim::RandomStream random(5, sim::StreamPurpose::kTest);
  FitRounds rounds = RoundsOf(ToyMeasured({0.5, 0.6, 0.4}, random), 1);
  Finish(rounds, random);
  const FitSetting* chosen = rounds.Chosen();
  ASSERT_NE(chosen, nullptr);
  EXPECT_EQ(chosen->runs, 400);
  const SettingStatistics ours = rounds.StatisticsOf(rounds.settings().size() - 1);
  for (std::size_t t = 0; t < 3; ++t) {
    const auto at = static_cast<Eigen::Index>(t);
    const Eigen::MatrixXd covariance = ours.covariance.block(at, at, 1, 1) * (1.0 / 100 + 1.0 / 400);
    EXPECT_LT(MisfitOf(rounds.plan().targets[t], std::vector{ours.values[t]}, covariance), 3.0) << t;
  }
}

TEST(FitRoundsTest, EqualRunsGiveEqualFits) {
  std::vector<std::vector<SettingsPoint>> fits;
  for (int i = 0; i < 2; ++i) {
    sim::RandomStream random(6, sim::StreamPurpose::kTest);
    FitRounds rounds = RoundsOf(ToyMeasured({0.5, 0.6, 0.4}, random), 1);
    Finish(rounds, random);
    fits.push_back(rounds.Accepted(*rounds.Posterior()));
  }
  EXPECT_EQ(fits[0], fits[1]);
}

TEST(FitRoundsTest, TheFirstRoundCoversTheRanges) {
  FitRounds rounds = RoundsOf("metric=fitness value=1 n=100", 1);
  std::vector<SettingsPoint> places = rounds.Propose();
  ASSERT_GE(places.size(), rounds.wanted());
  for (std::size_t key = 0; key < 3; ++key) {
    std::vector<int> counts(rounds.wanted(), 0);
    for (std::size_t i = 0; i < rounds.wanted(); ++i)
      ++counts[static_cast<std::size_t>(places[i][key] * static_cast<double>(rounds.wanted()))];
    EXPECT_THAT(counts, Each(1)) << "key " << key;
  }
}

TEST(FitRoundsTest, WhenAllRunsCrashItEndsAfterTheFirstRoundAndSaysWhy) {
  FitRounds rounds = RoundsOf("metric=fitness value=1 n=100", 1);
  TargetReader reader(rounds.plan().targets, *controllers::FindScenario("flocking"));
  std::vector<SettingsPoint> places = rounds.Propose();
  places.resize(rounds.wanted());
  rounds.Begin(places);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (int run = 0; run < 20; ++run) rounds.Tell(i, 0, {.verdict = sim::Verdict::kCrashed}, reader);
  EXPECT_TRUE(rounds.Propose().empty());
  EXPECT_EQ(rounds.why(), fmt::format("only 0 of {0} settings gave a value for every target; {1} of {1} runs "
                                      "ended without a result",
                                      places.size(), places.size() * 20));
  EXPECT_EQ(rounds.Posterior(), nullptr);
}

TEST(FitRoundsTest, ASettingThatOneRunDoesNotKeepToIsNotChosen) {
  sim::RandomStream random(5, sim::StreamPurpose::kTest);
  // At the low end of turn_rate nobody is lost, elsewhere often.
  FitRounds rounds = RoundsOf(
      "metric=fitness value=1.5 n=100; statistic=every cases=empty runs=200 formula=birds_left == 10", 1);
  Finish(rounds, random);
  const FitSetting& last = rounds.settings().back();
  EXPECT_TRUE(last.judged);
  const bool all_kept = std::ranges::all_of(last.values[1], [](double kept) { return kept == 1.0; });
  EXPECT_EQ(rounds.Chosen() != nullptr, all_kept);
  EXPECT_LE(std::ranges::count_if(rounds.settings(), &FitSetting::judged), 5);
}

}  // namespace
}  // namespace gauntlet
