// The flocking rows of the registry: parameters with units, defaults, ranges and sources.
#pragma once

#include <array>

#include "controllers/flocking/flocking_scenario.h"
#include "controllers/registry.h"

namespace gauntlet::controllers {

const ScenarioInfo& FlockingScenarioInfo();
// The original bird of thesis 4.3 and the improved one of 4.7.2.
const std::array<ControllerInfo, 2>& FlockingControllerInfos();

// Settings from resolved parameters.
FlockingSettings FlockingSettingsFrom(const sim::Parameters& parameters);
BirdSettings BirdSettingsFrom(const sim::Parameters& parameters);

}  // namespace gauntlet::controllers
