#include "controllers/command/command_rows.h"

#include <gtest/gtest.h>

#include "controllers/rows/row_checks.h"
#include "tests/controllers/command/command_definitions.h"

namespace gauntlet::controllers::command {
namespace {

using nlohmann::json;

TEST(CommandRows, AreAsRightAsThoseOfAPluginAndReadBack) {
  const Definition definition = DefinitionWith(
      {{"wall_limit", 30},
       {"metric", json::array({{{"name", "loss"}, {"formula", "10 - items"}, {"unit", "items"}}})},
       {"axis", json::array({{{"metric", "loss"}, {"max", 10}, {"parts", 5}}})},
       {"parameter", json::array({{{"name", "speed"}, {"default", 0.1}, {"high", 1}}})}});
  const PluginRows rows = RowsOf(definition);
  const Status right = CheckRows(rows);
  ASSERT_TRUE(right.ok()) << right.error().message;
  const auto read = ReadRows(json::parse(WriteRows(rows)), "here");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const ScenarioInfo& scenario = read->scenarios.at(0);
  EXPECT_EQ(scenario.TimeLimit({}), 30.0);
  EXPECT_EQ(scenario.metrics.size(), 2U);
  EXPECT_EQ(scenario.metrics[1].unit, "items");
  EXPECT_EQ(scenario.failures.axes, definition.axes);
  EXPECT_TRUE(scenario.Takes(read->controllers.at(0)));
  EXPECT_EQ(read->controllers[0].parameters, definition.parameters);
}

}  // namespace
}  // namespace gauntlet::controllers::command
