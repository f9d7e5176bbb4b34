// What `confirm`, `minimise` and `blame` have found out about a campaign's cases, as HTML.
#pragma once

#include <string>

#include "report/pages/campaign_pages.h"

namespace gauntlet {

// How many different failures the confirmed cases are, the toughest first, with a link to each; how to find
// that out where nobody has asked yet; "" of a campaign without failures.
std::string DistinctFailuresHtml(const CampaignPages& pages, std::size_t number);
// Cases that were made smaller, each beside what is left of it; "" when there are none.
std::string MinimisedCasesHtml(const CampaignPages& pages, std::size_t number);
// The smallest layouts that break the swarm, each with a run in it; "" when there are none.
std::string SmallestLayoutsHtml(const CampaignPages& pages, std::size_t number);
// What questions about the case were answered with, a section each; "" when nobody asked.
std::string AnswersHtml(const CampaignFacts& facts, const CaseFacts& of_case);

}  // namespace gauntlet
