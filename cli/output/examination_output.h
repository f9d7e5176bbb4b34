// What an examination has found, in ten lines and as JSON.
#pragma once

#include <string>
#include <vector>

#include "analysis/tables/table.h"
#include "report/figures/campaign_facts.h"
#include "study/examination_plan.h"

namespace gauntlet {

// Read back from its campaigns.
struct ExaminationFacts {
  CampaignFacts random;  // random cases, and the empty arena
  CampaignFacts search;  // the archive search, and what was asked about its cases
  std::vector<Margin> margins = {};
  std::uint64_t runs = 0;  // in all of its campaigns
};
// Of the campaigns below `directory`; where no search was made, its facts are those of the random cases.
// Errors: those of reading.
Result<ExaminationFacts> ReadExamination(const std::string& directory);
// What confirming has found of the cases that the search in `campaign` has ended with, whatever else was
// confirmed.
Result<std::vector<Confirmation>> ExaminedCases(const std::string& campaign);

std::string ExaminationText(const ExaminationFacts& facts, const ExaminationPlan& plan,
                            const std::string& program, const std::string& page);
// {baseline: {empty: {k, n}, random: {k, n}}, distinct: [...], groupings: [...], smallest: [...], margins:
// [...], runs, directory, report}.
std::string ExaminationJson(const ExaminationFacts& facts, const std::string& directory,
                            const std::string& page);

}  // namespace gauntlet
