#include "search/probability/conditions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/search/probability/toy_probability.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

Result<SearchSetup> SetupOfConditions(std::vector<std::string> sets) {
  sets.insert(sets.begin(), {"scenario=flocking", "search.algorithm=probability"});
  TRY(const Experiment experiment, ParseExperiment("", "toy.toml", sets, BuiltInCatalogue()));
  return SetupOf(experiment, {}, {EmptyArena(experiment.arena)});
}

Conditions ConditionsOf(const std::vector<std::string>& sets) {
  const SearchSetup setup = SetupOfConditions(sets).value();
  return Conditions::Make(setup, AllKeysOf(setup.experiment)).value();
}

std::string Refusal(const std::vector<std::string>& sets) {
  const auto setup = SetupOfConditions(sets);
  if (!setup) return setup.error().message;
  const auto conditions = Conditions::Make(*setup, AllKeysOf(setup->experiment));
  return conditions ? "" : conditions.error().message;
}

const std::vector<std::string> kFour = {
    "conditions.noise.proximity.gaussian=0..0.2", "conditions.noise.wheels.gaussian=0.001..0.1:log",
    "conditions.noise.wheels.uniform=0.1..0.2:normal", "conditions.physics=impulse:3|box2d:1"};

// The shares of samples whose value of a key is in the lower half of its range, or its first entry.
std::vector<double> LowerShares(const Conditions& conditions, const std::vector<Sample>& samples) {
  std::vector<double> shares(4);
  for (const Sample& sample : samples) {
    const std::vector<KeyValue> values = conditions.ValuesOf(sample);
    shares[0] += std::get<double>(values[0]) < 0.1;
    shares[1] += std::get<double>(values[1]) < 0.01;
    shares[2] += std::abs(std::get<double>(values[2]) - 0.15) < 0.025;
    shares[3] += std::get<std::string>(values[3]) == "impulse";
  }
  for (double& share : shares) share /= static_cast<double>(samples.size());
  return shares;
}

TEST(ConditionsTest, HaveTheirDistributionsAlsoAfterManySteps) {
  const Conditions conditions = ConditionsOf(kFour);
  std::vector<Sample> drawn;
  for (std::uint32_t i = 0; i < 4000; ++i) drawn.push_back(conditions.Draw({i, sim::StreamPurpose::kTest}));
  // Within one standard deviation of a normal value that is cut off at two lie .6827 / .9545.
  const auto expected =
      testing::ElementsAre(testing::DoubleNear(0.5, 0.03), testing::DoubleNear(0.5, 0.03),
                           testing::DoubleNear(0.7152, 0.03), testing::DoubleNear(0.75, 0.03));
  EXPECT_THAT(LowerShares(conditions, drawn), expected);
  for (std::uint32_t step = 0; step < 10; ++step)
    for (std::uint32_t i = 0; i < 4000; ++i)
      drawn[i] = conditions.Near(drawn[i], {i, sim::StreamPurpose::kTest, step + 1});
  EXPECT_THAT(LowerShares(conditions, drawn), expected);
}

TEST(ConditionsTest, DensityIsAShareOfTheLargest) {
  const Conditions conditions = ConditionsOf(kFour);
  Sample sample = conditions.Draw({1, sim::StreamPurpose::kTest});
  sample.scores = {0.7, -8.0, 0.0, -5.0};
  EXPECT_NEAR(conditions.DensityOf(sample), 1.0, 1e-6);
  sample.scores = {0.7, 8.0, 0.0, 5.0};  // a hundredth of the largest, and a third
  EXPECT_NEAR(conditions.DensityOf(sample), 1.0 / 300.0, 1e-6);
  sample.scores = {0.7, -8.0, 9.0, -5.0};  // two standard deviations from the middle
  EXPECT_NEAR(conditions.DensityOf(sample), std::exp(-2.0), 1e-6);
}

TEST(ConditionsTest, StepsChangeSomeObstaclesAndLeaveTheCaseValid) {
  const Conditions conditions = ConditionsOf({});
  ASSERT_TRUE(conditions.generates());
  Sample sample = conditions.Draw({1, sim::StreamPurpose::kTest});
  std::map<std::size_t, int> changed;
  for (std::uint32_t step = 0; step < 400; ++step) {
    const Sample next = conditions.Near(sample, {1, sim::StreamPurpose::kTest, step + 1});
    const sim::Genome before = conditions.CaseOf(sample).obstacles;
    const sim::TestCase after = conditions.CaseOf(next);
    EXPECT_FALSE(sim::CheckValidity(after, {}).has_value());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < before.size(); ++i) differing += before[i] != after.obstacles[i];
    ++changed[differing];
    sample = next;
  }
  EXPECT_GT(changed[1] + changed[2] + changed[3], 250);  // of eight, each with a quarter
  EXPECT_LT(changed[8], 5);
}

TEST(ConditionsTest, GivenCasesAreDrawnByTheirWeights) {
  SearchSetup setup = SetupOfConditions({"probability.weights=1 0 3"}).value();
  setup.cases.assign(3, setup.cases.front());
  const Conditions conditions = Conditions::Make(setup, AllKeysOf(setup.experiment)).value();
  EXPECT_FALSE(conditions.generates());
  std::map<std::size_t, int> drawn;
  for (std::uint32_t i = 0; i < 4000; ++i) ++drawn[conditions.Draw({i, sim::StreamPurpose::kTest}).of_case];
  EXPECT_EQ(drawn[1], 0);
  EXPECT_NEAR(drawn[2], 3000, 120);
  Sample rare;
  EXPECT_NEAR(conditions.DensityOf(rare), 1.0 / 3.0, 1e-12);
}

TEST(ConditionsTest, SaysWhatIsWrong) {
  EXPECT_THAT(Refusal({"conditions.noise.proximity.gaussian=0..5"}), HasSubstr("allowed 0 to"));
  EXPECT_THAT(Refusal({"conditions.noise.proximity.gausian=0..1"}),
              HasSubstr("did you mean 'noise.proximity.gaussian'"));
  EXPECT_THAT(Refusal({"conditions.noise.proximity.gaussian=0.1"}), HasSubstr("is no range"));
  EXPECT_THAT(Refusal({"conditions.noise.wheels.gaussian=0..0.1:log"}), HasSubstr("no logarithm"));
  EXPECT_THAT(Refusal({"conditions.physics=impulse:0|box2d:0"}), HasSubstr("sum to nothing"));
  EXPECT_THAT(Refusal({"conditions.physics=impulse:-1|box2d:2"}), HasSubstr("'-1' is no weight of impulse"));
  EXPECT_THAT(Refusal({"conditions.seed=1..5"}), HasSubstr("gives every run its seed"));
  EXPECT_THAT(Refusal({"conditions.genome.genes=1..5"}), HasSubstr("arenas are drawn from the ranges"));
  EXPECT_THAT(Refusal({"genome.genes=0"}), HasSubstr("nothing varies"));
  EXPECT_THAT(Refusal({"probability.weights=0"}), HasSubstr("sum to nothing"));
  EXPECT_THAT(Refusal({"probability.weights=1 2"}), HasSubstr("2 weights for 1 given case"));
  EXPECT_THAT(Refusal({"probability.weights=many"}), HasSubstr("'many' is no number"));
}

}  // namespace
}  // namespace gauntlet
