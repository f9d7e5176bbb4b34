// The task partitioning rows of the registry: parameters with units, defaults, ranges and sources.
#pragma once

#include <array>

#include "controllers/partitioning/partitioning_scenario.h"
#include "controllers/registry.h"

namespace gauntlet::controllers {

const ScenarioInfo& PartitioningScenarioInfo();
// Static with a potential field (thesis 6.2), static with BugS (6.5.2.1), dynamic (2.4.3.1, spec 4.6).
const std::array<ControllerInfo, 3>& PartitioningControllerInfos();

// Settings from resolved parameters.
PartitioningSettings PartitioningSettingsFrom(const sim::Parameters& parameters);
// `controller` is one of PartitioningControllerInfos(). The lamp is the scenario's to fill in.
PartitionerSettings PartitionerSettingsFrom(std::string_view controller, const sim::Parameters& parameters,
                                            const PartitioningSettings& scenario);

}  // namespace gauntlet::controllers
