#include "proto/scenario_description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>

#include "proto/plugin_description.h"

namespace gauntlet::proto {
namespace {

using testing::HasSubstr;

// With a value in every member.
DescribedScenario Patrol() {
  return {.name = "patrol",
          .description = "go everywhere",
          .default_controller = "guard",
          .any_controller = true,
          .style = {.member = "guard",
                    .lost = "astray",
                    .lost_is_failure = false,
                    .guide = "captain",
                    .annotations = {{"disc", "missed", sim::Mark::kFormerBeacon, "where nobody was"}}},
          .parameters = {{"seconds", "s", 10.0, 1.0, 60.0, false, "length of a run"}},
          .time_limit = "seconds",
          .metrics = {{"late", "yes/no", std::nullopt, "whether it took too long", false},
                      {"missed_x", "m", -1000.0, "where nobody was", true},
                      {"missed_y", "m", -1000.0, "where nobody was", true},
                      {"window_*", "", std::nullopt, "in each window", false}},
          .failing = "late",
          .failure_types = {{3, "north", "left", "top"}},
          .failure_columns = "side",
          .failure_rows = "end",
          .untyped_failure = "somewhere",
          .failure_note = "measured by nobody",
          .failure_place = DescribedFailurePlace{"missed_x", "missed_y", 0.5},
          .failure_kinds = {{"window_2", 0.0, "nothing in the second window"}},
          .descriptor_axes = {{"missed_x", -3.0, 3.0, 6}}};
}

TEST(ScenarioDescription, ReadsBackWhatWasWritten) {
  const PluginDescription description{.controllers = {}, .scenarios = {Patrol()}};
  const Result<PluginDescription> read = ReadDescription(WriteDescription(description), "here");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(*read, description);
}

TEST(ScenarioDescription, IsLeftOutWhereThereIsNone) {
  const PluginDescription description{
      .controllers = {{.name = "guard", .scenario = "any", .description = "", .parameters = {}}}};
  EXPECT_THAT(WriteDescription(description), testing::Not(HasSubstr("scenarios")));
  EXPECT_EQ(*ReadDescription(WriteDescription(description), "here"), description);
}

TEST(ScenarioDescription, RefusesAPluginThatBringsNothing) {
  const Status checked = CheckDescription({});
  ASSERT_FALSE(checked.ok());
  EXPECT_EQ(checked.error().message, "it brings neither a controller nor a scenario");
}

struct Mistake {
  std::string what;
  std::function<void(DescribedScenario&)> make;
  std::string message;
};
void PrintTo(const Mistake& mistake, std::ostream* os) {
  *os << mistake.what;
}

class WrongScenario : public testing::TestWithParam<Mistake> {};

TEST_P(WrongScenario, IsRefusedByWhatIsWrong) {
  DescribedScenario scenario = Patrol();
  GetParam().make(scenario);
  const Status checked = CheckScenario(scenario);
  ASSERT_FALSE(checked.ok());
  EXPECT_THAT(checked.error().message, HasSubstr(GetParam().message));
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    Mistakes, WrongScenario,
    testing::Values(
        Mistake{"Name", [](DescribedScenario& s) { s.name = "a b"; }, "scenario 'a b': a name has 1 to 64"},
        Mistake{"Controller", [](DescribedScenario& s) { s.default_controller = ""; },
                "scenario 'patrol': its default_controller names no controller"},
        Mistake{"TimeLimit", [](DescribedScenario& s) { s.time_limit = "time_limit"; },
                "its time limit 'time_limit', in s, is none of its parameters"},
        Mistake{"Range", [](DescribedScenario& s) { s.parameters[0].max = 0.0; }, "its range is 1 to 0"},
        Mistake{"Failing", [](DescribedScenario& s) { s.failing = "missed_x"; },
                "failing = 'missed_x' is neither total_failure nor a metric with the unit yes/no"},
        Mistake{"MetricTwice", [](DescribedScenario& s) { s.metrics[1].name = "late"; },
                "metric 'late' is given twice"},
        Mistake{"MetricName", [](DescribedScenario& s) { s.metrics[1].name = "x,y"; },
                "metric 'x,y': a name"},
        Mistake{"None", [](DescribedScenario& s) { s.metrics[1].none = kNan; },
                "metric 'missed_x': what stands for none must be a number"},
        Mistake{"Place", [](DescribedScenario& s) { s.failure_place->x = "x"; },
                "the failure's place is of the metric 'x', which is none of its metrics"},
        Mistake{"Distance", [](DescribedScenario& s) { s.failure_place->same_within = 0.0; },
                "the same within 0 m; more than 0 is needed"},
        Mistake{"Kind", [](DescribedScenario& s) { s.failure_kinds[0].metric = "w"; },
                "a failure kind is of the metric 'w'"},
        Mistake{"TypeTwice", [](DescribedScenario& s) { s.failure_types.push_back(s.failure_types[0]); },
                "failure type 3 is given twice"},
        Mistake{"Axis", [](DescribedScenario& s) { s.descriptor_axes[0].max = -3.0; },
                "the descriptor axis of 'missed_x' goes from -3 to -3 in 6 parts"},
        Mistake{"Parts", [](DescribedScenario& s) { s.descriptor_axes[0].parts = 0; },
                "in 0 parts; 1 to 1000"}),
    [](const testing::TestParamInfo<Mistake>& parameter) { return parameter.param.what; });

}  // namespace
}  // namespace gauntlet::proto
