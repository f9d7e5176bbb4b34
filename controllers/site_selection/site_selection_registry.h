// The rows of site selection in the registry.
#pragma once

#include <span>

#include "controllers/behaviour.h"
#include "controllers/site_selection/site_selection_controller.h"
#include "controllers/site_selection/site_selection_scenario.h"

namespace gauntlet::controllers::site_selection {

const ScenarioInfo& SiteSelectionScenarioInfo();
std::span<const ControllerInfo> SiteSelectionControllers();

const ParameterTable<SiteSelectionScenarioSettings>& SiteSelectionScenarioParameters();
const ParameterTable<SiteSelectionSettings>& SiteSelectionParameters();
// Those, and when and for how long robots follow an obstacle.
const ParameterTable<SiteSelectionSettings>& ImprovedSiteSelectionParameters();

}  // namespace gauntlet::controllers::site_selection
