#include "proto/parameter_description.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"

namespace gauntlet::proto {
namespace {

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

}  // namespace

Error WrongName(std::string_view what, const std::string& name) {
  return InvalidInput(
      fmt::format("{} '{}': a name has 1 to {} letters, digits and . _ -, and begins with neither . nor -",
                  what, Printable(name), kMostNameBytes));
}

Status CheckParameters(const std::vector<DescribedParameter>& parameters) {
  std::set<std::string> names;
  for (const DescribedParameter& parameter : parameters) {
    TRY(CheckParameter(parameter));
    if (!names.insert(parameter.name).second)
      return InvalidInput(fmt::format("parameter '{}' is given twice", parameter.name));
  }
  return Ok{};
}

nlohmann::ordered_json ParametersJson(const std::vector<DescribedParameter>& parameters) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const DescribedParameter& parameter : parameters) {
    list.push_back({{"name", parameter.name},
                    {"unit", parameter.unit},
                    {"default", parameter.default_value},
                    {"min", parameter.min},
                    {"max", parameter.max},
                    {"integer", parameter.integer},
                    {"description", parameter.description}});
  }
  return list;
}

std::vector<DescribedParameter> ReadParameters(const nlohmann::json& json) {
  std::vector<DescribedParameter> parameters;
  for (const nlohmann::json& one : json) {
    parameters.push_back({.name = one.at("name"),
                          .unit = one.at("unit"),
                          .default_value = one.at("default"),
                          .min = one.at("min"),
                          .max = one.at("max"),
                          .integer = one.at("integer"),
                          .description = one.at("description")});
  }
  return parameters;
}

}  // namespace gauntlet::proto
