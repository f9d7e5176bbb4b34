// Covers: report/figures/campaign_facts.cc
#include "report/figures/search_course.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/report/pages/facts.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

RunFacts InGeneration(RunFacts run, std::uint32_t generation, SearchId search = 1) {
  run.generation = generation;
  run.search = search;
  return run;
}

TEST(SearchCourseTest, ABlockIsAGeneration) {
  CampaignFacts facts = FactsOf("flocking");
  facts.runs = {InGeneration(RunOf(1, 0.8), 1), InGeneration(RunOf(2, 0.4), 1),
                InGeneration(RunOf(3, 0.0, 5), 2), InGeneration(RunOf(4, 0.2), 2)};
  const std::vector<SearchCourse> courses = CoursesOf(facts);
  ASSERT_THAT(courses, SizeIs(1));
  ASSERT_THAT(courses[0].repeats, SizeIs(1));
  const std::vector<CourseBlock>& blocks = courses[0].repeats[0];
  ASSERT_THAT(blocks, SizeIs(2));
  EXPECT_EQ(blocks[1].runs, 4U);
  EXPECT_DOUBLE_EQ(blocks[0].fitness.mean(), 0.6);
  EXPECT_DOUBLE_EQ(blocks[0].fitness.lowest(), 0.4);
  EXPECT_DOUBLE_EQ(blocks[1].failure_share, 0.5);
}

TEST(SearchCourseTest, WithoutGenerationsItIsCutIntoFiftyParts) {
  CampaignFacts facts = FactsOf("flocking");
  for (RunId id = 1; id <= 1000; ++id) facts.runs.push_back(RunOf(id, 0.5));
  const auto blocks = CoursesOf(facts)[0].repeats[0];
  ASSERT_THAT(blocks, SizeIs(50));
  EXPECT_EQ(blocks.back().runs, 1000U);
}

TEST(SearchCourseTest, SearchesThatDifferInTheirSeedAreRepeats) {
  CampaignFacts facts = FactsOf("flocking");
  facts.plans = {PlanOf("flocking", "search.population=10, seed 1", 1),
                 PlanOf("flocking", "search.population=10, seed 2", 2),
                 PlanOf("flocking-improved", "other", 1)};
  facts.runs = {InGeneration(RunOf(1, 0.2), 1, 1), InGeneration(RunOf(2, 0.6), 1, 2),
                InGeneration(RunOf(3, 0.1), 1, 3)};
  const std::vector<SearchCourse> courses = CoursesOf(facts);
  ASSERT_THAT(courses, SizeIs(2));
  EXPECT_EQ(courses[0].name, "search.population=10");
  EXPECT_THAT(courses[0].repeats, SizeIs(2));
  const analysis::FigureLine mean = FigureOf(courses[0], "t").panels[0].lines[1];
  EXPECT_THAT(mean.y, ElementsAre(0.4));
  EXPECT_THAT(mean.low, ElementsAre(0.2));
  EXPECT_THAT(mean.high, ElementsAre(0.6));
  EXPECT_THAT(FigureOf(courses[1], "t").panels[0].lines[1].low, IsEmpty()) << "one search has no band";
}

TEST(SearchCourseTest, RunsWithoutAResultCountAsSpentOnly) {
  CampaignFacts facts = FactsOf("flocking");
  RunFacts crashed = RunOf(1, 0.0);
  crashed.completed = false;
  facts.runs = {crashed};
  const CourseBlock block = CoursesOf(facts)[0].repeats[0][0];
  EXPECT_EQ(block.runs, 1U);
  EXPECT_TRUE(std::isnan(block.fitness.mean()));
  EXPECT_TRUE(std::isnan(block.fitness.lowest()));
  EXPECT_THAT(CoursesOf(FactsOf("flocking")), IsEmpty());
}

}  // namespace
}  // namespace gauntlet
