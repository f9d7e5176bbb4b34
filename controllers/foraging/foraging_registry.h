// The foraging rows of the registry: the scenario, its robots, and their parameters with units, defaults,
// ranges and sources.
#pragma once

#include <span>

#include "controllers/behaviour.h"
#include "controllers/foraging/foraging_controller.h"
#include "controllers/foraging/foraging_scenario.h"

namespace gauntlet::controllers {

const ScenarioInfo& ForagingScenarioInfo();
// VP of thesis 5.2.1, the improved one of 5.5.2.2, VP with a random side (5.5.2), the basic algorithm
// (2.4.2.1).
std::span<const ControllerInfo> ForagingControllers();

const ParameterTable<ForagingSettings>& ForagingParameters();
const ParameterTable<ForagerSettings>& BasicForagerParameters();
const ParameterTable<ForagerSettings>& ForagerParameters();
const ParameterTable<ForagerSettings>& RandomSideForagerParameters();
const ParameterTable<ForagerSettings>& ImprovedForagerParameters();

}  // namespace gauntlet::controllers
