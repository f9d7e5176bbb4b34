#include "search/archive/failure_archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet {
namespace {

using ::testing::ElementsAre;

const std::vector<controllers::DescriptorAxis> kAxes = {
    {"x", -3.0, 3.0, 5},
    {"y", 0.0, 2.0, 2},
};

Finding FindingOf(IndividualId id, std::size_t obstacles, const std::vector<Descriptor>& failures) {
  Finding finding;
  finding.individual.id = id;
  finding.individual.test_case.obstacles.assign(obstacles, {.length = 0.5});
  finding.failures = failures;
  return finding;
}

TEST(DescriptorGridTest, CutsEachAxisIntoEqualPartsAndTakesInWhatLiesOutside) {
  const DescriptorGrid grid(kAxes);
  EXPECT_EQ(grid.cells(), 10U);
  EXPECT_EQ(grid.CellOf({-3.0, 0.0}), 0U);
  EXPECT_EQ(grid.CellOf({-1.81, 0.99}), 0U);
  EXPECT_EQ(grid.CellOf({-1.79, 1.0}), 3U);
  EXPECT_EQ(grid.CellOf({-100.0, 100.0}), 1U);
  EXPECT_EQ(grid.CellOf({3.0, 2.0}), 9U);
  EXPECT_THAT(grid.PartsOf(9), ElementsAre(4, 1));
  EXPECT_THAT(grid.PartsOf(3), ElementsAre(1, 1));
}

TEST(DescriptorGridTest, ARunWithoutOneOfTheMetricsIsNotDescribed) {
  const DescriptorGrid grid(kAxes);
  RunOutcome run;
  run.metrics = {{"y", 0.5}, {"z", 9.0}, {"x", -1.0}};
  EXPECT_THAT(grid.Describe(run).value(), ElementsAre(-1.0, 0.5));
  run.metrics = {{"x", -1.0}};
  EXPECT_FALSE(grid.Describe(run).has_value());
}

TEST(FailureArchiveTest, FewerObstaclesWinThenLessLength) {
  EXPECT_LT((LayoutSize{1, 9.0}), (LayoutSize{2, 0.1}));
  EXPECT_LT((LayoutSize{2, 0.1}), (LayoutSize{2, 0.2}));
  EXPECT_EQ(SizeOf({{.length = 0.5}, {.length = 1.0}}), (LayoutSize{2, 1.5}));
}

TEST(FailureArchiveTest, TheMiddleIsTheMedianOfEachAxis) {
  EXPECT_THAT(FindingOf(1, 1, {{0.0, 1.0}, {5.0, 0.0}, {0.5, 2.0}}).Middle(), ElementsAre(0.5, 1.0));
}

TEST(FailureArchiveTest, KeepsTheSmallestOfACellAndWhatMayReplaceIt) {
  FailureArchive archive(kAxes);
  const std::vector<Descriptor> here = {{0.0, 0.5}};
  EXPECT_EQ(archive.EliteOf(4), nullptr);
  EXPECT_TRUE(archive.Add(FindingOf(1, 8, here)));
  EXPECT_TRUE(archive.Add(FindingOf(2, 2, here)));
  EXPECT_FALSE(archive.Add(FindingOf(3, 3, here)));
  EXPECT_FALSE(archive.Add(FindingOf(4, 2, here))) << "who came first stays";
  ASSERT_EQ(archive.shelves().size(), 1U);
  EXPECT_EQ(archive.shelves().at(4).size(), FailureArchive::kShelf) << "the largest left";
  EXPECT_FALSE(archive.WouldWin(4, {2, 1.0}));
  EXPECT_TRUE(archive.WouldWin(4, {1, 99.0}));
  EXPECT_TRUE(archive.WouldWin(5, {8, 99.0}));

  EXPECT_EQ(archive.Take(2).individual.id, 2U);
  EXPECT_EQ(archive.EliteOf(4)->individual.id, 4U);
  archive.Take(4);
  archive.Take(3);
  EXPECT_TRUE(archive.shelves().empty());
}

}  // namespace
}  // namespace gauntlet
