#include "controllers/registry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include "base/check.h"
#include "base/nearest_name.h"
#include "base/number_text.h"
#include "controllers/aggregation/aggregation_registry.h"
#include "controllers/coverage/coverage_registry.h"
#include "controllers/examples/light_flocking_registry.h"
#include "controllers/flocking/flocking_registry.h"
#include "controllers/foraging/foraging_registry.h"
#include "controllers/generic/generic_registry.h"
#include "controllers/partitioning/partitioning_registry.h"
#include "controllers/requirements/run_judge.h"
#include "controllers/site_selection/site_selection_registry.h"

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

Status CheckDefinition(const ScenarioInfo& scenario, const std::string& definition) {
  if (scenario.check_definition) return scenario.check_definition(definition);
  if (definition.empty()) return Ok{};
  return InvalidInput("the scenario '" + std::string(scenario.name) + "' takes no definition");
}

// Pointers into it stay valid.
std::deque<PluginInfo>& Plugins() {
  static std::deque<PluginInfo> plugins;
  return plugins;
}

// The row called `name` among those built in or, if `hash` names one, those of the plug-in, its member
// `rows`. `what` it is, in words. Error: there is none of that name, or the plug-in is not known here.
template <typename Info>
Result<const Info*> RowOf(std::string_view what, const std::string& name, const std::string& hash,
                          std::span<const Info> built_in, std::vector<Info> PluginInfo::*rows) {
  const PluginInfo* plugin = hash.empty() ? nullptr : FindPlugin(hash);
  if (plugin == nullptr && !hash.empty()) return InvalidInput("the plug-in " + hash + " is not loaded");
  const std::span<const Info> known = plugin == nullptr ? built_in : std::span<const Info>(plugin->*rows);
  if (const Info* row = FindByName(known, name)) return row;
  return InvalidInput((plugin == nullptr ? "" : "the plug-in " + plugin->file + ": ") +
                      UnknownName(what, name, known));
}

// The row of an experiment with these requirements. What cannot be read adds nothing.
const ScenarioInfo* RowWith(const ScenarioInfo& row, const std::string& requirements) {
  static std::mutex mutex;
  static std::map<std::pair<const ScenarioInfo*, std::string>, ScenarioInfo> rows;  // never freed
  const std::lock_guard lock(mutex);
  const auto [entry, is_new] = rows.try_emplace({&row, requirements}, row);
  if (!is_new) return &entry->second;
  if (const auto read = requirements::Requirements::Parse(requirements, row.metrics)) {
    std::ranges::copy(read->Metrics(), std::back_inserter(entry->second.metrics));
    entry->second.failing = kTotalFailure;
  }
  return &entry->second;
}

Error TakenName(const PluginInfo& plugin, std::string_view what, std::string_view name) {
  std::string message = "the plug-in " + plugin.file + " brings a ";
  return InvalidInput(message.append(what).append(" '").append(name).append(
      "', which is the name of a built-in one: give it a name of its own"));
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
  static const std::array scenarios = {FlockingScenarioInfo(),
                                       ForagingScenarioInfo(),
                                       PartitioningScenarioInfo(),
                                       aggregation::AggregationScenarioInfo(),
                                       coverage::CoverageScenarioInfo(),
                                       site_selection::SiteSelectionScenarioInfo(),
                                       light_flocking::LightFlockingScenarioInfo(),
                                       generic::GenericScenarioInfo()};
  return scenarios;
}

std::span<const ControllerInfo> Controllers() {
  static const std::vector<ControllerInfo> controllers = [] {
    std::vector<ControllerInfo> all;
    for (const auto& behaviour :
         {FlockingControllers(), ForagingControllers(), PartitioningControllers(),
          aggregation::AggregationControllers(), coverage::CoverageControllers(),
          site_selection::SiteSelectionControllers(), light_flocking::LightFlockingControllers()}) {
      all.insert(all.end(), behaviour.begin(), behaviour.end());
    }
    return all;
  }();
  return controllers;
}

const ScenarioInfo* FindScenario(std::string_view name, std::string_view plugin) {
  if (plugin.empty()) return FindByName(Scenarios(), name);
  const PluginInfo* known = FindPlugin(plugin);
  return known == nullptr ? nullptr : FindByName(std::span<const ScenarioInfo>(known->scenarios), name);
}

const ControllerInfo* FindController(std::string_view name, std::string_view plugin) {
  if (plugin.empty()) return FindByName(Controllers(), name);
  const PluginInfo* known = FindPlugin(plugin);
  return known == nullptr ? nullptr : FindByName(std::span<const ControllerInfo>(known->controllers), name);
}

const ScenarioInfo& DeclaredScenario(const sim::RunSettings& settings) {
  static const ScenarioInfo nothing{.name = "", .description = "", .default_controller = "", .metrics = {}};
  const ScenarioInfo* scenario = FindScenario(settings);
  return scenario == nullptr ? nothing : *scenario;
}

const ScenarioInfo* FindScenario(const sim::RunSettings& settings) {
  const ScenarioInfo* row = FindScenario(settings.scenario, settings.scenario_plugin);
  return row == nullptr || settings.requirements.empty() ? row : RowWith(*row, settings.requirements);
}

const ControllerInfo* FindController(const sim::RunSettings& settings) {
  return FindController(settings.controller, settings.plugin);
}

Status AddPlugin(PluginInfo plugin) {
  if (FindPlugin(plugin.hash) != nullptr) return Ok{};
  for (const ControllerInfo& controller : plugin.controllers) {
    if (FindController(controller.name) != nullptr) return TakenName(plugin, "controller", controller.name);
  }
  for (const ScenarioInfo& scenario : plugin.scenarios) {
    if (FindScenario(scenario.name) != nullptr) return TakenName(plugin, "scenario", scenario.name);
  }
  Plugins().push_back(std::move(plugin));
  return Ok{};
}

const PluginInfo* FindPlugin(std::string_view hash) {
  const auto found = std::ranges::find(Plugins(), hash, &PluginInfo::hash);
  return found == Plugins().end() ? nullptr : &*found;
}

void NamePlugin(std::string_view hash, const std::string& file) {
  const auto known = std::ranges::find(Plugins(), hash, &PluginInfo::hash);
  known->file = file;
  known->brought_along = false;
}

Result<const ScenarioInfo*> ScenarioOf(const sim::RunSettings& settings) {
  return RowOf<ScenarioInfo>("scenario", settings.scenario, settings.scenario_plugin, Scenarios(),
                             &PluginInfo::scenarios);
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
    TRY(CheckRange(*info, value));
    resolved[name] = value;
  }
  return resolved;
}

Result<sim::Judge> JudgeOf(const sim::RunSpec& spec) {
  if (spec.requirements.empty()) return sim::Judge(nullptr);
  TRY(const ScenarioInfo* scenario, ScenarioOf(spec));
  TRY(const sim::Parameters parameters, ResolveParameters(scenario->parameters, spec.scenario_parameters));
  TRY(const requirements::RunJudge judge,
      requirements::RunJudge::Make(spec, *scenario, scenario->requirements(parameters, spec.test_case)));
  return sim::Judge([judge](const sim::Scenario& run, const sim::Observer& observer,
                            const std::vector<bool>& under_test, sim::Outcome& outcome) {
    std::vector<sim::RobotIndex> robots;
    for (std::size_t i = 0; i < under_test.size(); ++i) {
      if (under_test[i]) robots.push_back(static_cast<sim::RobotIndex>(i));
    }
    if (robots.empty()) return;
    judge.Judge(observer, run.arena(), std::move(robots), outcome);
  });
}

Result<std::unique_ptr<sim::Scenario>> CreateScenario(const sim::RunSpec& spec) {
  TRY(const ScenarioInfo* scenario, ScenarioOf(spec));
  if (!scenario->create) return InvalidInput("the plug-in " + spec.scenario_plugin + " is not loaded");
  TRY(const ControllerInfo* controller, RowOf<ControllerInfo>("controller", spec.controller, spec.plugin,
                                                              Controllers(), &PluginInfo::controllers));
  if (!scenario->Takes(*controller)) {
    std::string message = "controller '";
    message.append(spec.controller).append("' is written for the scenario '").append(controller->scenario);
    return InvalidInput(message.append("', not for '").append(spec.scenario).append("'"));
  }
  TRY(CheckDefinition(*scenario, spec.definition));

  sim::RunSpec resolved = spec;
  TRY(resolved.scenario_parameters, ResolveParameters(scenario->parameters, spec.scenario_parameters));
  TRY(resolved.controller_parameters, ResolveParameters(controller->parameters, spec.controller_parameters));

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

}  // namespace gauntlet::controllers
