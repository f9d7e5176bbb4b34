// The task partitioning rows of the registry: the scenario, its robots, and their parameters with units,
// defaults, ranges and sources.
#pragma once

#include <span>

#include "controllers/behaviour.h"
#include "controllers/partitioning/partitioning_controller.h"
#include "controllers/partitioning/partitioning_scenario.h"

namespace gauntlet::controllers {

const ScenarioInfo& PartitioningScenarioInfo();
// Static with a potential field (thesis 6.2), static with BugS (6.5.2.1), dynamic (2.4.3.1).
std::span<const ControllerInfo> PartitioningControllers();

const ParameterTable<PartitioningSettings>& PartitioningParameters();
const ParameterTable<PartitionerSettings>& StaticPartitionerParameters();
const ParameterTable<PartitionerSettings>& BugPartitionerParameters();
const ParameterTable<PartitionerSettings>& DynamicPartitionerParameters();

}  // namespace gauntlet::controllers
