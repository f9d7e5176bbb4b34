// What a worker says of a row is what a master has of it.
#include "master/directory/plugin_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "worker/plugin/plugin_rows.h"

namespace gauntlet {
namespace {

using controllers::ScenarioInfo;

void ExpectSameParameters(std::span<const controllers::ParameterInfo> told,
                          std::span<const controllers::ParameterInfo> row) {
  ASSERT_EQ(told.size(), row.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    SCOPED_TRACE(row[i].name);
    EXPECT_EQ(told[i].name, row[i].name);
    EXPECT_EQ(told[i].unit, row[i].unit);
    EXPECT_EQ(told[i].default_value, row[i].default_value);
    EXPECT_EQ(told[i].min, row[i].min);
    EXPECT_EQ(told[i].max, row[i].max);
    EXPECT_EQ(told[i].integer, row[i].integer);
    EXPECT_EQ(told[i].description, row[i].description);
  }
}

void ExpectSameStyle(const sim::RunStyle& told, const sim::RunStyle& row) {
  EXPECT_EQ(told.member, row.member);
  EXPECT_EQ(told.lost, row.lost);
  EXPECT_EQ(told.lost_is_failure, row.lost_is_failure);
  EXPECT_EQ(told.guide, row.guide);
  ASSERT_EQ(told.annotations.size(), row.annotations.size());
  for (std::size_t i = 0; i < row.annotations.size(); ++i) {
    EXPECT_EQ(told.annotations[i].kind, row.annotations[i].kind);
    EXPECT_EQ(told.annotations[i].label, row.annotations[i].label);
    EXPECT_EQ(told.annotations[i].mark, row.annotations[i].mark);
    EXPECT_EQ(told.annotations[i].legend, row.annotations[i].legend);
  }
}

void ExpectSameMetrics(const ScenarioInfo& told, const ScenarioInfo& row) {
  ASSERT_EQ(told.metrics.size(), row.metrics.size());
  for (std::size_t i = 0; i < row.metrics.size(); ++i) {
    EXPECT_EQ(told.metrics[i].name, row.metrics[i].name);
    EXPECT_EQ(told.metrics[i].unit, row.metrics[i].unit);
    EXPECT_EQ(told.metrics[i].none, row.metrics[i].none);
    EXPECT_EQ(told.metrics[i].description, row.metrics[i].description);
    EXPECT_EQ(told.metrics[i].descriptor, row.metrics[i].descriptor);
  }
  ASSERT_EQ(told.descriptor_axes.size(), row.descriptor_axes.size());
  for (std::size_t i = 0; i < row.descriptor_axes.size(); ++i) {
    EXPECT_EQ(told.descriptor_axes[i].metric, row.descriptor_axes[i].metric);
    EXPECT_EQ(told.descriptor_axes[i].min, row.descriptor_axes[i].min);
    EXPECT_EQ(told.descriptor_axes[i].max, row.descriptor_axes[i].max);
    EXPECT_EQ(told.descriptor_axes[i].parts, row.descriptor_axes[i].parts);
  }
}

void ExpectSameFailures(const ScenarioInfo& told, const ScenarioInfo& row) {
  EXPECT_EQ(told.failing, row.failing);
  EXPECT_EQ(told.untyped_failure, row.untyped_failure);
  EXPECT_EQ(told.failure_note, row.failure_note);
  EXPECT_EQ(told.failure_axes.columns, row.failure_axes.columns);
  EXPECT_EQ(told.failure_axes.rows, row.failure_axes.rows);
  ASSERT_EQ(told.failure_types.size(), row.failure_types.size());
  for (std::size_t i = 0; i < row.failure_types.size(); ++i) {
    EXPECT_EQ(told.failure_types[i].type, row.failure_types[i].type);
    EXPECT_EQ(told.failure_types[i].name, row.failure_types[i].name);
    EXPECT_EQ(told.failure_types[i].column, row.failure_types[i].column);
    EXPECT_EQ(told.failure_types[i].row, row.failure_types[i].row);
  }
  ASSERT_EQ(told.failure_kinds.size(), row.failure_kinds.size());
  for (std::size_t i = 0; i < row.failure_kinds.size(); ++i) {
    EXPECT_EQ(told.failure_kinds[i].metric, row.failure_kinds[i].metric);
    EXPECT_EQ(told.failure_kinds[i].at_most, row.failure_kinds[i].at_most);
    EXPECT_EQ(told.failure_kinds[i].what, row.failure_kinds[i].what);
  }
  ASSERT_EQ(told.failure_place.has_value(), row.failure_place.has_value());
  if (!row.failure_place) return;
  EXPECT_EQ(told.failure_place->x, row.failure_place->x);
  EXPECT_EQ(told.failure_place->y, row.failure_place->y);
  EXPECT_EQ(told.failure_place->same_within, row.failure_place->same_within);
}

TEST(PluginRowsTest, ScenariosComeBackAsTheyWereToldWithoutTheirFunctions) {
  for (const ScenarioInfo& row : controllers::Scenarios()) {
    SCOPED_TRACE(row.name);
    const auto text = proto::WriteDescription({.controllers = {}, .scenarios = {worker::DescriptionOf(row)}});
    const auto read = proto::ReadDescription(text, "description");
    ASSERT_TRUE(read.ok()) << read.error().message;
    const ScenarioInfo told = RowOf(read->scenarios.at(0));
    EXPECT_EQ(told.name, row.name);
    EXPECT_EQ(told.description, row.description);
    EXPECT_EQ(told.default_controller, row.default_controller);
    EXPECT_EQ(told.any_controller, row.any_controller);
    EXPECT_EQ(told.TimeLimit({}), row.TimeLimit({}));
    ExpectSameParameters(told.parameters, row.parameters);
    ExpectSameStyle(told.style, row.style);
    ExpectSameMetrics(told, row);
    ExpectSameFailures(told, row);
    EXPECT_EQ(told.requirements, nullptr);
    EXPECT_EQ(told.create, nullptr);
  }
}

TEST(PluginRowsTest, ControllersComeBackAndDoNothing) {
  for (const controllers::ControllerInfo& row : controllers::Controllers()) {
    SCOPED_TRACE(row.name);
    const controllers::ControllerInfo told = RowOf(worker::DescriptionOf(row));
    EXPECT_EQ(told.name, row.name);
    EXPECT_EQ(told.scenario, row.scenario);
    EXPECT_EQ(told.description, row.description);
    ExpectSameParameters(told.parameters, row.parameters);
    EXPECT_EQ(told.make({}).create({})->Devices(), sim::DeviceSet());
  }
}

}  // namespace
}  // namespace gauntlet
