// Sets of runs as `compare` names them: out of campaigns, or a column of a CSV file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/statistics/comparison.h"
#include "base/result.h"
#include "master/directory/search_plans.h"
#include "proto/golden_hashes.h"
#include "study/sets/subset.h"

namespace gauntlet {

// Where runs of a set come from: one for each search. What decides whether they may be compared.
struct RunOrigin {
  std::string place;  // the campaign's directory, with the search's number where it has several
  Experiment experiment;
  std::string software_version;
  proto::GoldenHashes golden_hashes;  // by controller
};

// The runs of one case in a set.
struct CaseInSet {
  std::uint64_t hash = 0;  // CaseHash
  std::size_t unit = 0;    // of RunSet::values.clusters
  double mean = 0.0;       // of its runs with a value
  std::size_t runs = 0;
};

struct RunSet {
  analysis::ComparedSet values;    // named as it was given
  std::string unit;                // of its clusters: "evolution", "case", "row"
  std::vector<CaseInSet> cases;    // none of a CSV file
  std::vector<RunOrigin> origins;  // likewise
  std::vector<std::string> notes;  // what a reader has to know, a sentence each
};

// Adds the subset's runs to the set, one value each: `metric` as SelectRuns takes it. Runs
// without a result, and such in which there was nothing to measure, are left out and noted. Error: no such
// metric, search or number of runs.
Status AddRuns(const std::vector<SearchPlan>& plans, ResultStore& store, const RunOrigin& campaign,
               const Subset& subset, const std::string& metric, RunSet& set);

// DIR[:SUBSET] or FILE[:COLUMN], several with commas in between. A column that is not given is called as the
// metric. Errors: those of ViewCampaign, CheckStored, ReadCsvColumn and above.
Result<RunSet> ReadRunSet(const std::string& text, const std::string& metric);

// Why the runs of the two, or of one of them among each other, are no like for like: another scenario, other
// parameters of it, another simulation, whatever the version. Controllers may differ: that is what is
// compared.
std::vector<std::string> WhatDiffers(const RunSet& first, const RunSet& second);

}  // namespace gauntlet
