#include "proto/plugin_description.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/nearest_name.h"
#include "proto/json_text.h"

namespace gauntlet::proto {
namespace {

constexpr int kDescriptionFormat = 1;

Status CheckController(const DescribedController& controller) {
  if (!IsName(controller.name)) return WrongName("controller", controller.name);
  const auto in_controller = [&](const std::string& what) {
    return InvalidInput(fmt::format("controller '{}': {}", controller.name, what));
  };
  if (!IsName(controller.scenario)) return in_controller("its scenario has no name");
  if (const Status right = CheckParameters(controller.parameters); !right)
    return in_controller(right.error().message);
  return Ok{};
}

}  // namespace

Status CheckDescription(const PluginDescription& description) {
  if (description.controllers.empty() && description.scenarios.empty())
    return InvalidInput("it brings neither a controller nor a scenario");
  std::set<std::string> names;
  for (const DescribedController& controller : description.controllers) {
    TRY(CheckController(controller));
    if (!names.insert(controller.name).second)
      return InvalidInput(fmt::format("two of its controllers are called '{}'", controller.name));
  }
  names.clear();
  for (const DescribedScenario& scenario : description.scenarios) {
    TRY(CheckScenario(scenario));
    if (!names.insert(scenario.name).second)
      return InvalidInput(fmt::format("two of its scenarios are called '{}'", scenario.name));
  }
  return Ok{};
}

std::string WriteDescription(const PluginDescription& description) {
  nlohmann::ordered_json controllers = nlohmann::ordered_json::array();
  for (const DescribedController& controller : description.controllers) {
    controllers.push_back({{"name", controller.name},
                           {"scenario", controller.scenario},
                           {"description", controller.description},
                           {"parameters", ParametersJson(controller.parameters)}});
  }
  nlohmann::ordered_json json = {{"format", kDescriptionFormat}, {"controllers", std::move(controllers)}};
  // Left out where there are none, so that campaigns with controllers alone keep the bytes of their files.
  for (const DescribedScenario& scenario : description.scenarios)
    json["scenarios"].push_back(ScenarioJson(scenario));
  return JsonText(json);
}

Result<PluginDescription> ReadDescription(std::string_view text, const std::string& place) {
  TRY(const auto json, ParseJson(text, place));
  PluginDescription description;
  try {
    if (json.at("format") != kDescriptionFormat)
      return InvalidInput(
          fmt::format("{}: no description of a plug-in in format {}", place, kDescriptionFormat));
    for (const nlohmann::json& controller : json.at("controllers")) {
      description.controllers.push_back({.name = controller.at("name"),
                                         .scenario = controller.at("scenario"),
                                         .description = controller.at("description"),
                                         .parameters = ReadParameters(controller.at("parameters"))});
    }
    if (const auto scenarios = json.find("scenarios"); scenarios != json.end()) {
      for (const nlohmann::json& scenario : *scenarios)
        description.scenarios.push_back(ReadScenario(scenario));
    }
  } catch (const nlohmann::json::exception&) {
    return InvalidInput(fmt::format("{}: no description of a plug-in", place));
  }
  if (const Status right = CheckDescription(description); !right)
    return InvalidInput(fmt::format("{}: {}", place, right.error().message));
  return description;
}

}  // namespace gauntlet::proto
