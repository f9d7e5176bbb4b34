// The cases that confirm, minimise and blame are asked about, and the campaign that answers one call of
// theirs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/cli/run_campaign.h"
#include "master/report/questioned_cases.h"

namespace gauntlet::master {

// Why the experiment's swarm cannot be put into a case.
struct Refusal {
  std::string rule;  // "no-path"; "" when it is none of a name
  std::string message;
};
std::optional<Refusal> RefusalOf(const Experiment& experiment, const sim::TestCase& test_case);

// The cases of a campaign's runs, by their numbers, and of files. Error: one is not there or breaks a rule,
// or a file could belong to several searches.
Result<QuestionedCampaign> GivenCases(const std::string& directory, const std::vector<std::string>& cases);

// The campaign begins, or goes on where an earlier call with the same cases was stopped. Its caller sets what
// it reports.
CampaignRun RunOfCall(CommandContext& context, const CallPlan& plan, int workers,
                      const ServingOptions& serving);

}  // namespace gauntlet::master
