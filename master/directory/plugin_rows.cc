#include "master/directory/plugin_rows.h"

#include <deque>
#include <memory>
#include <utility>
#include <vector>

namespace gauntlet {
namespace {

using controllers::ControllerContext;
using controllers::ControllerFactory;
using controllers::ParameterInfo;

// Stands where a runner has the plug-in's controller.
class AbsentController : public sim::Controller {
 public:
  sim::DeviceSet Devices() const override { return {}; }
  void Step(const sim::ControlStep&) override {}
};

ControllerFactory MakeAbsent(const sim::Parameters&) {
  return {[](const ControllerContext&) { return std::make_unique<AbsentController>(); }};
}

// They refer to the described ones.
std::vector<ParameterInfo> InfosOf(const std::vector<proto::DescribedParameter>& parameters) {
  std::vector<ParameterInfo> infos;
  for (const proto::DescribedParameter& one : parameters) {
    infos.push_back({.name = one.name,
                     .unit = one.unit,
                     .default_value = one.default_value,
                     .min = one.min,
                     .max = one.max,
                     .integer = one.integer,
                     .description = one.description});
  }
  return infos;
}

struct ControllerTexts {
  proto::DescribedController text;
  std::vector<ParameterInfo> parameters;
};

// What a scenario's row refers to.
struct ScenarioTexts {
  proto::DescribedScenario text;
  std::vector<ParameterInfo> parameters;
  std::vector<sim::AnnotationStyle> annotations;
  std::vector<controllers::MetricInfo> metrics;
  std::vector<controllers::FailureType> failure_types;
  std::vector<controllers::FailureKind> failure_kinds;
  std::vector<controllers::DescriptorAxis> descriptor_axes;
};

void Fill(ScenarioTexts& row) {
  const proto::DescribedScenario& text = row.text;
  row.parameters = InfosOf(text.parameters);
  for (const proto::DescribedAnnotation& one : text.style.annotations)
    row.annotations.push_back({one.kind, one.label, one.mark, one.legend});
  for (const proto::DescribedMetric& one : text.metrics)
    row.metrics.push_back({one.name, one.unit, one.none, one.description, one.descriptor});
  for (const proto::DescribedFailureType& one : text.failure_types)
    row.failure_types.push_back({one.type, one.name, one.column, one.row});
  for (const proto::DescribedFailureKind& one : text.failure_kinds)
    row.failure_kinds.push_back({one.metric, one.at_most, one.what});
  for (const proto::DescribedAxis& one : text.descriptor_axes)
    row.descriptor_axes.push_back({one.metric, one.min, one.max, one.parts});
}

}  // namespace

controllers::ControllerInfo RowOf(proto::DescribedController described) {
  static std::deque<ControllerTexts> rows;
  ControllerTexts& row = rows.emplace_back(ControllerTexts{std::move(described), {}});
  row.parameters = InfosOf(row.text.parameters);
  return {row.text.name, row.text.scenario, row.text.description, row.parameters, MakeAbsent};
}

controllers::ScenarioInfo RowOf(proto::DescribedScenario described) {
  static std::deque<ScenarioTexts> rows;
  ScenarioTexts& row = rows.emplace_back();
  row.text = std::move(described);
  Fill(row);
  const proto::DescribedScenario& text = row.text;
  controllers::ScenarioInfo info{.name = text.name,
                                 .description = text.description,
                                 .default_controller = text.default_controller,
                                 .style = {.member = text.style.member,
                                           .lost = text.style.lost,
                                           .lost_is_failure = text.style.lost_is_failure,
                                           .guide = text.style.guide,
                                           .annotations = row.annotations},
                                 .parameters = row.parameters,
                                 .time_limit = text.time_limit,
                                 .metrics = row.metrics,
                                 .failure_types = row.failure_types,
                                 .failure_axes = {text.failure_columns, text.failure_rows},
                                 .untyped_failure = text.untyped_failure,
                                 .failing = text.failing,
                                 .failure_kinds = row.failure_kinds,
                                 .failure_note = text.failure_note,
                                 .any_controller = text.any_controller,
                                 .descriptor_axes = row.descriptor_axes};
  if (const auto& place = text.failure_place) info.failure_place = {place->x, place->y, place->same_within};
  return info;
}

}  // namespace gauntlet
