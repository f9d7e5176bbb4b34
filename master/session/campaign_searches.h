// The searches of a campaign: one, or those of a sweep.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/campaign_directory.h"
#include "master/experiment/experiment.h"
#include "master/report/campaign_summary.h"
#include "master/search/search_algorithm.h"
#include "master/store/result_store.h"

namespace gauntlet::master {

struct SearchPlan {
  std::string
      settings;  // what tells it from the others, "search.population=20, seed 3"; "" for an only search
  Experiment experiment;
};

// The text of searches.json, in the order of the searches' numbers.
std::string WriteSearchPlans(const std::vector<SearchPlan>& plans);

// Of searches.json, or of experiment.toml when there is none. Error: kCorrupt, kIo, or an experiment that
// this version does not take.
Result<std::vector<SearchPlan>> ReadSearchPlans(const CampaignDirectory& directory);

// The search as it was before its first evaluation.
Result<std::unique_ptr<SearchAlgorithm>> MakeStoredSearch(const Experiment& experiment, SearchId id,
                                                          ResultStore& store);

// Adds the searches that the store does not know yet; those it knows come back.
Result<std::vector<StoredSearch>> AddSearches(const std::vector<SearchPlan>& plans, ResultStore& store);

// Of an only search its summary; of several the totals, with one summary each in `searches`.
Result<CampaignSummary> SummariseAll(const std::vector<SearchPlan>& plans, ResultStore& store);

}  // namespace gauntlet::master
