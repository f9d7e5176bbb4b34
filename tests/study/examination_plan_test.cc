#include "study/examination_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;

Result<ExaminationPlan> Plan(const std::string& experiment, std::uint64_t runs) {
  return PlanExamination(LoadExperiment(experiment, {}, BuiltInCatalogue()).value(), runs);
}

TEST(ExaminationPlanTest, SpendsItsRunsOnSearchMarginsAndQuestions) {
  const ExaminationPlan plan = Plan("flocking", 0).value();
  EXPECT_EQ(plan.runs, 8000U);
  EXPECT_EQ(plan.random_cases, 200U);
  EXPECT_THAT(plan.vary,
              ElementsAre("random_faults.count=0..5", "noise.wheels.gaussian=0..0.5",
                          "noise.proximity.gaussian=0..0.5", "noise.omnidirectional_camera.drop=0..0.5"));
  EXPECT_EQ(plan.minimised, 3U);
  EXPECT_EQ(plan.margin_runs, 600U);
  EXPECT_EQ(plan.search_runs, 8000U - 25U * 20U - 3U * 350U - 200U - 4U * 600U);
  EXPECT_EQ(plan.search_length, "search.runs=3850");
  EXPECT_TRUE(plan.unvaried.empty());
}

TEST(ExaminationPlanTest, WithoutAxesOfFailuresTheSearchIsGenetic) {
  Experiment experiment = LoadExperiment("flocking", {}, BuiltInCatalogue()).value();
  experiment.scenario = "light-flocking";
  const ExaminationPlan plan = PlanExamination(experiment, 0).value();
  EXPECT_EQ(plan.algorithm, "genetic");
  EXPECT_EQ(plan.search_length.substr(0, 19), "search.generations=");
}

TEST(ExaminationPlanTest, OfFewRunsLooksAtFewerDisturbances) {
  const ExaminationPlan plan = Plan("flocking", 1900).value();
  EXPECT_EQ(plan.minimised, 1U);
  EXPECT_THAT(plan.vary, ElementsAre("random_faults.count=0..5", "noise.wheels.gaussian=0..0.5"));
  EXPECT_EQ(plan.margin_runs, 210U);
  EXPECT_THAT(plan.unvaried,
              ElementsAre("noise.proximity.gaussian=0..0.5", "noise.omnidirectional_camera.drop=0..0.5"));
  EXPECT_TRUE(Plan("flocking", 1200)->vary.empty());
  EXPECT_EQ(Plan("flocking", 1199).error().message,
            "1199 runs are too few for an examination: at least 1200 are needed");
}

}  // namespace
}  // namespace gauntlet
