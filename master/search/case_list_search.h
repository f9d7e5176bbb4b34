// Given test cases, each evaluated once: what `gauntlet evaluate` does.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "master/search/individuals.h"
#include "master/search/search_algorithm.h"

namespace gauntlet::master {

// Case i of the list is individual i + 1. Validity is the caller's business; nothing here is random.
class CaseListSearch : public SearchAlgorithm {
 public:
  // replicates >= 1 runs per case.
  CaseListSearch(std::vector<sim::TestCase> cases, int replicates);

  std::vector<EvaluationRequest> Ask() override;
  void Tell(const EvaluationOutcome& outcome) override;
  SearchProgress Progress() const override;
  std::vector<Individual> Population() const override { return cases_; }
  std::vector<Individual> TakeNewborns() override { return std::exchange(newborns_, {}); }
  // distinct_individuals: different genomes in the list.
  std::vector<std::pair<std::string, double>> Statistics() const override;
  bool AtBoundary() const override { return pending_.empty(); }
  void Save(CanonicalEncoder& encoder) const override;
  // Error: the state is damaged or was made with another list of cases or number of replicates.
  Status Restore(CanonicalDecoder& decoder) override;

 private:
  // Hash of all cases and the number of replicates: whose state it is.
  std::uint64_t ListHash() const;

  int replicates_;
  bool asked_ = false;
  std::uint64_t evaluations_done_ = 0;
  std::vector<Individual> cases_;
  std::vector<Individual> newborns_;
  PendingRequests pending_;
};

}  // namespace gauntlet::master
