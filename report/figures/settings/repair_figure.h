// How often a controller fails along the range of each parameter that a repair has varied.
#pragma once

#include <vector>

#include "report/figures/campaign_figures.h"

namespace gauntlet {

// "repair-1", "repair-2", ... of a campaign of a repair: a curve for each parameter, all others original.
// Their data are the values with what was counted at each.
std::vector<NamedFigure> RepairFigures(const CampaignFacts& facts);

}  // namespace gauntlet
