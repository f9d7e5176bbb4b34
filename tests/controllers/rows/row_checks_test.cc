// Covers: controllers/rows/row_json.cc
#include "controllers/rows/row_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>

#include "controllers/registry.h"
#include "controllers/rows/row_json.h"

namespace gauntlet::controllers {
namespace {

using testing::HasSubstr;

// With a value in every member.
ScenarioInfo Patrol() {
  return {.name = "patrol",
          .description = "go everywhere",
          .default_controller = "guard",
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
          .failures = {.axes = {{"missed_x", -3.0, 3.0, 6}},
                       .place = {{"missed_x", "missed_y", 0.5}},
                       .kinds = {{"window_2", 0.0, "nothing in the second window"}}},
          .failure_types = {{{3, "north", "left", "top"}}, "side", "end", "somewhere", "measured by nobody"},
          .any_controller = true};
}

Result<PluginRows> ReadBack(const PluginRows& rows) {
  return ReadRows(nlohmann::json::parse(WriteRows(rows)), "here");
}

void ExpectSame(const ScenarioInfo& told, const ScenarioInfo& row) {
  EXPECT_EQ(told.name, row.name);
  EXPECT_EQ(told.description, row.description);
  EXPECT_EQ(told.default_controller, row.default_controller);
  EXPECT_EQ(told.any_controller, row.any_controller);
  EXPECT_EQ(told.style, row.style);
  EXPECT_EQ(told.parameters, row.parameters);
  EXPECT_EQ(told.time_limit, row.time_limit);
  EXPECT_EQ(told.metrics, row.metrics);
  EXPECT_EQ(told.failing, row.failing);
  EXPECT_EQ(told.failure_types, row.failure_types);
  EXPECT_EQ(told.failures.place, row.failures.place);
  EXPECT_EQ(told.failures.kinds, row.failures.kinds);
  EXPECT_EQ(told.failures.axes, row.failures.axes);
  EXPECT_EQ(told.requirements, nullptr);
  EXPECT_EQ(told.create, nullptr);
}

TEST(RowJson, ScenariosReadBackWithoutTheirFunctions) {
  PluginRows rows{.scenarios = {Patrol()}};
  rows.scenarios.insert(rows.scenarios.end(), Scenarios().begin(), Scenarios().end());
  const Result<PluginRows> read = ReadBack(rows);
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->scenarios.size(), rows.scenarios.size());
  for (std::size_t i = 0; i < rows.scenarios.size(); ++i) {
    SCOPED_TRACE(rows.scenarios[i].name);
    ExpectSame(read->scenarios[i], rows.scenarios[i]);
  }
}

TEST(RowJson, ControllersReadBackWithoutTheirFunctions) {
  const PluginRows rows{.controllers = {Controllers().begin(), Controllers().end()}};
  const Result<PluginRows> read = ReadBack(rows);
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->controllers.size(), rows.controllers.size());
  for (std::size_t i = 0; i < rows.controllers.size(); ++i) {
    const ControllerInfo& told = read->controllers[i];
    const ControllerInfo& row = rows.controllers[i];
    SCOPED_TRACE(row.name);
    EXPECT_EQ(told.name, row.name);
    EXPECT_EQ(told.scenario, row.scenario);
    EXPECT_EQ(told.description, row.description);
    std::vector<ParameterInfo> parameters = row.parameters;
    for (ParameterInfo& parameter : parameters) parameter.came_later = false;  // is not told
    EXPECT_EQ(told.parameters, parameters);
    EXPECT_EQ(told.make, nullptr);
  }
}

TEST(RowJson, MembersOfAnOlderOrNewerProgramDoNotMatter) {
  nlohmann::json json = nlohmann::json::parse(JsonOf(Patrol()).dump());
  json.erase("failing");
  json["favourite_colour"] = "red";
  ScenarioInfo expected = Patrol();
  expected.failing = ScenarioInfo().failing;
  ExpectSame(ReadScenario(json), expected);
}

TEST(RowJson, KeepsNumbersThatJsonDoesNotHave) {
  ScenarioInfo scenario = Patrol();
  scenario.parameters[0].max = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ReadScenario(nlohmann::json::parse(JsonOf(scenario).dump())).parameters, scenario.parameters);
}

TEST(RowChecks, RefuseAPluginThatBringsNothing) {
  const Status checked = CheckRows({});
  ASSERT_FALSE(checked.ok());
  EXPECT_EQ(checked.error().message, "it brings neither a controller nor a scenario");
}

TEST(RowChecks, RefuseWhatIsNoDescription) {
  for (const std::string text : {"3", "{}", R"({"format": 1, "controllers": [], "scenarios": []})",
                                 R"({"format": 2, "controllers": 3, "scenarios": []})",
                                 R"({"format": 2, "controllers": [{"name": 7}], "scenarios": []})",
                                 R"({"format": 2, "controllers": [[]], "scenarios": []})"}) {
    SCOPED_TRACE(text);
    const Result<PluginRows> read = ReadRows(nlohmann::json::parse(text), "here");
    ASSERT_FALSE(read.ok());
    EXPECT_TRUE(read.error().message.starts_with("here: no description of a plug-in"))
        << read.error().message;
  }
}

struct Mistake {
  std::string what;
  std::function<void(ScenarioInfo&)> make;
  std::string message;
};
void PrintTo(const Mistake& mistake, std::ostream* os) {
  *os << mistake.what;
}

class WrongScenario : public testing::TestWithParam<Mistake> {};

TEST_P(WrongScenario, IsRefusedByWhatIsWrong) {
  ScenarioInfo scenario = Patrol();
  GetParam().make(scenario);
  const Status checked = CheckScenario(scenario);
  ASSERT_FALSE(checked.ok());
  EXPECT_THAT(checked.error().message, HasSubstr(GetParam().message));
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    Mistakes, WrongScenario,
    testing::Values(
        Mistake{"Name", [](ScenarioInfo& s) { s.name = "a b"; }, "scenario 'a b': a name has 1 to 64"},
        Mistake{"Controller", [](ScenarioInfo& s) { s.default_controller = ""; },
                "scenario 'patrol': its default_controller names no controller"},
        Mistake{"TimeLimit", [](ScenarioInfo& s) { s.time_limit = "time_limit"; },
                "its time limit 'time_limit', in s, is none of its parameters"},
        Mistake{"Range", [](ScenarioInfo& s) { s.parameters[0].max = 0.0; }, "its range is 1 to 0"},
        Mistake{"Failing", [](ScenarioInfo& s) { s.failing = "missed_x"; },
                "failing = 'missed_x' is neither total_failure nor a metric with the unit yes/no"},
        Mistake{"MetricTwice", [](ScenarioInfo& s) { s.metrics[1].name = "late"; },
                "metric 'late' is given twice"},
        Mistake{"MetricName", [](ScenarioInfo& s) { s.metrics[1].name = "x,y"; }, "metric 'x,y': a name"},
        Mistake{"None", [](ScenarioInfo& s) { s.metrics[1].none = kNan; },
                "metric 'missed_x': what stands for none must be a number"},
        Mistake{"Place", [](ScenarioInfo& s) { s.failures.place->x = "x"; },
                "the failure's place is of the metric 'x', which is none of its metrics"},
        Mistake{"Distance", [](ScenarioInfo& s) { s.failures.place->same_within = 0.0; },
                "the same within 0 m; more than 0 is needed"},
        Mistake{"Kind", [](ScenarioInfo& s) { s.failures.kinds[0].metric = "w"; },
                "a failure kind is of the metric 'w'"},
        Mistake{"TypeTwice",
                [](ScenarioInfo& s) { s.failure_types.types.push_back(s.failure_types.types[0]); },
                "failure type 3 is given twice"},
        Mistake{"Axis", [](ScenarioInfo& s) { s.failures.axes[0].max = -3.0; },
                "the descriptor axis of 'missed_x' goes from -3 to -3 in 6 parts"},
        Mistake{"Parts", [](ScenarioInfo& s) { s.failures.axes[0].parts = 0; }, "in 0 parts; 1 to 1000"}),
    [](const testing::TestParamInfo<Mistake>& parameter) { return parameter.param.what; });

}  // namespace
}  // namespace gauntlet::controllers
