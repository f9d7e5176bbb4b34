// Cases that somebody asks about: of a campaign's runs, and of files.
#pragma once

#include <cstdint>
#include <optional>
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
  std::vector<std::string> notices = {};  // of cases that were given again, under whatever name
};
// The cases of these runs, in their order. Errors: those of ViewCampaign; kNotFound for a run that is not
// there.
Result<QuestionedCampaign> CasesOfRuns(const std::string& dir, const std::vector<RunId>& runs);
// Every different case with a run that failed (controllers::ScenarioInfo::failing), named by the first.
Result<QuestionedCampaign> FailingCases(const std::string& dir);
// Every different case of the population as it stands: of an archive search, its elites.
Result<QuestionedCampaign> PopulationCases(const std::string& dir);
// The cases of a campaign's runs, by their numbers, and of files, each different one once. Error: one is not
// there or breaks a rule, a file could belong to several searches, or the campaign does not come first.
Result<QuestionedCampaign> NamedCases(const std::string& dir, const std::vector<std::string>& names);

// Error: to which settings of the campaign a file would belong cannot be told.
Status CheckTakesFiles(const QuestionedCampaign& questioned, const std::string& dir, const std::string& file);

// Why the experiment's swarm cannot be put into a case.
struct CaseRefusal {
  std::string rule;  // "no-path"; "" when it is none of a name
  std::string message;
};
std::optional<CaseRefusal> RefusalOf(const Experiment& experiment, const sim::TestCase& test_case);

// As somebody types it: decimal, at least 1.
Result<RunId> ParseRunId(const std::string& text);
// The run that the case is one of, by its name; 0 when it came from a file.
RunId RunOfName(const std::string& name);
// Its name as runs are named now: stored answers may have the run's id in it.
std::string CurrentName(const std::string& name);
// The same for the same case under the same experiment, whatever it is called. `about` asks about the case.
std::uint64_t KeyOfCase(const Experiment& about, const sim::TestCase& test_case);

}  // namespace gauntlet
