// The smallest layout of each cell of an archive, drawn where it stands.
#pragma once

#include <vector>

#include "analysis/figures/layout_grid.h"
#include "report/figures/campaign_facts.h"
#include "report/figures/campaign_figures.h"

namespace gauntlet {

// "archive", of a campaign whose only search keeps an archive over two axes and has found something; else
// none.
std::vector<NamedFigure> ArchiveFigures(const CampaignFacts& facts);

}  // namespace gauntlet
