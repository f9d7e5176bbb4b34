// The rows of aggregation in the registry.
#pragma once

#include <span>

#include "controllers/behaviour.h"

namespace gauntlet::controllers::aggregation {

const ScenarioInfo& AggregationScenarioInfo();
std::span<const ControllerInfo> AggregationControllers();

}  // namespace gauntlet::controllers::aggregation
