// A catalogue with one toy scenario, so that experiments can be tested without the real ones.
#pragma once

#include <array>

#include <string>
#include <string_view>
#include <vector>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {

inline const std::vector<controllers::ParameterInfo> kToyScenarioParameters = {
    {"robots", "", 10, 1, 100, true, "how many"},
    {"camera_range", "m", 1.6373, 0.2, 10.0, false, "how far they see"},
    {"headwind", "bool", 0, 0, 1, true, "whether it blows"},
};
inline const std::vector<controllers::ParameterInfo> kToyControllerParameters = {
    {"speed", "m/s", 0.08, 0.01, 0.3, false, "forward speed"},
};
inline const std::vector<controllers::ParameterInfo> kFastControllerParameters = {
    {"gain", "", 2.0, 1.0, 4.0, false, "of speed"},
};

inline Catalogue ToyCatalogue() {
  static const std::array scenarios = std::to_array<controllers::ScenarioInfo>({
      {.name = "marching",
       .description = "walk",
       .default_controller = "walker",
       .parameters = kToyScenarioParameters,
       .time_limit = "",
       .metrics = {},
       .requirements = nullptr,
       .create = nullptr},
      {.name = "waiting",
       .description = "wait",
       .default_controller = "waiter",
       .parameters = {},
       .time_limit = "",
       .metrics = {},
       .requirements = nullptr,
       .create = nullptr},
  });
  static const std::array controllers_of_toys = std::to_array<controllers::ControllerInfo>({
      {"walker", "marching", "walks", kToyControllerParameters, nullptr},
      {"runner", "marching", "runs", kFastControllerParameters, nullptr},
      {"waiter", "waiting", "waits", {}, nullptr},
  });
  return {scenarios, controllers_of_toys, BuiltInCatalogue().searches};
}

inline Result<Experiment> ParseToy(std::string_view text, const std::vector<std::string>& sets = {}) {
  return ParseExperiment(text, "toy.toml", sets, ToyCatalogue());
}

// The message of the error, or "" when there was none.
inline std::string ErrorOf(std::string_view text, const std::vector<std::string>& sets = {}) {
  const Result<Experiment> experiment = ParseToy(text, sets);
  return experiment.ok() ? "" : experiment.error().message;
}

}  // namespace gauntlet
