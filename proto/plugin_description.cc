#include "proto/plugin_description.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/number_text.h"
#include "base/printable.h"
#include "proto/json_text.h"

namespace gauntlet::proto {
namespace {

constexpr int kFormat = 1;
constexpr std::size_t kMostNameBytes = 64;

bool IsName(std::string_view name) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  return !name.empty() && name.size() <= kMostNameBytes && name.front() != '.' && name.front() != '-' &&
         name.find_first_not_of(kLetters) == std::string_view::npos;
}

Status WrongName(std::string_view what, const std::string& name) {
  return InvalidInput(
      fmt::format("{} '{}': a name has 1 to {} letters, digits and . _ -, and begins with neither . nor -",
                  what, Printable(name), kMostNameBytes));
}

Status CheckParameter(const DescribedParameter& parameter) {
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

Status CheckController(const DescribedController& controller) {
  if (!IsName(controller.name)) return WrongName("controller", controller.name);
  const auto in_controller = [&](const std::string& what) {
    return InvalidInput(fmt::format("controller '{}': {}", controller.name, what));
  };
  if (!IsName(controller.scenario)) return in_controller("its scenario has no name");
  std::set<std::string> names;
  for (const DescribedParameter& parameter : controller.parameters) {
    if (const Status right = CheckParameter(parameter); !right) return in_controller(right.error().message);
    if (!names.insert(parameter.name).second)
      return in_controller(fmt::format("parameter '{}' is given twice", parameter.name));
  }
  return Ok{};
}

DescribedParameter ParameterOf(const nlohmann::json& json) {
  return {.name = json.at("name"),
          .unit = json.at("unit"),
          .default_value = json.at("default"),
          .min = json.at("min"),
          .max = json.at("max"),
          .integer = json.at("integer"),
          .description = json.at("description")};
}

}  // namespace

Status CheckDescription(const PluginDescription& description) {
  if (description.controllers.empty()) return InvalidInput("it brings no controller");
  std::set<std::string> names;
  for (const DescribedController& controller : description.controllers) {
    if (const Status right = CheckController(controller); !right) return right;
    if (!names.insert(controller.name).second)
      return InvalidInput(fmt::format("two of its controllers are called '{}'", controller.name));
  }
  return Ok{};
}

std::string WriteDescription(const PluginDescription& description) {
  nlohmann::ordered_json controllers = nlohmann::ordered_json::array();
  for (const DescribedController& controller : description.controllers) {
    nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
    for (const DescribedParameter& parameter : controller.parameters) {
      parameters.push_back({{"name", parameter.name},
                            {"unit", parameter.unit},
                            {"default", parameter.default_value},
                            {"min", parameter.min},
                            {"max", parameter.max},
                            {"integer", parameter.integer},
                            {"description", parameter.description}});
    }
    controllers.push_back({{"name", controller.name},
                           {"scenario", controller.scenario},
                           {"description", controller.description},
                           {"parameters", std::move(parameters)}});
  }
  return JsonText({{"format", kFormat}, {"controllers", std::move(controllers)}});
}

Result<PluginDescription> ReadDescription(std::string_view text, const std::string& place) {
  const Result<nlohmann::json> json = ParseJson(text, place);
  if (!json) return json.error();
  PluginDescription description;
  try {
    if (json->at("format") != kFormat)
      return InvalidInput(fmt::format("{}: no description of a plug-in in format {}", place, kFormat));
    for (const nlohmann::json& controller : json->at("controllers")) {
      description.controllers.push_back({.name = controller.at("name"),
                                         .scenario = controller.at("scenario"),
                                         .description = controller.at("description"),
                                         .parameters = {}});
      for (const nlohmann::json& parameter : controller.at("parameters"))
        description.controllers.back().parameters.push_back(ParameterOf(parameter));
    }
  } catch (const nlohmann::json::exception&) {
    return InvalidInput(fmt::format("{}: no description of a plug-in", place));
  }
  if (const Status right = CheckDescription(description); !right)
    return InvalidInput(fmt::format("{}: {}", place, right.error().message));
  return description;
}

}  // namespace gauntlet::proto
