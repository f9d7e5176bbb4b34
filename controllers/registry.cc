#include "controllers/registry.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/nearest_name.h"
#include "base/number_text.h"
#include "controllers/examples/light_flocking_registry.h"
#include "controllers/flocking/flocking_registry.h"
#include "controllers/foraging/foraging_registry.h"
#include "controllers/partitioning/partitioning_registry.h"

namespace gauntlet::controllers {
namespace {

Status CheckRange(const ParameterInfo& info, double value) {
  std::string given = "parameter '";
  given.append(info.name).append("' = ").append(NumberText(value));
  if (!(value >= info.min && value <= info.max)) {  // also refuses what is not a number
    std::string unit;
    if (!info.unit.empty() && info.unit != "bool") unit.append(" ").append(info.unit);
    given.append(unit).append(" is out of range: from ").append(NumberText(info.min));
    return InvalidInput(given.append(" to ").append(NumberText(info.max)).append(unit));
  }
  if (info.integer && value != std::floor(value)) return InvalidInput(given.append(" is not a whole number"));
  return Ok{};
}

}  // namespace

double ScenarioInfo::TimeLimit(const sim::Parameters& given) const {
  const auto found = given.find(std::string(time_limit));
  if (found != given.end()) return found->second;
  const ParameterInfo* info = FindByName(parameters, time_limit);
  GAUNTLET_CHECK(info != nullptr, std::string(name) + " has no parameter " + std::string(time_limit));
  return info->default_value;
}

std::span<const ScenarioInfo> Scenarios() {
  static const std::array scenarios = {FlockingScenarioInfo(), ForagingScenarioInfo(),
                                       PartitioningScenarioInfo(),
                                       light_flocking::LightFlockingScenarioInfo()};
  return scenarios;
}

std::span<const ControllerInfo> Controllers() {
  static const std::vector<ControllerInfo> controllers = [] {
    std::vector<ControllerInfo> all;
    for (const auto& behaviour : {FlockingControllers(), ForagingControllers(), PartitioningControllers(),
                                  light_flocking::LightFlockingControllers()}) {
      all.insert(all.end(), behaviour.begin(), behaviour.end());
    }
    return all;
  }();
  return controllers;
}

const ScenarioInfo* FindScenario(std::string_view name) {
  return FindByName(Scenarios(), name);
}

const ControllerInfo* FindController(std::string_view name) {
  return FindByName(Controllers(), name);
}

const MetricInfo* FindMetric(const ScenarioInfo& scenario, std::string_view name) {
  for (const MetricInfo& metric : scenario.metrics) {
    const bool family = metric.name.ends_with('*');
    if (family ? name.starts_with(metric.name.substr(0, metric.name.size() - 1)) : name == metric.name) {
      return &metric;
    }
  }
  return nullptr;
}

Result<sim::Parameters> ResolveParameters(std::span<const ParameterInfo> infos,
                                          const sim::Parameters& given) {
  sim::Parameters resolved;
  for (const ParameterInfo& info : infos) resolved.emplace(info.name, info.default_value);
  for (const auto& [name, value] : given) {
    const ParameterInfo* info = FindByName(infos, name);
    if (info == nullptr) return InvalidInput(UnknownName("parameter", name, infos));
    const Status in_range = CheckRange(*info, value);
    if (!in_range.ok()) return in_range.error();
    resolved[name] = value;
  }
  return resolved;
}

Result<std::unique_ptr<sim::Scenario>> CreateScenario(const sim::RunSpec& spec) {
  const ScenarioInfo* scenario = FindScenario(spec.scenario);
  if (scenario == nullptr) return InvalidInput(UnknownName("scenario", spec.scenario, Scenarios()));
  const ControllerInfo* controller = FindController(spec.controller);
  if (controller == nullptr) return InvalidInput(UnknownName("controller", spec.controller, Controllers()));
  if (!controller->WrittenFor(scenario->name)) {
    std::string message = "controller '";
    message.append(spec.controller).append("' is written for the scenario '").append(controller->scenario);
    return InvalidInput(message.append("', not for '").append(spec.scenario).append("'"));
  }

  sim::RunSpec resolved = spec;
  auto scenario_parameters = ResolveParameters(scenario->parameters, spec.scenario_parameters);
  if (!scenario_parameters.ok()) return scenario_parameters.error();
  resolved.scenario_parameters = std::move(*scenario_parameters);
  auto controller_parameters = ResolveParameters(controller->parameters, spec.controller_parameters);
  if (!controller_parameters.ok()) return controller_parameters.error();
  resolved.controller_parameters = std::move(*controller_parameters);

  const auto requirements = scenario->requirements(resolved.scenario_parameters, spec.test_case);
  if (const auto violation = sim::CheckValidity(spec.test_case, requirements)) {
    return InvalidInput(std::string(NameOf(violation->rule)).append(": ").append(violation->message));
  }
  ControllerFactory factory = controller->make(resolved.controller_parameters);
  factory.create = [create = std::move(factory.create), seed = spec.seed](ControllerContext context) {
    context.seed = seed;
    return create(context);
  };
  return scenario->create(resolved, std::move(factory));
}

Result<std::size_t> CountSwarm(const sim::RunSpec& spec) {
  constexpr std::uint64_t kSeeds = 5;
  Error error;
  for (std::uint64_t i = 0; i < kSeeds; ++i) {
    sim::RunSpec trial = spec;
    trial.seed += i;
    const auto scenario = CreateScenario(trial);
    if (!scenario.ok()) return scenario.error();
    const sim::Observer observer(0, 0);
    const auto swarm = (*scenario)->CreateSwarm(sim::Headquarters(observer));
    if (swarm.ok()) return swarm->size();
    error = swarm.error();
  }
  return error;
}

}  // namespace gauntlet::controllers
