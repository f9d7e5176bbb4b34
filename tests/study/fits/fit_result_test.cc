// Covers: study/fits/fit_text.cc
#include "study/fits/fit_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "search/experiment/experiment_file.h"
#include "study/fits/fit_text.h"
#include "tests/search/fit/toy_fit.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

const std::string kTurn = "controller_parameters.turn_rate";
const std::string kSpeed = "controller_parameters.bird_speed";
const std::string kFactor = "controller_parameters.turning_speed_factor";

FitResult ToyResult(const std::string& vary, const std::string& targets, int runs = 4000,
                    const FitPosterior::Allowed& allowed = Everywhere) {
  Experiment experiment = FittedToy();
  experiment.fit = {.vary = vary, .targets = targets, .runs = runs, .judged = 200};
  FitRounds rounds(ToyPlan(experiment.fit).value(), 11, allowed);
  sim::RandomStream random(5, sim::StreamPurpose::kTest, 0);
  Finish(rounds, random);
  return ResultOf(experiment, rounds, true);
}

// The toy's mean fitness is 3 x^2 + sin(1) where only its first key varies.
TEST(FitResultTest, TellsWhatIsLikelyAndJudgesTheChosenSetting) {
  const FitResult fit = ToyResult(
      kTurn + "=0.5..1.5", "metric=fitness value=1.591 n=1000; metric=fitness statistic=sd value=0.5 n=1000");
  EXPECT_THAT(fit.trade_offs, IsEmpty());
  EXPECT_THAT(fit.contradictions, IsEmpty());
  ASSERT_THAT(fit.keys, SizeIs(1));
  EXPECT_TRUE(fit.keys[0].determined);
  EXPECT_EQ(fit.keys[0].range, "0.5..1.5");
  ASSERT_TRUE(fit.fitted);
  // That is 1.591 at x = 0.5, the middle of the range.
  const double chosen = fit.fitted->controller_parameters.at("turn_rate");
  EXPECT_NEAR(chosen, 1.0, 0.06);
  EXPECT_EQ(fit.keys[0].chosen, ToSet(chosen));
  EXPECT_EQ(fit.fitted->search.algorithm, "genetic");
  double weights = 0.0;
  for (const AcceptedSetting& one : fit.accepted) weights += one.weight;
  EXPECT_NEAR(weights, 1.0, 1e-9);
  EXPECT_THAT(AcceptedCsv(fit), testing::StartsWith("weight," + kTurn + "\n"));
}

TEST(FitResultTest, AKeyThatNothingDependsOnIsNotDetermined) {
  const FitResult fit = ToyResult(
      kTurn + "=0.5..1.5 scenario_parameters.rejoin_time=0..600",
      "metric=fitness value=1.591 n=1000; statistic=share value=1 n=100 formula=fitness < 1000", 3000);
  ASSERT_THAT(fit.keys, SizeIs(2));
  EXPECT_TRUE(fit.keys[0].determined);
  EXPECT_FALSE(fit.keys[1].determined);
  const std::string told = ToText(TellFit(fit, "dir", "gauntlet").front());
  EXPECT_THAT(told, HasSubstr("These targets do not determine scenario_parameters.rejoin_time"));
}

TEST(FitResultTest, KeysThatMakeUpForEachOtherAreNamed) {
  const FitResult fit =
      ToyResult(kTurn + "=0.5..1.5 " + kFactor + "=0..1", "metric=fitness value=1.5 n=2000");
  ASSERT_THAT(fit.trade_offs, SizeIs(1));
  EXPECT_EQ(fit.trade_offs[0].one, kTurn);
  EXPECT_EQ(fit.trade_offs[0].other, kFactor);
  EXPECT_LT(fit.trade_offs[0].correlation, -0.5);
  EXPECT_THAT(ToText(TellFit(fit, "dir", "gauntlet").front()), HasSubstr("make up for each other"));
}

TEST(FitResultTest, TargetsThatContradictEachOtherAreNamed) {
  const FitResult fit =
      ToyResult(kTurn + "=0.5..1.5 " + kSpeed + "=0.01..0.1:log",
                "metric=fitness value=2.5 n=1000; metric=fitness statistic=median value=1 n=1000");
  EXPECT_FALSE(fit.Met());
  EXPECT_THAT(
      fit.contradictions,
      ElementsAre("Two targets contradict each other: mean of fitness, random (2.5 (n = 1000)) and median of "
                  "fitness, random (1 (n = 1000)). Each alone can be met."));
  EXPECT_THAT(ToText(TellFit(fit, "dir", "gauntlet").back()), HasSubstr("The chosen setting meets "));
}

TEST(FitResultTest, ATargetOutOfReachIsNamedAlone) {
  const FitResult fit = ToyResult(kTurn + "=0.5..1.5", "metric=fitness value=30 n=1000", 1000);
  EXPECT_THAT(
      fit.contradictions,
      ElementsAre(
          "No setting within the ranges meets this target: mean of fitness, random (30 (n = 1000))."));
}

TEST(FitResultTest, ProgramsAreToldSettingsByTheirTypesAndTargetsByTheirParts) {
  const FitResult fit = ToyResult(
      kTurn + "=0.5..1.5 physics=impulse|box2d scenario_parameters.rejoin_time=0..600",
      "metric=fitness value=1.591 n=1000; metric=fitness statistic=quantile quantile=0.9 at_most=9; "
      "metric=fitness statistic=median at_least=-9; statistic=share value=1 n=100 formula=fitness < 1000; "
      "statistic=every runs=40 formula=fitness < 1000",
      6000);
  const auto told = nlohmann::json::parse(FitJson(fit, "dir"));
  EXPECT_EQ(told.at("accepted_count"), fit.accepted.size());
  ASSERT_EQ(told.at("accepted").size(), fit.accepted.size());
  double weights = 0.0;
  for (const auto& one : told.at("accepted")) {
    weights += one.at("weight").get<double>();
    EXPECT_TRUE(one.at("distance").is_null());
    EXPECT_TRUE(one.at("values").at(kTurn).is_number_float());
    EXPECT_TRUE(one.at("values").at("physics").is_string());
  }
  EXPECT_NEAR(weights, 1.0, 1e-9);
  EXPECT_EQ(told.at("chosen").size(), 3U);
  EXPECT_EQ(told.at("chosen").at(kTurn), fit.fitted->controller_parameters.at("turn_rate"));
  EXPECT_EQ(told.at("chosen").at("physics"), fit.keys[1].chosen);
  EXPECT_EQ(told.at("undetermined"), nlohmann::json({"physics", "scenario_parameters.rejoin_time"}));
  const std::vector<std::string> parts = {
      R"({"metric": "fitness", "statistic": "mean", "value": 1.591})",
      R"({"metric": "fitness", "statistic": "quantile:0.9", "at_most": 9.0})",
      R"({"metric": "fitness", "statistic": "median", "at_least": -9.0})",
      R"({"metric": null, "statistic": "share:fitness < 1000", "value": 1.0})",
      R"({"metric": null, "statistic": "every:fitness < 1000", "value": 1.0})"};
  ASSERT_EQ(told.at("targets").size(), parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto target = told.at("targets")[i];
    EXPECT_EQ(target.at("interval").size(), 2U);
    for (const char* key : {"target", "wanted", "ours", "interval", "misfit", "met"})
      EXPECT_EQ(target.erase(key), 1U) << key;
    EXPECT_EQ(target, nlohmann::json::parse(parts[i]));
  }
}

TEST(FitResultTest, WithoutAPosteriorNoSettingIsChosen) {
  Experiment experiment = FittedToy();
  experiment.fit = {.vary = kTurn + "=0.5..1.5", .targets = "metric=fitness value=1 n=10", .runs = 1000};
  const FitResult fit =
      ResultOf(experiment, FitRounds(ToyPlan(experiment.fit).value(), 11, Everywhere), false);
  const auto told = nlohmann::json::parse(FitJson(fit, "dir"));
  EXPECT_TRUE(told.at("chosen").is_null());
  EXPECT_EQ(told.at("accepted"), nlohmann::json::array());
  EXPECT_EQ(told.at("refused"), 0.0);
}

TEST(FitResultTest, RangesThatBreakARuleAreToldWithTheirShare) {
  const FitResult fit = ToyResult(kTurn + "=0.5..1.5", "metric=fitness value=1.591 n=1000", 1000,
                                  [](const SettingsPoint& place) { return place[0] < 0.75; });
  EXPECT_NEAR(fit.refused, 0.25, 0.05);
  EXPECT_EQ(TellFit(fit, "dir", "gauntlet").front().lead.back(),
            fmt::format("About {:.3g} % of the ranges was never simulated: settings there break a rule of "
                        "the experiment.",
                        100.0 * fit.refused));
}

TEST(FitResultTest, TheFittedExperimentReadsBack) {
  const FitResult fit = ToyResult(kTurn + "=0.5..1.5", "metric=fitness value=1.591 n=1000", 1000);
  const std::string toml = FittedToml(fit, "campaigns/one");
  EXPECT_THAT(toml, HasSubstr("# mean of fitness, random: wanted 1.591 (n = 1000), got "));
  const Result<Experiment> read = ParseExperiment(toml, "fitted.toml", {}, BuiltInCatalogue());
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->controller_parameters, fit.fitted->controller_parameters);
  EXPECT_EQ(read->name, fit.experiment.name + "-fitted");
}

}  // namespace
}  // namespace gauntlet
