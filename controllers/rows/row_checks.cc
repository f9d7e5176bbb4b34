#include "controllers/rows/row_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "controllers/registry.h"
#include "controllers/rows/row_json.h"

namespace gauntlet::controllers {
namespace {

constexpr std::string_view kYesNo = "yes/no";
// As many as an axis of a map can show.
constexpr int kMostParts = 1000;

Error WrongName(std::string_view what, const std::string& name) {
  return InvalidInput(
      fmt::format("{} '{}': a name has 1 to {} letters, digits and . _ -, and begins with neither . nor -",
                  what, Printable(name), kMostNameBytes));
}

Status CheckParameter(const ParameterInfo& parameter) {
  if (!IsName(parameter.name)) return WrongName("parameter", parameter.name);
  const bool finite = std::isfinite(parameter.min) && std::isfinite(parameter.max);
  if (!finite || parameter.min > parameter.max) {
    return InvalidInput(fmt::format("parameter '{}': its range is {} to {}", parameter.name,
                                    NumberText(parameter.min), NumberText(parameter.max)));
  }
  if (!(parameter.default_value >= parameter.min && parameter.default_value <= parameter.max)) {
    return InvalidInput(fmt::format("parameter '{}': its default {} is not within {} to {}", parameter.name,
                                    NumberText(parameter.default_value), NumberText(parameter.min),
                                    NumberText(parameter.max)));
  }
  return Ok{};
}

Status CheckParameters(const std::vector<ParameterInfo>& parameters) {
  std::set<std::string> names;
  for (const ParameterInfo& parameter : parameters) {
    TRY(CheckParameter(parameter));
    if (!names.insert(parameter.name).second)
      return InvalidInput(fmt::format("parameter '{}' is given twice", parameter.name));
  }
  return Ok{};
}

// A family of metrics, "food_window_*", is named without its last character.
std::string_view StemOf(std::string_view name) {
  return name.ends_with('*') ? name.substr(0, name.size() - 1) : name;
}

Status RequireMetric(const ScenarioInfo& scenario, std::string_view who, const std::string& name) {
  if (FindMetric(scenario, name) != nullptr) return Ok{};
  return InvalidInput(
      fmt::format("{} is of the metric '{}', which is none of its metrics", who, Printable(name)));
}

Status CheckMetrics(const ScenarioInfo& scenario) {
  std::set<std::string> names;
  for (const MetricInfo& metric : scenario.metrics) {
    if (!IsName(StemOf(metric.name))) return WrongName("metric", metric.name);
    if (!names.insert(metric.name).second)
      return InvalidInput(fmt::format("metric '{}' is given twice", metric.name));
    if (metric.none && !std::isfinite(*metric.none))
      return InvalidInput(fmt::format("metric '{}': what stands for none must be a number, not {}",
                                      metric.name, NumberText(*metric.none)));
  }
  if (scenario.failing == kTotalFailure) return Ok{};
  const MetricInfo* failing = FindMetric(scenario, scenario.failing);
  if (failing != nullptr && failing->unit == kYesNo) return Ok{};
  return InvalidInput(fmt::format("failing = '{}' is neither {} nor a metric with the unit {}",
                                  Printable(scenario.failing), kTotalFailure, kYesNo));
}

Status CheckFailures(const ScenarioInfo& scenario) {
  std::set<int> types;
  for (const FailureType& one : scenario.failure_types.types) {
    if (one.type < 0 || one.name.empty())
      return InvalidInput(fmt::format("failure type {}: it needs a number from 0 on and a name", one.type));
    if (!types.insert(one.type).second)
      return InvalidInput(fmt::format("failure type {} is given twice", one.type));
  }
  for (const FailureKind& kind : scenario.failures.kinds) {
    TRY(RequireMetric(scenario, "a failure kind", kind.metric));
    if (!std::isfinite(kind.at_most))
      return InvalidInput(
          fmt::format("the failure kind of '{}' is one up to {}", kind.metric, NumberText(kind.at_most)));
  }
  if (!scenario.failures.place) return Ok{};
  for (const std::string& name : {scenario.failures.place->x, scenario.failures.place->y}) {
    TRY(RequireMetric(scenario, "the failure's place", name));
  }
  const double same_within = scenario.failures.place->same_within;
  if (same_within > 0.0 && std::isfinite(same_within)) return Ok{};
  return InvalidInput(fmt::format("the failure's place is the same within {} m; more than 0 is needed",
                                  NumberText(same_within)));
}

Status CheckAxes(const ScenarioInfo& scenario) {
  for (const DescriptorAxis& axis : scenario.failures.axes) {
    TRY(RequireMetric(scenario, "a descriptor axis", axis.metric));
    const bool right = std::isfinite(axis.min) && std::isfinite(axis.max) && axis.min < axis.max;
    if (!right || axis.parts < 1 || axis.parts > kMostParts) {
      return InvalidInput(
          fmt::format("the descriptor axis of '{}' goes from {} to {} in {} parts; 1 to {} "
                      "parts of a range are possible",
                      axis.metric, NumberText(axis.min), NumberText(axis.max), axis.parts, kMostParts));
    }
  }
  return Ok{};
}

Status CheckController(const ControllerInfo& controller) {
  if (!IsName(controller.name)) return WrongName("controller", controller.name);
  const auto in_controller = [&](const std::string& what) {
    return InvalidInput(fmt::format("controller '{}': {}", controller.name, what));
  };
  if (!IsName(controller.scenario)) return in_controller("its scenario has no name");
  if (const Status right = CheckParameters(controller.parameters); !right)
    return in_controller(right.error().message);
  return Ok{};
}

// `what` they are, and what is wrong with one.
template <typename Row>
Status CheckAll(const std::vector<Row>& rows, std::string_view what, Status (*check)(const Row& row)) {
  std::set<std::string> names;
  for (const Row& row : rows) {
    TRY(check(row));
    if (!names.insert(row.name).second)
      return InvalidInput(fmt::format("two of its {} are called '{}'", what, row.name));
  }
  return Ok{};
}

}  // namespace

Status CheckScenario(const ScenarioInfo& scenario) {
  if (!IsName(scenario.name)) return WrongName("scenario", scenario.name);
  const auto in_scenario = [&](const std::string& what) {
    return InvalidInput(fmt::format("scenario '{}': {}", scenario.name, what));
  };
  if (!IsName(scenario.default_controller)) return in_scenario("its default_controller names no controller");
  for (const Status& right : {CheckParameters(scenario.parameters), CheckMetrics(scenario),
                              CheckFailures(scenario), CheckAxes(scenario)}) {
    if (!right) return in_scenario(right.error().message);
  }
  if (std::ranges::count(scenario.parameters, scenario.time_limit, &ParameterInfo::name) > 0) return Ok{};
  return in_scenario(
      fmt::format("its time limit '{}', in s, is none of its parameters", Printable(scenario.time_limit)));
}

Status CheckRows(const PluginRows& rows) {
  if (rows.controllers.empty() && rows.scenarios.empty())
    return InvalidInput("it brings neither a controller nor a scenario");
  TRY(CheckAll(rows.controllers, "controllers", CheckController));
  return CheckAll(rows.scenarios, "scenarios", CheckScenario);
}

Result<PluginRows> ReadRows(const nlohmann::json& json, const std::string& place) {
  PluginRows rows;
  try {
    if (json.at("format") != kRowsFormat)
      return InvalidInput(fmt::format("{}: no description of a plug-in in format {}", place, kRowsFormat));
    for (const nlohmann::json& one : json.at("controllers")) rows.controllers.push_back(ReadController(one));
    for (const nlohmann::json& one : json.at("scenarios")) rows.scenarios.push_back(ReadScenario(one));
  } catch (const nlohmann::json::exception&) {
    return InvalidInput(fmt::format("{}: no description of a plug-in", place));
  }
  if (const Status right = CheckRows(rows); !right)
    return InvalidInput(fmt::format("{}: {}", place, right.error().message));
  return rows;
}

}  // namespace gauntlet::controllers
