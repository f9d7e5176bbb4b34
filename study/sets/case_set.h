// The test cases that a set of runs was simulated with, to be simulated once more.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "study/sets/subset.h"

namespace gauntlet {

// Those of one search.
struct CaseSet {
  std::string place;  // the campaign's directory, with the search's number where it has several
  Experiment experiment;
  // Every individual with a run in the subset, once, in the order of their births. Clones are individuals of
  // their own and stand for themselves.
  std::vector<Individual> members;
  std::vector<std::string> notes;  // what a reader has to know, a sentence each
};

// The searches of a set of campaigns that `subset` is about. Error: those of SelectRuns.
Result<std::vector<CaseSet>> CasesOf(const std::vector<SearchPlan>& plans, ResultStore& store,
                                     const std::string& place, const Subset& subset);

// DIR[:SUBSET], several with commas in between. Errors: those of SplitSet, OpenSubset and SelectRuns; a CSV
// file, which holds no cases.
Result<std::vector<CaseSet>> ReadCaseSets(const std::string& text);

}  // namespace gauntlet
