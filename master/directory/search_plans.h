// The experiments of a campaign's searches, as its directory holds them: one, or those of a sweep.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/campaign_directory.h"
#include "master/store/result_store.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

struct SearchPlan {
  // What tells it from the others, "search.population=20, seed 3"; "" for an only search.
  std::string settings;
  Experiment experiment;
  // Of a new search through given cases, what it goes through; afterwards the store holds them.
  std::vector<sim::TestCase> cases = {};
  SearchId id = 0;  // within its campaign: 1, 2, ...; 0 = not numbered yet
};

// The plans of one campaign with the numbers that their order gives them.
std::vector<SearchPlan> Numbered(std::vector<SearchPlan> plans);

// The text of searches.json, in the order of the searches' numbers.
std::string WriteSearchPlans(const std::vector<SearchPlan>& plans);

// Numbered; of searches.json, or of experiment.toml when there is none. Error: kCorrupt, kIo, or an
// experiment that this version does not take.
Result<std::vector<SearchPlan>> ReadSearchPlans(const CampaignDirectory& directory);

// Adds those of the searches that the store does not know yet. They are numbered.
Status AddSearches(const std::vector<SearchPlan>& plans, ResultStore& store);

}  // namespace gauntlet
