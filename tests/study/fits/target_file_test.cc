#include "study/fits/target_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "search/experiment/experiment_file.h"
#include "search/fit/fit_targets.h"
#include "search/search_table.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::EndsWith;
using testing::IsEmpty;
using testing::SizeIs;
using testing_support::TemporaryDirectory;

class TargetFileTest : public testing::Test {
 protected:
  Result<FitTargets> Read(const std::string& text) const {
    std::ofstream(folder_ / "targets.toml") << text;
    return ReadTargetFile(folder_ / "targets.toml", *LoadExperiment("flocking", {}, BuiltInCatalogue()));
  }
  std::string ErrorOf(const std::string& text) const {
    const auto read = Read(text);
    return read.ok() ? "" : read.error().message.substr(folder_.path().size() + 1);
  }

  TemporaryDirectory folder_;
};

TEST_F(TargetFileTest, WritesTargetsInALineEach) {
  const auto read = Read(R"(
[[target]]
metric = "fitness"
value = 0.75
n = 100
[[target]]
statistic = "quantile"
quantile = 0.9
metric = "splits"
at_most = 3
cases = "random:50"
[[target]]
formula = "birds_left == 0"
value = 0.05
n = 200
[[require]]
formula = "birds_left == 10"
runs = 100
)");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->text,
            "cases=random statistic=mean metric=fitness value=0.75 n=100; "
            "cases=random:50 statistic=quantile metric=splits quantile=0.9 at_most=3; "
            "cases=random statistic=share value=0.05 n=200 formula=birds_left == 0; "
            "cases=empty statistic=every runs=100 formula=birds_left == 10");
  EXPECT_THAT(read->cases, IsEmpty());
}

TEST_F(TargetFileTest, AQuantileAndAShareMayStandInTheStatistic) {
  const std::string apart =
      "[[target]]\nmetric = \"splits\"\nstatistic = \"quantile\"\nquantile = 0.9\nat_most = 3\n"
      "[[target]]\nformula = \"birds_left == 0 || splits > 1\"\nvalue = 0.05\nn = 200\n";
  const std::string in_one =
      "[[target]]\nmetric = \"splits\"\nstatistic = \"quantile:0.9\"\nat_most = 3\n"
      "[[target]]\nstatistic = \"share: birds_left == 0 || splits > 1\"\nvalue = 0.05\nn = 200\n";
  ASSERT_EQ(ErrorOf(in_one), "");
  EXPECT_EQ(Read(in_one)->text, Read(apart)->text);
}

TEST_F(TargetFileTest, AColumnOfMeasuredRunsIsADistribution) {
  std::ofstream(folder_ / "runs.csv") << "run,fitness\n1,0.1\n2,0.2\n3,\n4,0.3\n5,0.4\n6,0.5\n7,0.6\n";
  const auto read = Read("[[target]]\ncsv = \"runs.csv\"\ncolumn = \"fitness\"\n");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const auto targets = ParseFitTargets(read->text, *controllers::FindScenario("flocking"));
  ASSERT_TRUE(targets.ok());
  ASSERT_THAT(*targets, SizeIs(1));
  const FitTarget& target = targets->front();
  EXPECT_EQ(target.statistic, FitTarget::Statistic::kDistribution);
  EXPECT_EQ(target.n, 6.0);
  EXPECT_THAT(target.values,
              testing::Pointwise(testing::DoubleNear(1e-12), BlockMeans({0.1, 0.2, 0.3, 0.4, 0.5, 0.6})));
}

TEST_F(TargetFileTest, CasesOfFilesAreHandedInOnce) {
  std::ofstream(folder_ / "wall.json") << R"({"obstacles": [{"x": 0, "y": 1.5, "length": 1, "width": 0.2}]})";
  const auto read = Read(
      "[[target]]\ncases = [\"wall.json\"]\nmetric = \"fitness\"\nat_least = 0.5\n"
      "[[target]]\ncases = [\"wall.json\"]\nmetric = \"splits\"\nat_most = 1\n");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_THAT(read->cases, SizeIs(1));
  EXPECT_EQ(read->text,
            "cases=given:1-1 statistic=mean metric=fitness at_least=0.5; "
            "cases=given:1-1 statistic=mean metric=splits at_most=1");
}

TEST_F(TargetFileTest, WhatCannotBeATargetIsNamedWithItsPlace) {
  std::ofstream(folder_ / "nan.csv") << "fitness\n0.1\nnan\n";
  std::ofstream(folder_ / "twice.csv") << "fitness,fitness\n0.1,0.2\n0.3,0.4\n";
  std::ofstream(folder_ / "one.csv") << "fitness\n0.1\n";
  std::ofstream(folder_ / "blocked.json")
      << R"({"obstacles": [{"x": 2.5, "y": 2.5, "length": 1, "width": 0.4}]})";
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"", "targets.toml: there is no [[target]], so there is nothing to fit to"},
      {"[[require]]\nformula = \"birds_left == 10\"\nruns = 100\n", "there is no [[target]]"},
      {"[[target]]\nmetric = \"fitness\"\nvalue = \"3\"\nn = 5\n",
       "targets.toml:3:1: value is text, expected a number"},
      {"[[target]]\ncsv = \"twice.csv\"\ncolumn = \"fitness\"\n",
       "twice.csv: column fitness is there more than once"},
      {"[[tragte]]\nvalue = 1\n", "targets.toml:1:1: unknown table 'tragte'; did you mean 'target'?"},
      {"[target]\nvalue = 1\n", "targets.toml:2:1: targets are written as [[target]]"},
      {"[[target]]\nmetrik = \"fitness\"\n",
       "targets.toml:2:1: unknown key 'metrik'; did you mean 'metric'?"},
      {"[[target]]\nmetric = \"food_taken\"\nvalue = 1\nn = 5\n",
       "target 'cases=random metric=food_taken n=5 value=1': flocking does not report it: unknown metric "
       "'food_taken'; known: fitness, total_failure, angular_order, birds_left, proportion_left, "
       "arrival_time, "
       "timeout, prey_path_length, splits, split_time, split_angle, split_speed_ratio, split_x, split_y"},
      {"[[target]]\nmetric = \"fitness\"\nstatistic = \"quantile\"\nquantile = 101\nvalue = 1\nn = 5\n",
       "quantile = 101: a number from 0 to 1 is needed"},
      {"[[target]]\nmetric = \"fitness\"\nstatistic = \"quantile:101\"\nvalue = 1\nn = 5\n",
       "quantile = 101: a number from 0 to 1 is needed"},
      {"[[target]]\nmetric = \"fitness\"\nstatistic = \"quantile:0.9\"\nquantile = 0.5\nvalue = 1\nn = 5\n",
       "targets.toml:1:1: statistic = quantile:0.9 and quantile = 0.5: one of them says it"},
      {"[[target]]\nstatistic = \"share:splits > 0\"\nformula = \"splits > 1\"\nvalue = 1\nn = 5\n",
       "targets.toml:1:1: statistic = share:splits > 0 and formula = splits > 1: one of them says it"},
      {"[[target]]\nstatistic = \"share:\"\nvalue = 1\nn = 5\n",
       "a formula is needed, as in birds_left == 0"},
      {"[[target]]\nmetric = \"fitness\"\nstatistic = \"mean:2\"\nvalue = 1\nn = 5\n",
       "unknown statistic 'mean:2'"},
      {"[[target]]\nmetric = \"fitness\"\nvalue = 1\nn = 0\n",
       "n = 0: a number from 2 to 1000000000 is needed"},
      {"[[target]]\nmetric = \"fitness\"\nn = 5\n", "one of value, at_most and at_least is needed"},
      {"[[target]]\ncases = \"campaigns/none\"\nmetric = \"fitness\"\nvalue = 1\nn = 5\n",
       "cases = campaigns/none: neither random, random:N, empty, a case file nor a campaign's subset"},
      {"[[target]]\ncsv = \"nan.csv\"\ncolumn = \"fitness\"\n",
       "nan.csv:3: fitness is 'nan', not a finite number"},
      {"[[target]]\ncsv = \"one.csv\"\ncolumn = \"fitness\"\n",
       "one.csv has 1 value in column fitness; at least two are needed"},
      {"[[target]]\ncsv = \"one.csv\"\n", "which column of one.csv? column = \"...\" is needed"},
      {"[[target]]\ncsv = \"one.csv\"\ncolumn = \"time\"\n",
       "one.csv: unknown column 'time'; known: fitness"},
      {"[[target]]\ncsv = \"none.csv\"\ncolumn = \"time\"\n", "none.csv: No such file or directory"},
      {"[[target]]\ncases = \"blocked.json\"\nmetric = \"fitness\"\nvalue = 1\nn = 5\n",
       "a robot's centre needs 0.1 m of room there"},
      {"[[target]]\ncases = [\"empty\", \"random\"]\nmetric = \"fitness\"\nvalue = 1\nn = 5\n",
       "cases = empty: neither random"},
      {"[[target]]\ncases = \"given:1-3\"\nmetric = \"fitness\"\nvalue = 1\nn = 5\n",
       "cases = given:1-3: neither"},
      {"[[target]]\ncases = []\nmetric = \"fitness\"\nvalue = 1\nn = 5\n", "cases is an array"},
      {"[[target]]\nmetric = \"fitness\"\nvalue = 1\n", "n is missing"},
      {"[[target]]\nmetric = \"fitness\"\nstatistic = \"median\"\nquantile = 0.9\nvalue = 1\nn = 5\n",
       "quantile has no place beside median"},
      {"[[require]]\nformula = \"splits == 0\"\nstatistic = \"mean\"\nruns = 9\n",
       "statistic has no place in [[require]]"},
      {"[[require]]\nformula = \"birds == 10\"\nruns = 10\n",
       "unknown measure 'birds'; did you mean 'birds_left'?"}};
  for (const auto& [text, message] : wrong) {
    SCOPED_TRACE(text);
    EXPECT_THAT(ErrorOf(text), testing::HasSubstr(message));
  }
}

}  // namespace
}  // namespace gauntlet
