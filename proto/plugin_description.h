// What a plug-in brings, as a worker tells a master, which never loads one itself.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "proto/parameter_description.h"
#include "proto/scenario_description.h"

namespace gauntlet::proto {

// The largest library that is taken.
inline constexpr std::size_t kMaxPluginBytes = std::size_t{256} << 20;

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
  std::vector<DescribedScenario> scenarios = {};
  bool operator==(const PluginDescription&) const = default;
};

// What is wrong with it: neither controllers nor scenarios, a name that is none or is given twice, a range
// that is none or that the default is not in, or what CheckScenario says; kInvalidInput.
Status CheckDescription(const PluginDescription& description);

std::string WriteDescription(const PluginDescription& description);
// `place` is named in errors (kInvalidInput), which are also those of CheckDescription.
Result<PluginDescription> ReadDescription(std::string_view text, const std::string& place);

}  // namespace gauntlet::proto
