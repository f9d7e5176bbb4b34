// How often the swarm fails along the key that a sweep varies.
#pragma once

#include <vector>

#include "report/figures/campaign_facts.h"
#include "report/figures/campaign_figures.h"

namespace gauntlet {

// "failures-by-condition", of a campaign under several settings whose last swept key has numbers; else none.
std::vector<NamedFigure> ConditionFigures(const CampaignFacts& facts);

}  // namespace gauntlet
