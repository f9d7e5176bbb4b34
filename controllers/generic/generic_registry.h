// The row of the generic scenario in the registry.
#pragma once

#include "controllers/behaviour.h"
#include "controllers/generic/generic_scenario.h"

namespace gauntlet::controllers::generic {

const ScenarioInfo& GenericScenarioInfo();
const ParameterTable<GenericSettings>& GenericParameters();

}  // namespace gauntlet::controllers::generic
