// The foraging rows of the registry: parameters with units, defaults, ranges and sources.
#pragma once

#include <array>

#include "controllers/foraging/foraging_scenario.h"
#include "controllers/registry.h"

namespace gauntlet::controllers {

const ScenarioInfo& ForagingScenarioInfo();
// VP of thesis 5.2.1, the improved one of 5.5.2.2, VP with a random side (5.5.2), the basic algorithm
// (2.4.2.1).
const std::array<ControllerInfo, 4>& ForagingControllerInfos();

// Settings from resolved parameters.
ForagingSettings ForagingSettingsFrom(const sim::Parameters& parameters);
// `controller` is one of ForagingControllerInfos().
ForagerSettings ForagerSettingsFrom(std::string_view controller, const sim::Parameters& parameters,
                                    const ForagingSettings& scenario);

}  // namespace gauntlet::controllers
