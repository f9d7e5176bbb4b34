// A search decides which test cases are evaluated next. It is a pure state machine: no clock, no files, no
// processes, and all randomness keyed by the campaign seed, so the outcome does not depend on workers,
// failures or timing.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/canonical_encoder.h"
#include "base/result.h"
#include "sim/arena/test_case.h"

namespace gauntlet::master {

using IndividualId = std::uint64_t;  // 1, 2, 3, ... in order of birth within a search

// One round of runs of one individual.
struct EvaluationRequest {
  IndividualId individual = 0;
  std::uint32_t evaluation = 0;  // 0 = the individual's first
  std::uint32_t replicates = 1;  // runs, each with its own seed
  std::uint32_t generation = 0;  // 1 = initial population; for display
  sim::TestCase test_case;
  std::vector<IndividualId> parents;  // their runs tell how long this one's will take
};

// What came of an EvaluationRequest.
struct EvaluationOutcome {
  IndividualId individual = 0;
  std::uint32_t evaluation = 0;
  double fitness = 0.0;  // mean over the completed replicates
  bool completed =
      false;  // false when no replicate has the verdict "completed"; the fitness is then meaningless
  std::uint32_t total_failures = 0;  // replicates that ended in total failure
  std::uint32_t runs_failed = 0;     // replicates with a verdict other than "completed"
};

// A member of the population as it stands.
struct Individual {
  IndividualId id = 0;
  std::vector<IndividualId> parents;  // empty in the initial population
  std::uint32_t birth_generation = 0;
  sim::TestCase test_case;
  std::vector<double> evaluations;  // fitness of every completed evaluation, in order
  std::uint32_t failed_evaluations = 0;
  double fitness = 0.0;  // aggregated from `evaluations`; lower = tougher; +infinity when none completed
};

struct SearchProgress {
  std::uint32_t generation = 0;   // the one being evaluated, or the last when finished
  std::uint32_t generations = 0;  // planned; 1 for searches without generations
  std::uint64_t evaluations_done = 0;
  std::uint64_t evaluations_planned = 0;
  bool finished = false;
};

class SearchAlgorithm {
 public:
  virtual ~SearchAlgorithm() = default;
  // The evaluations that may start now and were not asked for before, in logical order. Empty while it waits
  // for Tell, and at the end.
  virtual std::vector<EvaluationRequest> Ask() = 0;
  // Outcomes in the very order of the requests, whatever order they arrived in.
  virtual void Tell(const EvaluationOutcome& outcome) = 0;
  virtual SearchProgress Progress() const = 0;
  // The current population, in a fixed order (all cases so far for searches without survivors).
  virtual std::vector<Individual> Population() const = 0;
  // Individuals born since the last call, so that they can be stored once.
  virtual std::vector<Individual> TakeNewborns() = 0;
  // A figure or two of the search itself, e.g. {"distinct_individuals", 118}, {"clone_rate", 0.61}.
  virtual std::vector<std::pair<std::string, double>> Statistics() const = 0;

  // Whether state may be saved now: at moments that depend on the number of told outcomes only.
  virtual bool AtBoundary() const = 0;
  // The whole state in the canonical encoding; only at a boundary. After Restore, Ask gives everything that
  // was not told when it was saved.
  virtual void Save(CanonicalEncoder& encoder) const = 0;
  virtual Status Restore(CanonicalDecoder& decoder) = 0;
};

}  // namespace gauntlet::master
