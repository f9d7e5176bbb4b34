// Cases of a campaign that somebody asks about, and the campaigns that find the answer out. Each call of such
// a command is a campaign of its own, in a folder of the one that the cases come from, so that it survives a
// kill, resumes and is replayed like any other and changes nothing of the first.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"

namespace gauntlet {

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

// Every different case of the population as it stands: of an archive search, its elites.
Result<QuestionedCampaign> PopulationCases(const std::string& dir);

// The run that the case is one of, by its name; 0 when it came from a file.
RunId RunOfName(const std::string& name);
// The same for the same case under the same experiment, whatever it is called. `about` asks about the case.
std::uint64_t KeyOfCase(const Experiment& about, const sim::TestCase& test_case);

// A campaign that answers one call.
struct CallPlan {
  std::string directory;             // empty, or what an earlier call with the same cases has left
  std::vector<SearchPlan> searches;  // empty when nothing is asked
};
// `about` gives the experiment that asks about cases of another one. Equal cases are asked about once.
CallPlan PlanCall(const std::string& folder, const QuestionedCampaign& questioned,
                  const std::function<Experiment(const Experiment& experiment)>& about);

}  // namespace gauntlet
