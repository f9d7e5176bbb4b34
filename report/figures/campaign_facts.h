// Everything that reports and figures tell of one campaign, read once: afterwards nobody needs the campaign,
// and its master need not wait.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/campaign/campaign_summary.h"
#include "master/directory/search_plans.h"
#include "master/store/result_store.h"
#include "study/fits/fit_result.h"
#include "study/margins/margin_result.h"
#include "study/probabilities/probability_result.h"
#include "study/questions/confirmations.h"
#include "study/questions/question.h"
#include "study/repairs/repair_result.h"

namespace gauntlet {

// What maps and curves know of a run.
struct RunFacts {
  RunId id = 0;
  SearchId search = 0;
  IndividualId individual = 0;
  std::uint32_t generation = 0;
  bool completed = false;  // with a result
  bool total_failure = false;
  int failure_type = -1;
  double fitness = 0.0;             // meaningless unless completed
  std::vector<double> descriptors;  // of its scenario, in order; NaN: nothing to measure
};

// A test case and what became of its runs.
struct CaseFacts {
  SearchId search = 0;
  IndividualId individual = 0;
  std::string name = "";   // of a given case, that of its file
  std::uint32_t born = 0;  // generation
  std::size_t obstacles = 0;
  std::uint64_t runs = 0;
  std::uint64_t total_failures = 0;
  MeanAndRange fitness = {};  // of the completed runs
  RunId toughest = 0;         // of these that with the lowest fitness, the earliest of equal ones
  int failure_type = -1;      // its
  std::optional<Confirmation> confirmation = std::nullopt;
};

// What happened to the campaign, out of its events.
struct CampaignHistory {
  std::int64_t created_unix_ms = 0;
  std::int64_t last_unix_ms = 0;        // of the last event
  double served_seconds = 0.0;          // with a master, as far as their ends are known
  std::uint64_t sessions = 0;           // starts of a master
  std::vector<std::string> hosts = {};  // of workers, by name
};

struct CampaignFacts {
  std::string directory;  // as it was given
  std::string software_version;
  std::string golden_hashes;  // of its controllers, as text
  std::string experiment_toml;
  std::vector<SearchPlan> plans;
  CampaignSummary summary;
  CampaignAnswers answers;
  std::optional<FitResult> fit = std::nullopt;                   // that the campaign is
  std::vector<Margin> margins = {};                              // that it looks for
  std::optional<Repair> repair = std::nullopt;                   // that it is
  std::optional<FailureProbability> probability = std::nullopt;  // that it looks for
  std::vector<ToldCase> told_cases = {};  // what questions about them say, one question after the other
  CampaignHistory history;
  std::vector<std::string> notes;  // what a reader has to know, a sentence each
  std::vector<RunFacts> runs;      // in logical order, search by search
  std::vector<CaseFacts> cases;    // the toughest first: by mean fitness, those without a result last
};

// Without descriptors.
RunFacts FactsOfRow(const StoredRun& run);

// Errors: those of OpenStoredCampaign, Summarise, ReadConfirmations, ReadSmallestLayouts and ToldCases; a
// run does not read back.
Result<CampaignFacts> ReadFacts(const std::string& dir);

// The runs with these ids, whole; others are not looked at. Errors: those of ViewCampaign; one is not there.
Result<std::vector<StoredRun>> ReadRuns(const std::string& dir, const std::vector<RunId>& ids);

}  // namespace gauntlet
