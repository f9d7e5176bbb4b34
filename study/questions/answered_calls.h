// The searches of a call that has come to its end (PlanCall), as they ended.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/statistics/interval.h"
#include "base/result.h"
#include "master/store/result_store.h"
#include "search/experiment/experiment.h"
#include "search/failure_tally.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// The calls in a folder of a campaign, directories, the earliest name first; none when there is no folder.
std::vector<std::string> CallsIn(const std::string& folder);
// Whether a call that cannot be read has nothing to tell yet: it is just being made, or its master just ends.
bool HasNothingYet(const Error& error);

struct AnsweredSearch {
  SearchId id = 0;
  const Experiment& experiment;
  const SearchAlgorithm& search;
  ResultStore& store;
  // What the individual's first run without a result says; "" when all have one.
  std::function<std::string(IndividualId individual)> first_message;
};
// Visits those that have come to their end, in the order of their numbers, until one of the visits fails.
// Errors: those of ViewCampaign and RestoreSearch.
Status ForEachAnswer(const std::string& directory,
                     const std::function<Status(const AnsweredSearch& answered)>& visit);

// "5 of 6": how many runs failed.
std::string OutOf(const FailureTally& tally);
// Of the probability to fail (Wilson, 95 %); 0 to 1 without a run.
analysis::Interval FailureInterval(const FailureTally& tally);

}  // namespace gauntlet
