// The rows of the light flocking example in the registry.
#pragma once

#include "controllers/examples/light_flocking_scenario.h"
#include "controllers/registry.h"

namespace gauntlet::controllers {

const ScenarioInfo& LightFlockingScenarioInfo();
const ControllerInfo& LightFlockingControllerInfo();

// Settings from resolved parameters.
LightFlockingScenarioSettings LightFlockingScenarioSettingsFrom(const sim::Parameters& parameters);
LightFlockingSettings LightFlockingSettingsFrom(const sim::Parameters& parameters);

}  // namespace gauntlet::controllers
