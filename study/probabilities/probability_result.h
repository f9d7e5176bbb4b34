// What a search for a failure probability has come to: the probability with its interval, the groups of
// failures it falls on, and the likeliest failures.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analysis/tables/section.h"
#include "base/result.h"
#include "master/store/run_numbers.h"
#include "search/experiment/experiment.h"
#include "search/probability/probability_course.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// A run that failed and counts in the estimate.
struct LikelyFailure {
  RunId run = 0;
  double density = 0.0;  // under the conditions, as a share of the largest that there is
  double robustness = 0.0;
  std::string group;  // what happened (MechanismOf); "mixed" where nothing is known
};

// Failures that are one and the same, and how probable they are.
struct FailureShare {
  std::string group;
  ProbabilityEstimate probability;  // the intervals of all groups hold at once, at 95 %
  std::size_t failures = 0;         // samples
};

struct FailureProbability {
  Experiment experiment;
  std::shared_ptr<const SearchAlgorithm> search;  // that holds the course
  bool finished = false;
  std::size_t given = 0;                      // cases
  ProbabilityEstimate estimate;               // at 95 %
  std::vector<FailureShare> groups = {};      // the most probable first; their estimates sum to the whole
  std::vector<LikelyFailure> likeliest = {};  // the likeliest first, then the least robust

  const ProbabilityCourse& course() const { return *search->Probability(); }
};
// Error: those of reading; it holds no failure probability.
Result<FailureProbability> ReadProbability(const std::string& dir);

// "The failure probability is 0.0231 (0.0192 to 0.0276, 95 %): 462 of 20,000 runs failed."
std::string OutcomeOf(const FailureProbability& probability);
std::vector<Section> TellProbability(const FailureProbability& probability, const std::string& dir,
                                     const std::string& program);
// {directory, finished, probability, interval, method, end, below, runs, ..., groups: [...], likeliest:
// [...]}.
std::string ProbabilityJson(const FailureProbability& probability, const std::string& dir);

}  // namespace gauntlet
