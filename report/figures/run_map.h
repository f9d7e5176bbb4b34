// Maps of a campaign's runs: how often each kind of failure or behaviour came up, and where to see it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/figures/heat_map.h"
#include "report/figures/campaign_facts.h"

namespace gauntlet {

struct RunMap : analysis::HeatMap {
  std::string name = "";     // as `gauntlet figure` calls it
  std::string reading = "";  // how it is read, in a sentence or two
  // [row][column]: the run of lowest fitness; of equal ones that of the toughest case, then the earliest; 0 =
  // none.
  std::vector<std::vector<RunId>> toughest = {};
};

// Of the total failures by the types that the scenario declares (for flocking the 2 x 10 table of thesis
// Tables 4.5 and 4.6), and of all runs by the first two descriptors of behaviour. A map of nothing is left
// out, and so are all when the campaign's searches are of several scenarios.
std::vector<RunMap> MapsOf(const CampaignFacts& facts);

}  // namespace gauntlet
