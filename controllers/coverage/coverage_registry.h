// The rows of coverage in the registry.
#pragma once

#include <span>

#include "controllers/behaviour.h"

namespace gauntlet::controllers::coverage {

const ScenarioInfo& CoverageScenarioInfo();
// coverage-field and coverage-field-walk.
std::span<const ControllerInfo> CoverageControllers();

}  // namespace gauntlet::controllers::coverage
