#include "worker/plugin/plugin_rows.h"

#include <span>
#include <string>
#include <vector>

namespace gauntlet::worker {
namespace {

std::vector<proto::DescribedParameter> DescriptionOf(std::span<const controllers::ParameterInfo> infos) {
  std::vector<proto::DescribedParameter> parameters;
  for (const controllers::ParameterInfo& info : infos) {
    parameters.push_back({.name = std::string(info.name),
                          .unit = std::string(info.unit),
                          .default_value = info.default_value,
                          .min = info.min,
                          .max = info.max,
                          .integer = info.integer,
                          .description = std::string(info.description)});
  }
  return parameters;
}

proto::DescribedStyle DescriptionOf(const sim::RunStyle& style) {
  proto::DescribedStyle described{.member = std::string(style.member),
                                  .lost = std::string(style.lost),
                                  .lost_is_failure = style.lost_is_failure,
                                  .guide = std::string(style.guide),
                                  .annotations = {}};
  for (const sim::AnnotationStyle& one : style.annotations) {
    described.annotations.push_back(
        {std::string(one.kind), std::string(one.label), one.mark, std::string(one.legend)});
  }
  return described;
}

void DescribeFailures(const controllers::ScenarioInfo& row, proto::DescribedScenario& scenario) {
  scenario.failing = row.failing;
  for (const controllers::FailureType& one : row.failure_types)
    scenario.failure_types.push_back({one.type, one.name, one.column, one.row});
  scenario.failure_columns = row.failure_axes.columns;
  scenario.failure_rows = row.failure_axes.rows;
  scenario.untyped_failure = row.untyped_failure;
  scenario.failure_note = row.failure_note;
  if (const auto& place = row.failure_place)
    scenario.failure_place = {std::string(place->x), std::string(place->y), place->same_within};
  for (const controllers::FailureKind& one : row.failure_kinds)
    scenario.failure_kinds.push_back({std::string(one.metric), one.at_most, std::string(one.what)});
  for (const controllers::DescriptorAxis& one : row.descriptor_axes)
    scenario.descriptor_axes.push_back({std::string(one.metric), one.min, one.max, one.parts});
}

}  // namespace

proto::DescribedController DescriptionOf(const controllers::ControllerInfo& row) {
  return {.name = std::string(row.name),
          .scenario = std::string(row.scenario),
          .description = std::string(row.description),
          .parameters = DescriptionOf(row.parameters)};
}

proto::DescribedScenario DescriptionOf(const controllers::ScenarioInfo& row) {
  proto::DescribedScenario scenario;
  scenario.name = row.name;
  scenario.description = row.description;
  scenario.default_controller = row.default_controller;
  scenario.any_controller = row.any_controller;
  scenario.style = DescriptionOf(row.style);
  scenario.parameters = DescriptionOf(row.parameters);
  scenario.time_limit = row.time_limit;
  for (const controllers::MetricInfo& one : row.metrics) {
    scenario.metrics.push_back({.name = std::string(one.name),
                                .unit = std::string(one.unit),
                                .none = one.none,
                                .description = std::string(one.description),
                                .descriptor = one.descriptor});
  }
  DescribeFailures(row, scenario);
  return scenario;
}

}  // namespace gauntlet::worker
