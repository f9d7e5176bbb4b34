// How often a campaign's swarm fails before anything stands in its way: what every failure is held against.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "search/failure_tally.h"
#include "study/questions/question.h"

namespace gauntlet {

inline constexpr int kBaselineRuns = 20;

// Of runs in the empty arena, with seeds that no search has.
struct Baseline {
  std::string settings;  // of the first search that it is of; "" = of an only one
  FailureTally tally;

  double Share() const;  // of the runs that failed; 0 without any
};

Question BaselineQuestion();

// One for each different experiment of the campaign in `dir`, those that fail most first; empty: nobody has
// looked. Errors: of reading.
Result<std::vector<Baseline>> ReadBaselines(const std::string& dir);

// [{settings, k, n, interval}].
Table BaselinesTable(const std::vector<Baseline>& baselines);

// Whether a reader of failures has to know it before all else: the swarm fails in at least a tenth of its
// runs, so that a failure may have nothing to do with obstacles.
bool Matters(const std::vector<Baseline>& baselines);
// A sentence: "It fails without any obstacle in 13 of 20 runs: what follows says little about obstacles."
// Of none: that it is not known, and that `gauntlet baseline` looks (`program` and `dir` as commands have
// them).
std::string InWords(const std::vector<Baseline>& baselines, const std::string& program,
                    const std::string& dir);

// Whether failures of the search are held against it: it makes layouts, under settings that stay.
bool HasBaseline(const std::string& search);

}  // namespace gauntlet
