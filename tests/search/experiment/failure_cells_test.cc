// search.cells.
#include "search/experiment/failure_cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controllers/registry.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;

Result<Experiment> FlockingWith(const std::string& cells) {
  return ParseExperiment("", "test.toml",
                         {"scenario=flocking", "search.algorithm=archive", "search.cells=\"" + cells + "\""},
                         BuiltInCatalogue());
}

std::string ErrorOfCells(const std::string& cells) {
  const Result<Experiment> experiment = FlockingWith(cells);
  EXPECT_FALSE(experiment.ok());
  return experiment ? "" : experiment.error().message;
}

TEST(FailureCellsTest, AreTheScenariosUnlessOthersAreGiven) {
  const Result<Experiment> plain = FlockingWith("");
  ASSERT_TRUE(plain.ok()) << plain.error().message;
  EXPECT_THAT(CellsOf(*plain), ElementsAre(controllers::DescriptorAxis{"split_x", -3.0, 3.0, 5},
                                           controllers::DescriptorAxis{"split_y", -3.0, 3.0, 5}));
  const Result<Experiment> own = FlockingWith("birds_left:0:10:4  split_time:0:150.5:3");
  ASSERT_TRUE(own.ok()) << own.error().message;
  EXPECT_THAT(CellsOf(*own), ElementsAre(controllers::DescriptorAxis{"birds_left", 0.0, 10.0, 4},
                                         controllers::DescriptorAxis{"split_time", 0.0, 150.5, 3}));
}

TEST(FailureCellsTest, OfAFamilyOfMetricsOneMayBeNamed) {
  const auto axes = ParseCells("food_window_3:0:20:4", *controllers::FindScenario("foraging"));
  ASSERT_TRUE(axes.ok()) << axes.error().message;
  EXPECT_THAT(*axes, ElementsAre(controllers::DescriptorAxis{"food_window_3", 0.0, 20.0, 4}));
}

TEST(FailureCellsTest, SayWhatIsWrong) {
  EXPECT_EQ(ErrorOfCells("split_z:-3:3:5"),
            "--set search.cells=\"split_z:-3:3:5\": search.cells: 'split_z:-3:3:5': flocking does not report "
            "it: unknown metric 'split_z'; did you mean 'split_x'?");
  EXPECT_EQ(
      ErrorOfCells("split_x:3:3:5"),
      "--set search.cells=\"split_x:3:3:5\": search.cells: 'split_x:3:3:5': the range from 3 to 3 is empty");
  EXPECT_EQ(ErrorOfCells("split_x:3:-3:5"),
            "--set search.cells=\"split_x:3:-3:5\": search.cells: 'split_x:3:-3:5': the range from 3 to -3 "
            "is empty");
  EXPECT_EQ(ErrorOfCells("split_x:a:3:5"),
            "--set search.cells=\"split_x:a:3:5\": search.cells: 'split_x:a:3:5': a to 3 are no two numbers");
  EXPECT_EQ(ErrorOfCells("split_x:-inf:3:5"),
            "--set search.cells=\"split_x:-inf:3:5\": search.cells: 'split_x:-inf:3:5': -inf to 3 are no two "
            "numbers");
  EXPECT_EQ(ErrorOfCells("split_x:-3:3:0"),
            "--set search.cells=\"split_x:-3:3:0\": search.cells: 'split_x:-3:3:0': 0 parts: a whole number "
            "from 1 to 10000 is needed");
  EXPECT_EQ(ErrorOfCells("split_x"),
            "--set search.cells=\"split_x\": search.cells: 'split_x': METRIC:FROM:TO:PARTS is needed, as in "
            "x:-3:3:5");
  EXPECT_EQ(ErrorOfCells("split_x:-3:3:5 split_x:0:1:2"),
            "--set search.cells=\"split_x:-3:3:5 split_x:0:1:2\": search.cells: 'split_x' stands twice");
  EXPECT_EQ(ErrorOfCells("split_x:-3:3:500 split_y:-3:3:500"),
            "--set search.cells=\"split_x:-3:3:500 split_y:-3:3:500\": search.cells: 250000 cells; 10000 are "
            "the most");
  EXPECT_EQ(ErrorOfCells(" "), "--set search.cells=\" \": search.cells names no metric");
}

}  // namespace
}  // namespace gauntlet
