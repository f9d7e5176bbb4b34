// The flocking rows of the registry: the scenario, its birds, and their parameters with units, defaults,
// ranges and sources.
#pragma once

#include <span>

#include "controllers/behaviour.h"
#include "controllers/flocking/bird_controller.h"
#include "controllers/flocking/flocking_scenario.h"

namespace gauntlet::controllers {

const ScenarioInfo& FlockingScenarioInfo();
// The original bird of thesis 4.3 and the improved one of 4.7.2.
std::span<const ControllerInfo> FlockingControllers();

const ParameterTable<FlockingSettings>& FlockingParameters();
const ParameterTable<BirdSettings>& BirdParameters();
const ParameterTable<BirdSettings>& ImprovedBirdParameters();

}  // namespace gauntlet::controllers
