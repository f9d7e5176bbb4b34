#include "controllers/command/command_rows.h"

namespace gauntlet::controllers::command {

namespace {

const std::vector<sim::AnnotationStyle> kAnnotations = {
    {"area", kStanding, sim::Mark::kArea, "what stands there in every case"},
    {"disc", kStanding, sim::Mark::kGoal, "what stands there in every case"},
    {"disc", "", sim::Mark::kGoal, ""},
};

}  // namespace

PluginRows RowsOf(const Definition& definition) {
  ScenarioInfo scenario;
  scenario.name = kScenario;
  scenario.description = "a program of yours simulates the run (docs/any-simulator.md)";
  scenario.default_controller = kController;
  scenario.style = {.lost = "", .lost_is_failure = false, .annotations = kAnnotations};
  scenario.time_limit = kWallLimit;
  scenario.parameters = {{.name = kWallLimit,
                          .unit = "s",
                          .default_value = definition.wall_limit,
                          .min = 0.1,
                          .max = 604800,
                          .description = "of a run; then it counts as hung"}};
  for (const Metric& metric : definition.metrics) {
    const std::string what = !metric.from.empty()      ? "from " + metric.from
                             : !metric.formula.empty() ? metric.formula
                                                       : "as the program reports it";
    scenario.metrics.push_back({.name = metric.name,
                                .unit = metric.unit,
                                .none = std::nullopt,
                                .description = what,
                                .descriptor = true});
  }
  scenario.failures = {.axes = definition.axes, .place = definition.place};
  ControllerInfo controller{.name = kController,
                            .scenario = kScenario,
                            .description = "the program, with the parameters that its table declares",
                            .parameters = definition.parameters,
                            .make = nullptr};
  return {.controllers = {std::move(controller)}, .scenarios = {std::move(scenario)}};
}

}  // namespace gauntlet::controllers::command
