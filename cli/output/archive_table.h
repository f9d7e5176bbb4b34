// The archive of a search for many different failures, for people and scripts.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "cli/output/summary.h"

namespace gauntlet {

// A map of the cells, when there are two axes, and a line for each failure, the smallest first. "" when the
// search keeps no archive.
std::string ArchiveText(const CampaignSummary& summary, const HintContext& context);

// {descriptors: [{metric, min, max, parts}], cells, filled, elites: [{cell, individual, obstacles, length, k,
// n, interval: [lo, hi], middle, run}]}; null when the search keeps no archive. k of n runs failed; they took
// part in choosing the elite, so fresh ones (`confirm`) fail a little less often.
nlohmann::ordered_json ArchiveJson(const CampaignSummary& summary);

}  // namespace gauntlet
