// What the settings look like that a fit has accepted.
#pragma once

#include <vector>

#include "report/figures/campaign_figures.h"

namespace gauntlet {

// "settings", of a campaign that is a fit and has come so far; else nothing. Its data are the accepted
// settings with their weights.
std::vector<NamedFigure> FitFigures(const CampaignFacts& facts);

}  // namespace gauntlet
