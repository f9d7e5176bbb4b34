// Random testing, the baseline: independent random test cases, each evaluated once.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "master/search/genome_generator.h"
#include "master/search/individuals.h"
#include "master/search/search_algorithm.h"
#include "master/search/search_setup.h"

namespace gauntlet::master {

// Case k is the same however many cases are asked for. There are no generations: every case is of generation
// 1 and the population is all cases asked so far.
class RandomSearch : public SearchAlgorithm {
 public:
  static constexpr std::uint64_t kChunk = 100;  // cases per Ask: drawing them takes a fraction of a second
  static constexpr std::uint64_t kLookahead = 1000;  // Ask waits while so many are outstanding
  // After so many cases Ask waits for all of them, so that a long search has boundaries to save its state at.
  static constexpr std::uint64_t kSaveInterval = 5000;

  // Draws the first cases as a trial. Error: the ranges leave no room for a valid case.
  static Result<std::unique_ptr<RandomSearch>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  void Tell(const EvaluationOutcome& outcome) override;
  SearchProgress Progress() const override;
  std::vector<Individual> Population() const override { return cases_; }
  std::vector<Individual> TakeNewborns() override { return std::exchange(newborns_, {}); }
  // distinct_individuals: different genomes so far.
  std::vector<std::pair<std::string, double>> Statistics() const override;
  bool AtBoundary() const override { return pending_.empty(); }
  // Stores outcomes only; Restore draws the cases again.
  void Save(CanonicalEncoder& encoder) const override;
  Status Restore(CanonicalDecoder& decoder) override;

 private:
  explicit RandomSearch(const SearchSetup& setup);

  std::uint64_t Planned() const { return static_cast<std::uint64_t>(setup_.experiment.search.cases); }
  // Case `id`, 1, 2, ... Create has found that cases can be drawn, so it tries until it has one.
  Individual DrawCase(IndividualId id) const;

  SearchSetup setup_;
  GenomeGenerator generator_;
  std::uint64_t search_seed_;
  std::vector<Individual> cases_;  // case id is at index id - 1
  std::uint64_t evaluations_done_ = 0;
  std::set<std::uint64_t> genomes_seen_;  // GenomeHash
  std::vector<Individual> newborns_;
  PendingRequests pending_;
};

}  // namespace gauntlet::master
