#include "search/repair/repair_course.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kCourseSeed = 7;
constexpr std::size_t kTraining = 20;
constexpr std::size_t kHeldOutCases = 12;
constexpr std::size_t kRandomCases = 50;

Experiment Broken(int runs = 2000) {
  Experiment experiment = ParseExperiment("", "toy.toml", {"scenario=flocking"}, BuiltInCatalogue()).value();
  experiment.search.algorithm = "repair";
  experiment.repair = {.vary =
                           "controller_parameters.turning_speed_factor=0..1 "
                           "controller_parameters.turn_rate=0.05..2 "
                           "controller_parameters.wander_turn_probability=0..1",
                       .runs = runs,
                       .training = kTraining,
                       .guards = kTraining,
                       .units = "4 4 4"};
  return experiment;
}

Result<RepairPlan> PlanOf(const Experiment& experiment,
                          std::size_t cases = 2 * kTraining + kHeldOutCases + kRandomCases) {
  return MakeRepairPlan(experiment, AllKeysOf(experiment), cases, kCourseSeed);
}

using Outcome = std::function<RunOutcome(const std::vector<double>& values, std::size_t of_case)>;

RunOutcome FailsIf(bool fails, double contacts = 2.0) {
  RunOutcome outcome{.fitness = fails ? 0.0 : 1.0, .total_failure = fails};
  outcome.effects = {.contacts = contacts, .seconds = 10.0, .distance = 3.0};
  return outcome;
}

std::vector<double> ValuesIn(const RepairCourse& course, std::size_t setting) {
  std::vector<double> values;
  for (const KeyValue& value : course.ValuesOf(setting)) values.push_back(NumberOf(value));
  return values;
}

// To its end; how many runs were asked for.
std::uint64_t Drive(RepairCourse& course, const Outcome& outcome) {
  std::uint64_t asked = 0;
  for (auto runs = course.Next(); !runs.empty(); runs = course.Next()) {
    asked += runs.size();
    for (const SettingsRun& run : runs) course.Tell(run, outcome(ValuesIn(course, run.setting), run.of_case));
  }
  EXPECT_TRUE(course.AtEnd());
  return asked;
}

RepairCourse CourseOf(const Experiment& experiment) {
  return RepairCourse(PlanOf(experiment).value(), "total_failure");
}

// Failing cases fail below a turning speed that differs from case to case, random ones seldom.
RunOutcome OneIsAtFault(const std::vector<double>& values, std::size_t of_case) {
  const bool failing =
      of_case < kTraining || (of_case >= 2 * kTraining && of_case < 2 * kTraining + kHeldOutCases);
  return FailsIf(values[0] < (failing ? 0.6 + 0.02 * static_cast<double>(of_case % 10) : 0.1));
}

TEST(RepairCourse, FindsTheParameterThatIsAtFaultAndProvesIt) {
  RepairCourse course = CourseOf(Broken());
  const std::uint64_t asked = Drive(course, OneIsAtFault);
  EXPECT_LE(course.searched(), 2000U);
  EXPECT_GT(course.generations(), 5U);
  EXPECT_LE(asked, course.RunsPlanned());
  const std::size_t repaired = course.repaired().value();
  EXPECT_GT(ValuesIn(course, repaired)[0], 0.75);
  const RepairCases& cases = course.plan().cases;
  const auto held_out = [&](std::size_t setting) {
    return course.TallyOf(setting, cases.first_held_out(), cases.held_out());
  };
  EXPECT_EQ(held_out(RepairCourse::kOriginal).runs, 3 * 12);
  EXPECT_EQ(held_out(RepairCourse::kOriginal).failures, 3 * 12);
  EXPECT_EQ(held_out(repaired).failures, 0);
  EXPECT_EQ(held_out(course.AloneOf(0).value()).failures, 0);
  EXPECT_FALSE(course.AloneOf(1).has_value());
  EXPECT_EQ(held_out(course.AllButOf(0).value()).failures, 3 * 12);
  EXPECT_EQ(course.TallyOf(repaired, cases.first_random(), cases.random).runs, 50);
  EXPECT_EQ(course.CurveOf(0).size(), 9U);
}

TEST(RepairCourse, BeginsItsSearchWhereParametersDoBestTogether) {
  RepairCourse course = CourseOf(Broken(400));
  Drive(course, [](const std::vector<double>& values, std::size_t of_case) {
    return FailsIf(of_case % 2 == 0 ? values[0] < 0.9 : values[1] < 1.7);
  });
  const std::vector<double> repaired = ValuesIn(course, *course.repaired());
  EXPECT_GE(repaired[0], 0.9);
  EXPECT_GE(repaired[1], 1.7);
}

TEST(RepairCourse, RepairsByOneParameterWhereSeveralDoNotGoTogether) {
  RepairCourse course = CourseOf(Broken(160));
  Drive(course, [](const std::vector<double>& values, std::size_t of_case) {
    const bool random = of_case >= kTraining && of_case < 2 * kTraining;
    return FailsIf((values[0] < 0.7) == (values[1] < 1.2) && !random);
  });
  const std::vector<double> repaired = ValuesIn(course, *course.repaired());
  EXPECT_NE(repaired[0] < 0.7, repaired[1] < 1.2);
}

TEST(RepairCourse, HeldOutCasesTakeNoPart) {
  RepairCourse one = CourseOf(Broken());
  RepairCourse other = CourseOf(Broken());
  Drive(one, OneIsAtFault);
  Drive(other, [](const std::vector<double>& values, std::size_t of_case) {
    return of_case >= 2 * kTraining ? FailsIf(values[1] > 0.5) : OneIsAtFault(values, of_case);
  });
  EXPECT_EQ(one.ValuesOf(*one.repaired()), other.ValuesOf(*other.repaired()));
}

TEST(RepairCourse, GuardsKeepWhatWouldBreakRandomCases) {
  RepairCourse course = CourseOf(Broken());
  Drive(course, [](const std::vector<double>& values, std::size_t of_case) {
    const bool guard = of_case >= kTraining && of_case < 2 * kTraining;
    return FailsIf(guard ? values[1] < 0.4 : values[1] > 0.6);
  });
  const double turn_rate = ValuesIn(course, *course.repaired())[1];
  EXPECT_GT(turn_rate, 0.4);
  EXPECT_LT(turn_rate, 0.6);
}

TEST(RepairCourse, ContactsMayGrowByATenth) {
  RepairCourse course = CourseOf(Broken());
  Drive(course, [](const std::vector<double>& values, std::size_t) {
    return FailsIf(values[0]<0.55, values[0]> 0.8 ? 20.0 : 2.0);
  });
  const double speed = ValuesIn(course, *course.repaired())[0];
  EXPECT_GE(speed, 0.55);
  EXPECT_LE(speed, 0.8);
}

TEST(RepairCourse, ARunWithoutAResultCountsAsAFailure) {
  RepairCourse course = CourseOf(Broken());
  Drive(course, [](const std::vector<double>& values, std::size_t) {
    RunOutcome outcome = FailsIf(values[0] < 0.6);
    if (values[0] > 0.8) outcome.verdict = sim::Verdict::kRefused;
    return outcome;
  });
  EXPECT_LE(ValuesIn(course, *course.repaired())[0], 0.8);
}

TEST(RepairCourse, AsksTheSameForTheSameOutcomes) {
  RepairCourse one = CourseOf(Broken());
  RepairCourse other = CourseOf(Broken());
  while (true) {
    const std::vector<SettingsRun> runs = one.Next();
    const std::vector<SettingsRun> again = other.Next();
    ASSERT_EQ(runs.size(), again.size());
    if (runs.empty()) break;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      ASSERT_EQ(runs[i].setting, again[i].setting);
      ASSERT_EQ(runs[i].of_case, again[i].of_case);
      one.Tell(runs[i], OneIsAtFault(ValuesIn(one, runs[i].setting), runs[i].of_case));
      other.Tell(runs[i], OneIsAtFault(ValuesIn(other, runs[i].setting), runs[i].of_case));
    }
  }
}

TEST(RepairCourse, SaysWhatIsWrongWithAPlan) {
  Experiment narrow = Broken();
  narrow.repair.vary = "controller_parameters.turning_speed_factor=0.8..1";
  EXPECT_THAT(PlanOf(narrow).error().message,
              HasSubstr("the controller has 0.5, which is not in this range"));
  EXPECT_EQ(PlanOf(Broken(50)).error().message,
            "--budget 50: at least 150 runs are needed: the original controller in 40 cases, its best value "
            "alone in 20, and one generation");
  EXPECT_FALSE(PlanOf(Broken(), 30).ok());
}

}  // namespace
}  // namespace gauntlet
