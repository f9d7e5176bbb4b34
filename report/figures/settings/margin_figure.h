// How failures become more frequent along a range.
#pragma once

#include <vector>

#include "report/figures/campaign_figures.h"

namespace gauntlet {

// "margin-1", "margin-2", ... of a campaign of margins: a curve for each key. Their data are the values with
// what was counted at each.
std::vector<NamedFigure> MarginFigures(const CampaignFacts& facts);

}  // namespace gauntlet
