// The cells of an archive as people are told of them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "master/campaign/campaign_summary.h"

namespace gauntlet {

// How many there are, filled or not.
std::size_t CellsOf(const ArchiveView& archive);
// "-3 to -1.8"
std::string RangeText(const CellAxis& axis, int part);
// Of the population that the summary tells of, which holds every archived failure.
const PopulationMember& MemberOf(const CampaignSummary& summary, const ArchivedFailure& failure);
// The smallest layouts first.
std::vector<ArchivedFailure> BySize(const CampaignSummary& summary);

}  // namespace gauntlet
