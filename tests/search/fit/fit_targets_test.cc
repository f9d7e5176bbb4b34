#include "search/fit/fit_targets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "controllers/registry.h"
#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

const controllers::ScenarioInfo& Flocking() {
  return *controllers::FindScenario("flocking");
}

FitTarget One(const std::string& text) {
  return ParseFitTargets(text, Flocking()).value().front();
}

std::string ErrorOfTarget(const std::string& text) {
  const auto targets = ParseFitTargets(text, Flocking());
  return targets ? "" : targets.error().message;
}

TEST(FitTargetsTest, ReadBackAsTheyAreWritten) {
  const std::string text =
      "cases=random statistic=mean metric=fitness value=0.654 n=100; "
      "cases=random:50 statistic=quantile metric=birds_left quantile=0.25 at_least=6 n=30; "
      "cases=given:1-12 statistic=share at_most=0.05 formula=birds_left == 0; "
      "cases=random statistic=distribution metric=fitness blocks=0,0.1,0.2,0.3,0.4,0.5 spread=0.2 n=40; "
      "cases=empty statistic=every runs=100 formula=birds_left == birds_left && fitness > 0";
  const auto targets = ParseFitTargets(text, Flocking());
  ASSERT_TRUE(targets.ok()) << targets.error().message;
  std::vector<std::string> again;
  for (const FitTarget& target : *targets) again.push_back(target.ToText());
  EXPECT_EQ(fmt::format("{}", fmt::join(again, "; ")), text);
}

TEST(FitTargetsTest, AMedianIsAQuantile) {
  EXPECT_EQ(One("statistic=median metric=fitness value=1 n=10").ToText(),
            "cases=random statistic=quantile metric=fitness quantile=0.5 value=1 n=10");
}

TEST(FitTargetsTest, StatisticsAreThoseOfTextbooks) {
  const std::vector<double> values = {2, 4, 4, 4, 5, 5, 7, 9};  // mean 5, squares about it 32
  EXPECT_THAT(StatisticOf(One("metric=fitness value=1 n=9"), values), ElementsAre(5.0));
  EXPECT_THAT(StatisticOf(One("statistic=sd metric=fitness value=1 n=9"), values),
              ElementsAre(DoubleNear(std::sqrt(32.0 / 7.0), 1e-12)));
  EXPECT_THAT(StatisticOf(One("statistic=median metric=fitness value=1 n=9"), values), ElementsAre(4.5));
  EXPECT_THAT(StatisticOf(One("statistic=quantile quantile=0.25 metric=fitness value=1 n=9"), values),
              ElementsAre(4.0));
  EXPECT_THAT(StatisticOf(One("metric=fitness value=1 n=9"), {1.0}), ElementsAre());
  EXPECT_THAT(StatisticOf(One("metric=fitness value=1 n=9"), {1.0, kNotMeasured, 3.0}), ElementsAre(2.0));
}

TEST(FitTargetsTest, BlocksShareTheValuesBetweenThem) {
  // The first value stands at .1 (.625 / 6.25), the second at .26: from 0 to 1/6 the line goes from .375
  // to 1.4167.
  const std::vector<double> blocks = BlockMeans({6, 5, 4, 3, 2, 1});
  EXPECT_NEAR(blocks[0], 0.375 + 1.0 / 12 / 0.16, 1e-12);
  for (std::size_t block = 0; block < kBlocks; ++block)
    EXPECT_NEAR(blocks[block] + blocks[kBlocks - 1 - block], 7.0, 1e-12);
  EXPECT_THAT(BlockMeans({7}), Pointwise(DoubleNear(1e-12), std::vector<double>(kBlocks, 7)));
}

// Normal values of mean 0 and standard deviation 1, whose blocks are 6 (pdf(q) - pdf(q')) between the
// quantiles q and q' of k/6.
TEST(FitTargetsTest, BlocksOfFewValuesAreThoseOfManyOnAverage) {
  constexpr int kSamples = 20'000;
  for (const int count : {20, 100}) {
    std::vector<double> sums(kBlocks, 0.0);
    sim::RandomStream random(3, sim::StreamPurpose::kTest);
    for (int sample = 0; sample < kSamples; ++sample) {
      std::vector<double> values;
      for (int i = 0; i < count; ++i) values.push_back(random.Gaussian());
      const std::vector<double> means = BlockMeans(values);
      for (std::size_t block = 0; block < kBlocks; ++block) sums[block] += means[block] / kSamples;
    }
    EXPECT_THAT(sums, Pointwise(DoubleNear(0.035),
                                std::vector<double>{-1.4991, -0.6825, -0.2121, 0.2121, 0.6825, 1.4991}))
        << count;
  }
}

// Of equal samples the mean difference of blocks is the Wasserstein-1 distance once they are as many.
RC_GTEST_PROP(BlockMeansProperties, MoveWithTheirValuesAndKeepTheirMean, (std::vector<int> numbers, int by)) {
  RC_PRE(!numbers.empty());
  std::vector<double> values;
  double sum = 0.0;
  for (const int number : numbers) sum += values.emplace_back(number % 1000);
  std::vector<double> moved = values;
  for (double& value : moved) value += by % 1000;
  const std::vector<double> before = BlockMeans(values);
  const std::vector<double> after = BlockMeans(moved);
  double sum_of_blocks = 0.0;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    RC_ASSERT(std::abs(after[i] - before[i] - by % 1000) < 1e-6);
    sum_of_blocks += before[i];
  }
  RC_ASSERT(std::abs(sum_of_blocks / kBlocks - sum / static_cast<double>(values.size())) < 1e-6);
}

TEST(FitTargetsTest, AReaderTakesFitnessMetricsAndFormulas) {
  const auto targets = ParseFitTargets(
                           "metric=fitness value=1 n=9; metric=birds_left value=1 n=9; "
                           "statistic=share value=0 n=9 formula=birds_left < 3 || total_failure == 1",
                           Flocking())
                           .value();
  TargetReader reader(targets, Flocking());
  RunOutcome run{.fitness = 0.25, .metrics = {{"birds_left", 4.0}}};
  EXPECT_THAT(reader.Read(run), ElementsAre(0.25, 4.0, 0.0));
  run.total_failure = true;
  EXPECT_THAT(reader.Read(run), ElementsAre(0.25, 4.0, 1.0));
}

TEST(FitTargetsTest, SayWhatTheyAskForInWords) {
  const FitTarget target = One("statistic=share at_most=0.05 formula=birds_left == 0");
  EXPECT_EQ(target.Title(), "share of birds_left == 0, random");
  EXPECT_EQ(target.Wanted(), "at most 0.05");
  EXPECT_EQ(One("metric=fitness value=0.654 n=100").Wanted(), "0.654 (n = 100)");
}

TEST(FitTargetsTest, SayWhatIsWrong) {
  const auto wrong = [](const std::string& text) {
    const std::string message = ErrorOfTarget(text);
    const std::string begin = "target '" + text + "': ";
    EXPECT_TRUE(message.starts_with(begin)) << message;
    return message.substr(std::min(begin.size(), message.size()));
  };
  EXPECT_EQ(wrong("metric=fitness"), "one of value, at_most and at_least is needed");
  EXPECT_EQ(wrong("metric=fitness value=1 at_most=2 n=9"), "one of value, at_most and at_least is needed");
  EXPECT_EQ(wrong("metric=fitness value=1"), "n is missing");
  EXPECT_EQ(wrong("metric=fitness value=1 n=0"), "n = 0: a number from 2 to 1000000000 is needed");
  EXPECT_EQ(wrong("metric=food value=1 n=9"),
            "flocking does not report it: " +
                wrong("metric=food value=1 n=9").substr(std::string("flocking does not report it: ").size()));
  EXPECT_EQ(wrong("statistic=quantile quantile=101 metric=fitness value=1 n=9"),
            "quantile = 101: a number from 0 to 1 is needed");
  EXPECT_EQ(wrong("statistic=share value=1.5 n=9 formula=fitness < 1"),
            "value = 1.5: a number from 0 to 1 is needed");
  EXPECT_EQ(wrong("statistic=share value=0.5 n=9"), "a formula is needed, as in birds_left == 0");
  EXPECT_EQ(wrong("statistic=share metric=fitness value=0.5 n=9 formula=fitness < 1"),
            "a share is that of a formula, not of a metric");
  EXPECT_EQ(wrong("metric=fitness value=1 n=9 colour=red"), "'colour' has no place here");
  EXPECT_EQ(wrong("statistic=avg metric=fitness value=1 n=9"),
            "unknown statistic 'avg'; known: mean, sd, median, quantile, share");
  EXPECT_EQ(ErrorOfTarget("cases=random:1 metric=fitness value=1 n=9"),
            "cases = random:1: random:N takes N from 2 to 100000");
  EXPECT_EQ(ErrorOfTarget("cases=somewhere metric=fitness value=1 n=9"),
            "cases = somewhere: neither random, random:N, empty, a case file nor a campaign's subset");
}

}  // namespace
}  // namespace gauntlet
