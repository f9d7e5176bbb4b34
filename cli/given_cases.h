// The cases that confirm, minimise and blame are asked about, and the campaign that answers one call of
// theirs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "cli/run_campaign.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {

// Why the experiment's swarm cannot be put into a case.
struct CaseRefusal {
  std::string rule;  // "no-path"; "" when it is none of a name
  std::string message;
};
std::optional<CaseRefusal> RefusalOf(const Experiment& experiment, const sim::TestCase& test_case);

// The cases of a campaign's runs, by their numbers, and of files, each different one once: of those that are
// given again, under whatever name, it is said. Error: one is not there or breaks a rule, a file could belong
// to several searches, or the campaign does not come first.
Result<QuestionedCampaign> GivenCases(CommandContext& context, const std::string& directory,
                                      const std::vector<std::string>& cases);
// Error: one of the cases has no obstacle.
Status CheckHaveObstacles(const QuestionedCampaign& questioned);

// The campaign begins, or goes on where an earlier call with the same cases was stopped. Its caller sets what
// it reports.
CampaignRun RunOfCall(CommandContext& context, const CallPlan& plan, int workers,
                      const ServingOptions& serving);

}  // namespace gauntlet
