// The rows of the light flocking example in the registry.
#pragma once

#include <span>

#include "controllers/behaviour.h"
#include "controllers/examples/light_flocking_controller.h"
#include "controllers/examples/light_flocking_scenario.h"

namespace gauntlet::controllers::light_flocking {

const ScenarioInfo& LightFlockingScenarioInfo();
std::span<const ControllerInfo> LightFlockingControllers();

const ParameterTable<LightFlockingScenarioSettings>& LightFlockingScenarioParameters();
const ParameterTable<LightFlockingSettings>& LightFlockingParameters();

// The robots of the example, as its row makes them.
ControllerFactory MakeLightFlockers(const LightFlockingSettings& settings);

}  // namespace gauntlet::controllers::light_flocking
