// The parameters of what a plug-in brings, as a worker tells them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace gauntlet::proto {

// As controllers::ParameterInfo.
struct DescribedParameter {
  std::string name;
  std::string unit;
  double default_value = 0.0;
  double min = 0.0;
  double max = 0.0;
  bool integer = false;
  std::string description;
  bool operator==(const DescribedParameter&) const = default;
};

// Of what is no name (IsName): "controller 'a b': a name has ..."
Error WrongName(std::string_view what, const std::string& name);

// What is wrong with them: a name that is none or is given twice, a range that is none or that the default is
// not in; kInvalidInput.
Status CheckParameters(const std::vector<DescribedParameter>& parameters);

nlohmann::ordered_json ParametersJson(const std::vector<DescribedParameter>& parameters);
// Throws nlohmann::json::exception when it is no list of parameters.
std::vector<DescribedParameter> ReadParameters(const nlohmann::json& json);

}  // namespace gauntlet::proto
