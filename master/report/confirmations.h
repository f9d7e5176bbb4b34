// How often cases of a campaign fail with fresh seeds: what `gauntlet confirm` has found out. Each of its
// calls is a campaign of its own, in the folder `confirm` of the one that the cases come from, so that it
// survives a kill, resumes and is replayed like any other and changes nothing of the first.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/statistics/interval.h"
#include "base/result.h"
#include "master/directory/search_plans.h"
#include "master/search/failure_tally.h"

namespace gauntlet::master {

// A case that somebody asks about.
struct CaseInQuestion {
  std::string name;        // "run 17", or what its file is called
  std::size_t search = 0;  // of the campaign's, from 0: whose experiment it belongs to
  sim::TestCase test_case;
};

// The searches of a campaign and cases that its runs were simulated with.
struct QuestionedCampaign {
  std::vector<SearchPlan> plans;
  std::vector<CaseInQuestion> cases;
};
// The cases of these runs, in their order. Errors: those of ViewCampaign; kNotFound for a run that is not
// there.
Result<QuestionedCampaign> CasesOfRuns(const std::string& dir, const std::vector<RunId>& runs);
// Every different case with a run that failed (controllers::ScenarioInfo::failing), named by the first.
Result<QuestionedCampaign> FailingCases(const std::string& dir);

struct Confirmation {
  std::string name;       // of the case, as in CaseInQuestion
  RunId run = 0;          // that it is the case of; 0 when it came from a file
  std::uint64_t key = 0;  // ConfirmationKey
  FailureTally tally;
  FailureVerdict verdict = FailureVerdict::kOpen;
  analysis::Interval interval;  // of the probability to fail (Wilson, 95 %)
  std::string message;          // of the first run that ended without a result; "" = none did
};
// The same for the same case under the same experiment, whatever it is called.
std::uint64_t ConfirmationKey(const Experiment& experiment, const sim::TestCase& test_case);
// What the campaign in `dir` knows, each case once, also while it is being found out; open ones are left
// out. Of a case that was confirmed twice, what stands on more runs.
Result<std::vector<Confirmation>> ReadConfirmations(const std::string& dir);

// A campaign that finds out how often cases fail.
struct ConfirmationPlan {
  std::string directory;             // empty, or what an earlier call with the same cases has left
  std::vector<SearchPlan> searches;  // empty when everything is known
};
// `known` with fewer runs than `replicates` are simulated anew; 0 = until there is a verdict.
ConfirmationPlan PlanConfirmation(const std::string& dir, const QuestionedCampaign& questioned,
                                  const std::vector<Confirmation>& known, int replicates);

}  // namespace gauntlet::master
