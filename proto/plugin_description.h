// What a plug-in brings, as a worker tells a master, which never loads one itself.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace gauntlet::proto {

// The largest library that is taken.
inline constexpr std::size_t kMaxPluginBytes = std::size_t{256} << 20;

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

// As controllers::ControllerInfo.
struct DescribedController {
  std::string name;
  std::string scenario;
  std::string description;
  std::vector<DescribedParameter> parameters;
  bool operator==(const DescribedController&) const = default;
};

struct PluginDescription {
  std::vector<DescribedController> controllers;
  bool operator==(const PluginDescription&) const = default;
};

// What is wrong with it: no controllers, a name that is none or is given twice, a range that is none or that
// the default is not in; kInvalidInput.
Status CheckDescription(const PluginDescription& description);

std::string WriteDescription(const PluginDescription& description);
// `place` is named in errors (kInvalidInput), which are also those of CheckDescription.
Result<PluginDescription> ReadDescription(std::string_view text, const std::string& place);

}  // namespace gauntlet::proto
